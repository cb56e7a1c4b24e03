"""Gaps at rest: less the growth at each speed; the same run with that gap given; refusals."""

from dataclasses import replace

import numpy as np
import pytest
from refused import refused
from scenes import scene

from geometry.errors import SettingsError
from simulate.dataset import load, save
from simulate.gaps import gaps_at
from simulate.over_speeds import sweep
from simulate.scene import LEADING, TRAILING
from simulate.setup import SceneError, check_scene, least_gap, prepare

EXACT = {"scheme": "piecewise-exact", "steps_per_round": 640}
GAPS = {"leading_edge_m": 1.0e-4, "trailing_edge_m": 1.5e-4}
HARMONICS = [{"order": 2, "amplitude_m": 8e-5}]


@pytest.fixture
def grown(coarse_rom):
    """The coarse model with a growth of 50 um at Omega_m, linear along the chord by a fifth."""
    growth = np.array([0 * coarse_rom.xi, 5e-5 * (1 - 0.2 * coarse_rom.xi) / coarse_rom.Omega_m**2])
    return replace(coarse_rom, growth=growth)


def at_rest(**changes):
    keys = {"integrator": EXACT, "casing__harmonics": HARMONICS}
    return scene(**{**keys, "clearance": {**GAPS, "at": "rest"}, **changes})


def test_gap_is_that_at_rest_less_the_growth(grown):
    case = at_rest()
    xi = np.array([LEADING, 0.5, TRAILING])
    for share in (0.0, 0.5, 1.0):
        expected = case.clearance.gaps(xi, grown.span) - 5e-5 * share**2 * (1 - 0.2 * xi)
        gaps = gaps_at(case, grown, xi, share * grown.Omega_m)
        np.testing.assert_allclose(gaps, expected, rtol=1e-12)


def test_running_gaps_are_those_given_to_the_last_bit(grown):
    case = scene()
    setup = prepare(case, grown, 400.0)
    given = case.clearance.gaps(setup.places.xi, grown.span)
    np.testing.assert_array_equal(setup.strips.g0, given)


def test_run_is_that_with_the_gaps_of_its_speed(grown):
    """Independent: the same two gaps, computed by hand, given as running ones."""
    Omega = 0.3 * 2 * np.pi * grown.f1
    growth = 5e-5 * (Omega / grown.Omega_m) ** 2 * (1 - 0.2 * np.array([LEADING, TRAILING]))
    now = {
        "leading_edge_m": GAPS["leading_edge_m"] - growth[0],
        "trailing_edge_m": GAPS["trailing_edge_m"] - growth[1],
    }
    rest = sweep(at_rest(), grown)
    running = sweep(at_rest(clearance=now), grown)
    assert float(rest.wear.max()) > 1e-6
    np.testing.assert_allclose(rest.wear, running.wear, atol=1e-9 * float(running.wear.max()))
    np.testing.assert_allclose(rest.gap[0], running.gap, rtol=1e-12)
    assert rest.gap.dims == ("speed_over_f1", "strip") and running.gap.dims == ("strip",)


def test_gap_over_the_speeds_of_a_sweep_falls_with_their_square(grown):
    speeds = [0.2, 0.3]
    runs = sweep(at_rest(speeds={"over_f1": speeds}, rounds=1), grown)
    taken = at_rest().clearance.gaps(runs.xi.values, grown.span) - runs.gap.values
    np.testing.assert_allclose(taken[1] / taken[0], (0.3 / 0.2) ** 2, rtol=1e-9)


def test_a_sweep_with_gaps_at_rest_is_read_as_it_was_saved(grown, tmp_path):
    runs = sweep(at_rest(rounds=1, speeds={"over_f1": [0.2, 0.3]}), grown)
    save(runs, tmp_path / "sweep.nc")
    np.testing.assert_array_equal(load(tmp_path / "sweep.nc")["gap"], runs["gap"])


def test_thermal_growth_takes_from_the_gap_too(grown, tmp_path):
    path = tmp_path / "thermal.csv"
    path.write_text("speed_over_f1,growth_um\n0,0\n0.2,10\n0.4,40\n")
    case = at_rest(clearance={**GAPS, "at": "rest", "thermal_growth": str(path)})
    path.unlink()
    for share, thermal in ((0.1, 5e-6), (0.2, 1e-5), (0.3, 2.5e-5)):
        Omega = share * 2 * np.pi * grown.f1
        taken = gaps_at(at_rest(), grown, 0.5, Omega) - gaps_at(case, grown, 0.5, Omega)
        assert taken == pytest.approx(thermal, rel=1e-9)


@pytest.fixture
def refusal(grown):
    return lambda case, rom=grown: refused(SceneError, check_scene, case, rom)


def test_gap_that_the_tip_outgrows_is_refused_with_both_numbers_and_the_speed(refusal, grown):
    """4 um at xi = 1/16; at the last of three speeds, 0.35 f1, the tip has grown by 38 um."""
    small = {"leading_edge_m": 4e-6, "trailing_edge_m": 4e-5, "at": "rest"}
    error = refusal(at_rest(clearance=small, speeds={"over_f1": [0.2, 0.35, 0.3]}))
    Omega = 0.35 * 2 * np.pi * grown.f1
    growth = 5e-5 * (Omega / grown.Omega_m) ** 2 * (1 - 0.2 / 16)
    assert str(error) == (
        f"clearance: the gap at rest is 4e-06 m at xi = 0.0625, and the tip grows there by "
        f"{growth:.4g} m at {Omega:.6g} rad/s (0.35 f1(0)): contact before the casing distorts; "
        f"allowed from that growth, or lower speeds"
    )
    fits = at_rest(clearance=small | {"leading_edge_m": 1.01 * growth})
    check_scene(fits.but(speeds={"over_f1": [0.2, 0.35]}), grown)


def test_a_speed_between_is_refused_as_well(grown):
    """As those that the sweep adds around peaks."""
    small = {"leading_edge_m": 4e-6, "trailing_edge_m": 4e-5, "at": "rest"}
    assert refused(SceneError, prepare, at_rest(clearance=small), grown, 600.0).key == "clearance"


def test_model_that_does_not_know_its_growth_is_refused(refusal, grown):
    unknown = replace(grown, growth=np.empty((0, 0)))
    assert refusal(at_rest(), unknown).key == "clearance.at"
    check_scene(scene(), unknown)


def test_speed_outside_the_thermal_table_is_refused(refusal):
    table = {"speed_rad_s": [0, 100], "growth_m": [0, 1e-6]}
    error = refusal(at_rest(clearance={**GAPS, "at": "rest", "thermal_growth": table}))
    assert (error.key, error.allowed) == ("clearance.thermal_growth", (0, 100))


def test_least_gap_is_that_of_the_worst_speed(grown):
    case = at_rest(speeds={"over_f1": [0.1, 0.35, 0.2]})
    worst = gaps_at(case, grown, 0.0625, 0.35 * 2 * np.pi * grown.f1)
    assert least_gap(case, grown) == pytest.approx(float(worst), rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        (
            {"clearance": {**GAPS, "thermal_growth": {"speed_rad_s": [0, 1], "growth_m": [0, 0]}}},
            "clearance.thermal_growth",
        ),
        ({"speeds": {"over_f1": [0.2, 0.3], "in_turn": True}}, "speeds.in_turn"),
        ({"start": {"scene": "b", "speed_over_f1": 0.2}}, "start.speed_over_f1"),
        ({"clearance": {**GAPS, "at": "cold"}}, "clearance.at"),
        (
            {"clearance": {**GAPS, "at": "rest", "thermal_growth": {"growth_m": [0, 0]}}},
            "clearance.thermal_growth",
        ),
        (
            {
                "clearance": {
                    **GAPS,
                    "at": "rest",
                    "thermal_growth": {"speed_rad_s": [1, 0], "growth_m": [0, 0]},
                }
            },
            "clearance.thermal_growth.speeds",
        ),
    ],
)
def test_settings_that_do_not_hold_together(changes, key):
    assert refused(SettingsError, at_rest, **changes).key == key
