"""The look at the still blade, and what a run that stands alone has lost."""

from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest
from refused import refused
from scenes import scene
from test_twin import outcome

from simulate.compare import error
from simulate.ledger import Ledger
from simulate.over_speeds import set_up, sweep
from simulate.resolution import WINDOW, check_resolution, judge_alone, shortest_window
from simulate.run import march
from simulate.setup import SceneError, prepare

SLOW = 0.02  # over f1(0): many periods of the first mode in a round


def exact(steps, **changes):
    return scene(integrator={"scheme": "piecewise-exact", "steps_per_round": steps}, **changes)


def bumps(order, amplitude=2.0):
    return {"casing__harmonics": [{"order": order, "amplitude_gaps": amplitude}]}


def setup_of(case, rom, over_f1=0.3):
    return prepare(case, rom, 2 * np.pi * over_f1 * rom.f1)


def window(case, rom):
    setup = setup_of(case, rom)
    return shortest_window(case, setup, setup.strips.d.max() - setup.strips.g0.min())


@pytest.mark.parametrize("order", [2, 5, 12])
def test_a_window_is_the_part_of_a_bump_that_is_deep(coarse_rom, order):
    """2 cos(k theta) - 1 > 0.15 over 2 arccos(0.575) / k, and the footprint; to a rod at an end."""
    case = exact(6400, liner__rods_per_round=100_003, **bumps(order))
    radius = setup_of(case, coarse_rom).places.radius.mean()
    angle = 2 * np.arccos(0.575) / order + 5e-3 / radius
    expected = 6400 * angle / (2 * np.pi)
    assert window(case, coarse_rom) == pytest.approx(expected, abs=2 * 6400 / 100_003)


def test_a_shallow_bump_is_no_window_and_an_even_casing_has_none(coarse_rom):
    """A second bump, a quarter as deep and far narrower, does not count; a third as deep does."""
    theta = np.arange(0, 360, 0.5)
    gap = 1.5e-4 * coarse_rom.span

    def case(share):
        depth = gap * (1 + np.exp(-(((theta - 90) / 30) ** 2)))
        depth += share * gap * np.exp(-(((theta - 270) / 1) ** 2))
        table = {"theta_deg": theta.tolist(), "depth_m": depth.tolist()}
        return exact(6400, casing={"table": table, "ramp_rounds": 0.1}, liner__rods_per_round=4093)

    assert window(case(0.25), coarse_rom) > 10 * window(case(0.35), coarse_rom)
    assert window(exact(640, **bumps(0)), coarse_rom) == np.inf


def test_a_rough_casing_is_passed_in_its_wide_windows(coarse_rom):
    """Noise of a tenth of the depth crosses each level many times, and makes no window."""
    theta = np.arange(0, 360, 0.25)
    noise = 0.05 * np.random.default_rng(3).uniform(-1, 1, theta.size)
    depth = 1.5e-4 * coarse_rom.span * (2 * np.cos(2 * np.radians(theta)) + noise)
    table = {"theta_deg": theta.tolist(), "depth_m": depth.tolist()}
    rough = exact(6400, casing={"table": table, "ramp_rounds": 0.1}, liner__rods_per_round=4093)
    smooth = exact(6400, liner__rods_per_round=4093, **bumps(2))
    assert window(rough, coarse_rom) == pytest.approx(window(smooth, coarse_rom), rel=0.05)


@pytest.mark.parametrize(
    ("steps", "changes", "over_f1", "what"),
    [
        (64, bumps(12) | {"halving": True}, 0.3, "the closest part of the casing is passed in"),
        (64, {}, SLOW, "the first mode has"),
    ],
)
def test_a_step_too_long_is_refused_with_the_least_steps(coarse_rom, steps, changes, over_f1, what):
    case = exact(steps, **changes)
    error = refused(
        SceneError, check_resolution, case, setup_of(case, coarse_rom, over_f1), match=what
    )
    assert (error.key, error.value) == ("integrator.steps_per_round", steps)
    least = error.allowed["ge"]
    assert least % 64 == 0
    allowed = exact(least, **changes)
    check_resolution(allowed, setup_of(allowed, coarse_rom, over_f1))
    fewer = exact(least - 64, **changes)
    refused(SceneError, check_resolution, fewer, setup_of(fewer, coarse_rom, over_f1))


def test_what_is_refused_would_be_wrong(coarse_rom):
    """Twelve bumps in 64 steps a round: displacement and wear are off by far more than a tenth."""
    case = exact(64, **bumps(12, 1.5), rounds=1)
    refused(SceneError, set_up, case, coarse_rom, 2 * np.pi * 0.3 * coarse_rom.f1)
    coarse, fine = (
        march(c, setup_of(c, coarse_rom))
        for c in (case, case.but(integrator={"steps_per_round": 6400}))
    )
    assert coarse.status == "ok"
    assert error(coarse.u_r, fine.u_r) > 0.3


def test_a_blade_out_of_reach_may_take_any_step(coarse_rom):
    case = exact(64, **bumps(12, 0.9))
    check_resolution(case, setup_of(case, coarse_rom, SLOW))


def test_half_a_step_replaces_the_look_at_the_first_mode_alone(coarse_rom):
    case = exact(640, halving=True)
    check_resolution(case, setup_of(case, coarse_rom, SLOW))
    with pytest.raises(SceneError, match="closest part"):
        narrow = exact(640, halving=True, **bumps(24))
        check_resolution(narrow, setup_of(narrow, coarse_rom, SLOW))


def test_with_half_a_step_a_period_of_the_first_mode_still_has_ten(coarse_rom):
    """64 steps a round, from a speed of 10 steps a period down."""
    case = exact(64, halving=True, **bumps(1))
    for over_f1, fault in {0.17: None, 0.15: "the first mode has 9"}.items():
        setup = setup_of(case, coarse_rom, over_f1)
        if fault is None:
            check_resolution(case, setup)
            continue
        refused(SceneError, check_resolution, case, setup, match=fault)


def test_a_sweep_is_refused_before_its_first_march(coarse_rom):
    case = exact(64, **bumps(12, 3.0))
    lines = []
    refused(
        SceneError, sweep, case, coarse_rom, lines.append, match=r"allowed from \d+, or `accuracy`"
    )
    assert [line.split(":")[0] for line in lines] == [
        "1 speeds of 2 rounds of 64 steps"
    ]  # its cost


def lossy(share):
    """A run that has lost this share of the casing's work."""
    ledger = Ledger(casing=10.0, work=4.0, blade=3, damping=1, elastic=1, plastic=5, released=0)
    return replace(outcome(), ledger=replace(ledger, plastic=5.0 - 10 * share))


@pytest.mark.parametrize(
    ("case", "limit"), [(exact(640), 0.015), (scene(), 0.06)], ids=["piecewise-exact", "central"]
)
def test_a_run_alone_that_has_lost_energy_is_inaccurate(case, limit):
    assert lossy(0.05).ledger.numerical == pytest.approx(-0.5)
    assert judge_alone(case, lossy(0.9 * limit)).status == "ok"
    assert judge_alone(case, lossy(1.1 * limit)).status == "inaccurate"
    assert judge_alone(case, lossy(-0.05)).status == "ok"  # created: `unstable` from a tenth on
    failed = replace(lossy(0.07), status="diverged")
    assert judge_alone(case, failed) is failed


def test_windows_shorter_than_the_limit_are_what_is_refused(coarse_rom):
    """On both sides of the limit, to a step."""
    seen = set()
    for steps in range(64, 640, 64):
        case = exact(steps, halving=True, **bumps(12))
        too_short = window(case, coarse_rom) < WINDOW
        with pytest.raises(SceneError) if too_short else nullcontext():
            check_resolution(case, setup_of(case, coarse_rom))
        seen.add(too_short)
    assert seen == {True, False}
