"""A sweep adds speeds around the peaks that its scene asks for."""

import numpy as np
from scenes import scene

from simulate.sweeps.over_speeds import as_sweep, at_speeds
from simulate.sweeps.peak import along_order, peak_of
from simulate.sweeps.sweep import close_in, sweep

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


def test_without_peaks_a_sweep_is_left_as_it_is(coarse_rom):
    case = scene(rounds=1)
    found = as_sweep(at_speeds(case, coarse_rom, case.speeds.omega(coarse_rom.f1)))
    assert close_in(case, coarse_rom, found) is found
