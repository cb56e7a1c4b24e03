"""The look at the still blade, and what a run that stands alone has lost."""

from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest
from refused import refused
from runs import marched, set_up
from scenes import of_steps, scene
from test_neighbours import outcome

from simulate.contact.ledger import Ledger
from simulate.errors.neighbours import judged
from simulate.errors.observables import error
from simulate.errors.resolution import WINDOW, check_resolution, shortest_window
from simulate.errors.run import Run
from simulate.marching import SceneError
from simulate.sweeps.sweep import sweep

SLOW = 0.02  # over f1(0): many periods of the first mode in a round


def bumps(order, amplitude=2.0):
    return {"casing__harmonics": [{"order": order, "amplitude_gaps": amplitude}]}


def exact(steps, **changes):
    return scene(integrator=of_steps(steps), **changes)


def check(case, rom, over_f1=0.3):
    setup = set_up(case, rom, over_f1)
    check_resolution(setup, case.record.samples_per_round, case.halves)


def window(case, rom):
    setup = set_up(case, rom)
    return shortest_window(setup, setup.strips.d.max() - setup.strips.g0.min())


def tabled(theta, depth):
    """A casing of these depths at these angles, in degrees."""
    table = {"theta_deg": theta.tolist(), "depth_m": depth.tolist()}
    return exact(6400, casing={"table": table, "ramp_rounds": 0.1}, liner__rods_per_round=4093)


@pytest.mark.parametrize("order", [2, 5, 12])
def test_a_window_is_the_part_of_a_bump_that_is_deep(coarse_rom, order):
    """2 cos(k theta) - 1 > 0.15 over 2 arccos(0.575) / k, and the footprint; to a rod at an end."""
    case = exact(6400, liner__rods_per_round=100_003, **bumps(order))
    radius = set_up(case, coarse_rom).places.radius.mean()
    angle = 2 * np.arccos(0.575) / order + 5e-3 / radius
    expected = 6400 * angle / (2 * np.pi)
    assert window(case, coarse_rom) == pytest.approx(expected, abs=2 * 6400 / 100_003)


def test_a_shallow_bump_is_no_window_and_an_even_casing_has_none(coarse_rom):
    """A second bump, a quarter as deep and far narrower, does not count; a third as deep does."""
    theta, gap = np.arange(0, 360, 0.5), 1.5e-4 * coarse_rom.span
    first, second = (np.exp(-(((theta - at) / of) ** 2)) for at, of in ((90, 30), (270, 1)))
    quarter, third = (
        window(tabled(theta, gap * (1 + first + share * second)), coarse_rom)
        for share in (0.25, 0.35)
    )
    assert quarter > 10 * third
    assert window(exact(640, **bumps(0)), coarse_rom) == np.inf


def test_a_rough_casing_is_passed_in_its_wide_windows(coarse_rom):
    """Noise of a tenth of the depth crosses each level many times, and makes no window."""
    theta = np.arange(0, 360, 0.25)
    noise = 0.05 * np.random.default_rng(3).uniform(-1, 1, theta.size)
    depth = 1.5e-4 * coarse_rom.span * (2 * np.cos(2 * np.radians(theta)) + noise)
    smooth = exact(6400, liner__rods_per_round=4093, **bumps(2))
    rough = window(tabled(theta, depth), coarse_rom)
    assert rough == pytest.approx(window(smooth, coarse_rom), rel=0.05)


@pytest.mark.parametrize(
    ("changes", "over_f1", "what"),
    [
        (bumps(12) | {"verify": "every"}, 0.3, "the closest part of the casing is passed in"),
        ({}, SLOW, "the first mode has"),
        ({"liner__footprint_mm": 2.5, **bumps(1)}, 0.3, "the tip passes 2.21 of"),
        # with half a step a period of the first mode still has ten
        (bumps(1) | {"verify": "every"}, 0.15, "the first mode has 9"),
    ],
)
def test_a_step_too_long_is_refused_with_the_least_steps(coarse_rom, changes, over_f1, what):
    steps = 640 if "liner__footprint_mm" in changes else 64
    error = refused(SceneError, check, exact(steps, **changes), coarse_rom, over_f1, match=what)
    assert (error.key, error.value) == ("integrator.steps_per_round", steps)
    least = error.allowed["ge"]
    assert least % 64 == 0
    check(exact(least, **changes), coarse_rom, over_f1)
    refused(SceneError, check, exact(least - 64, **changes), coarse_rom, over_f1)


def test_what_is_refused_would_be_wrong(coarse_rom):
    """Twelve bumps in 64 steps a round: displacement and wear are off by far more than a tenth."""
    case = exact(64, **bumps(12, 1.5), rounds=1)
    told = []
    refused(SceneError, sweep, case, coarse_rom, told.append)
    assert len(told) == 1  # its cost, before the first march
    coarse = marched(case, coarse_rom)
    fine = marched(case.but(integrator={"steps_per_round": 6400}), coarse_rom)
    assert coarse.status == "ok"
    assert error(coarse.u_r, fine.u_r) > 0.3


@pytest.mark.parametrize(
    ("steps", "changes", "over_f1"),
    [
        (64, bumps(12, 0.9), SLOW),  # out of reach
        (640, {"verify": "every"}, SLOW),  # which replaces the look at the first mode,
        (640, {"verify": "every", "liner__footprint_mm": 2}, 0.3),  # and that at the footprint
        (64, bumps(1) | {"verify": "every"}, 0.17),  # with ten steps in its period
    ],
)
def test_a_step_that_resolves_what_the_blade_meets_is_accepted(coarse_rom, steps, changes, over_f1):
    check(exact(steps, **changes), coarse_rom, over_f1)


def lossy(share, status="ok"):
    """A run that has lost this share of the casing's work."""
    ledger = Ledger(
        10.0, work=4.0, blade=3, damping=1, elastic=1, plastic=5 - 10 * share, released=0
    )
    run = outcome(status=status)
    return replace(run, facts=replace(run.facts, ledger=ledger))


@pytest.mark.parametrize(
    ("case", "limit"), [(exact(640), 0.015), (scene(), 0.06)], ids=["piecewise-exact", "central"]
)
def test_a_run_alone_that_has_lost_energy_is_inaccurate(coarse_rom, case, limit):
    assert lossy(0.05).ledger.numerical == pytest.approx(-0.5)

    def status(of, **errors):
        setup = set_up(case, coarse_rom)
        return judged(Run(case, coarse_rom, setup, outcome=of, errors=errors)).outcome.status

    # what is created is `unstable` from a tenth on
    shares = {0.9 * limit: "ok", 1.1 * limit: "inaccurate", -0.05: "ok"}
    assert [status(lossy(of)) for of in shares] == [*shares.values()]
    assert status(lossy(1.1 * limit), wear=0.0) == "ok"  # with `accuracy`
    assert status(lossy(0.07, "diverged")) == "diverged"


@pytest.mark.parametrize("order", [12, 24])
def test_windows_shorter_than_the_limit_are_what_is_refused(coarse_rom, order):
    """On both sides of the limit, to a step; also where half a step looks at the first mode."""
    seen = set()
    for steps in range(64, 1280, 64):
        case = exact(steps, verify="every", **bumps(order))
        too_short = window(case, coarse_rom) < WINDOW
        with pytest.raises(SceneError) if too_short else nullcontext():
            check(case, coarse_rom)
        seen.add(too_short)
    assert seen == {True, False}
