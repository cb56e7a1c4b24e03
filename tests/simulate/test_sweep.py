"""Speeds added around the peaks that a scene asks for; without orders until they are known."""

import re

import numpy as np
import pytest
from runs import swept
from scenes import of_steps, scene

from rom.crossings import crossing
from simulate.errors.model_errors import ModelError
from simulate.scene import Peaks
from simulate.sweeps.cost import cost
from simulate.sweeps.over_speeds import as_sweep, at_speeds
from simulate.sweeps.peak import Responses, along_order, only_at, peak_of, reported, rise
from simulate.sweeps.peak_results import results
from simulate.sweeps.sweep import close_in, further, sweep

RUB = {
    "rounds": 8,
    "integrator": of_steps(1024),
    "record": {"samples_per_round": 64, "spectrum_rounds": 4},
    "speeds": {"over_f1": {"first": 0.28, "last": 0.38, "count": 11}},
}
WITHIN = 3e-3


def responses(rom, speeds, amplitude):
    """An amplitude over the gap along EO 4 over the speed."""
    along = np.zeros((len(speeds), 16))
    along[:, 3] = amplitude(speeds)
    case = scene(record={"samples_per_round": 64, "spectrum_rounds": 1})
    told = np.zeros(len(speeds), int)
    return Responses(rom, case, speeds, told, *only_at(told, along))


def closed_in(rom, amplitude, spacing, within, most=60):
    """Speeds of a sweep about the crossing of EO 4, with those added around its peak."""
    peaks, seen = Peaks(within_over_f1=within, most=most), {}
    speeds = 1.05 * crossing(rom, 4) + spacing * np.arange(-10, 11)
    while True:
        of = responses(rom, speeds, amplitude)
        new = further(peaks, speeds * rom.omega1, of, None, seen, len(speeds) - 21)
        if not new:
            return speeds
        speeds = np.sort(np.append(speeds, np.array(new) / rom.omega1))


def test_a_resonance_is_closed_in_on_to_the_spacing_asked_for(coarse_rom):
    at = 1.05 * crossing(coarse_rom, 4) + 0.3e-3
    speeds = closed_in(coarse_rom, lambda x: 2 / np.hypot(1, (x - at) / 2e-3), 2e-3, 6e-4)
    top = int(np.abs(speeds - at).argmin())
    assert np.diff(speeds)[top - 1 : top + 1].max() <= 6e-4
    assert len(speeds) - 21 < 8


def test_what_the_last_turn_raised_by_more_than_was_said_is_closed_in_on_further(coarse_rom):
    """A spike on the top of a wide resonance, between speeds: no three of them foretell it."""
    at = 1.05 * crossing(coarse_rom, 4)

    def spike(x, width):
        return 2 / np.hypot(1, (x - at) / 4e-3) + 3 / np.hypot(1, (x - at - 0.6e-3) / width)

    few, many = (
        closed_in(coarse_rom, lambda x, width=width: spike(x, width), 2e-3, 1e-3)
        for width in (1e-2, 1e-4)
    )
    assert np.diff(few).min() == pytest.approx(1e-3)
    assert np.diff(many).min() < 0.6e-3
    assert spike(many, 1e-4).max() > 0.8 * spike(at + 0.6e-3, 1e-4)


def test_a_sweep_without_orders_adds_speeds_around_every_peak_and_tells_how_many(coarse_rom):
    case = scene(**RUB, peaks={"within_over_f1": WITHIN, "most": 40})
    said = []
    runs = sweep(case, coarse_rom, report=said.append)
    speeds, found = runs["speed_over_f1"].values, reported(runs, coarse_rom)
    assert found and len(speeds) > 11
    for peak in found:
        near = np.diff(speeds[max(peak.index - 1, 0) : peak.index + 2])
        assert near.max() <= WITHIN * (1 + 1e-9)
    assert any(re.search("11 speeds and some [0-9]+ more of 8 revolutions", line) for line in said)
    assert not any("more" in line for line in cost(scene(**RUB), coarse_rom).lines())


def test_two_runs_halfway_to_the_neighbours_measure_the_amplitude_between_speeds(coarse_rom):
    """Those of a sweep there; they are no rows of it."""
    case = scene(**RUB)
    runs = swept(case, coarse_rom)
    assert close_in(case, coarse_rom, runs) is runs  # without `peaks`
    found = [peak for peak in results(runs, coarse_rom, ModelError(1e-4, None)) if peak.k]
    assert found
    for peak in found:
        three = slice(peak.index - 1, peak.index + 2)
        Omega = runs["speed"].values[three]
        halfway = (Omega[:-1] + Omega[1:]) / 2
        beside = as_sweep(at_speeds(case, coarse_rom, halfway))
        low, high = along_order(beside, peak.k)
        expected = rise(np.insert(halfway, 1, Omega[1]), np.array([low, peak.amplitude, high]))
        assert peak.parts["speeds"]["amplitude"] == pytest.approx(expected, rel=1e-6, abs=1e-9)
    assert runs.sizes["speed_over_f1"] == 11


def test_no_more_speeds_are_added_than_was_told(coarse_rom):
    said = []
    case = scene(**RUB, peaks={"within_over_f1": 1e-4, "most": 3})
    runs = sweep(case, coarse_rom, report=said.append)
    assert runs.sizes["speed_over_f1"] == 14
    assert "peaks.most: 3 speeds are added: more may raise peaks" in said


ORDERS = {"record__spectrum_rounds": 1, "peaks": {"orders": [4], "within_over_f1": 2e-3}}


def test_speeds_are_added_around_the_peak_up_to_the_spacing_asked_for(coarse_rom):
    speeds = {"first": 0.3, "last": 0.38, "count": 9}
    case = scene(speeds__over_f1=speeds, **ORDERS)
    coarse = as_sweep(at_speeds(case, coarse_rom, case.speeds.omega(coarse_rom.f1)))
    fine = sweep(case, coarse_rom)
    first, last = (peak_of(found, coarse_rom, 4) for found in (coarse, fine))
    over_f1 = fine["speed_over_f1"].values
    beside = np.diff(over_f1[last.index - 1 : last.index + 2])
    assert beside.max() <= 2e-3 * (1 + 1e-9)
    assert beside.min() > 1e-3  # no nearer than asked: each halving is needed
    assert last.amplitude >= first.amplitude
    assert set(coarse["speed"].values) < set(fine["speed"].values)
    assert along_order(fine, 4).argmax() == last.index
    # only around the peak: three halvings of two neighbours
    assert fine.sizes["speed_over_f1"] <= coarse.sizes["speed_over_f1"] + 6
