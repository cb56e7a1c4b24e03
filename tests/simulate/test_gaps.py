"""Gaps at rest: less the growth at each speed; the same run with that gap given; refusals."""

from dataclasses import replace

import numpy as np
import pytest
from refused import refused
from runs import rad_s
from scenes import EXACT, scene

from geometry.base import RPM, SettingsError
from simulate.contact.gaps import gaps_at
from simulate.marching import SceneError, check_scene, least_gap, prepare
from simulate.scene import LEADING, TRAILING
from simulate.sweeps.dataset import load, save
from simulate.sweeps.sweep import sweep

GAPS = {"leading_edge_um": 100, "trailing_edge_um": 150}
HARMONICS = [{"order": 2, "amplitude_um": 80}]


@pytest.fixture
def grown(coarse_rom):
    """The coarse model with a growth of 50 um at Omega_m, linear along the chord by a fifth."""
    growth = np.array([0 * coarse_rom.xi, 5e-5 * (1 - 0.2 * coarse_rom.xi) / coarse_rom.Omega_m**2])
    return replace(coarse_rom, growth=growth)


def at_rest(**changes):
    keys = {"integrator": EXACT, "casing__harmonics": HARMONICS}
    return scene(**{**keys, "clearance": {**GAPS, "at": "rest"}, **changes})


def test_gap_is_that_at_rest_less_the_growth(grown):
    """Gaps that are given as running ones are those, to the last bit."""
    case, xi = at_rest(), np.array([LEADING, 0.5, TRAILING])
    given = case.clearance.gaps(xi, grown.span)
    for share in (0.0, 0.5, 1.0):
        gaps = gaps_at(case.gaps, grown, xi, share * grown.Omega_m)
        expected = given - 5e-5 * share**2 * (1 - 0.2 * xi)
        np.testing.assert_allclose(gaps, expected, rtol=1e-12)
    setup = prepare(scene(), grown, 400.0)
    given = scene().clearance.gaps(setup.places.xi, grown.span)
    np.testing.assert_array_equal(setup.strips.g0, given)


def test_run_is_that_with_the_gaps_of_its_speed(grown):
    """Independent: the same two gaps, computed by hand, given as running ones."""
    growth = 5e-5 * (rad_s(grown, 0.3) / grown.Omega_m) ** 2
    now = {
        "leading_edge_um": GAPS["leading_edge_um"] - 1e6 * growth * (1 - 0.2 * LEADING),
        "trailing_edge_um": GAPS["trailing_edge_um"] - 1e6 * growth * (1 - 0.2 * TRAILING),
    }
    rest, running = (sweep(case, grown) for case in (at_rest(), at_rest(clearance=now)))
    assert float(rest.wear.max()) > 1e-6
    np.testing.assert_allclose(rest.wear, running.wear, atol=1e-9 * float(running.wear.max()))
    np.testing.assert_allclose(rest.gap[0], running.gap, rtol=1e-12)
    assert rest.gap.dims == ("speed_over_f1", "strip") and running.gap.dims == ("strip",)


def test_gap_over_the_speeds_of_a_sweep_falls_with_their_square(grown, tmp_path):
    """And is read as it was saved."""
    runs = sweep(at_rest(speeds={"over_f1": [0.2, 0.3]}, rounds=1), grown)
    taken = at_rest().clearance.gaps(runs.xi.values, grown.span) - runs.gap.values
    np.testing.assert_allclose(taken[1] / taken[0], (0.3 / 0.2) ** 2, rtol=1e-9)
    save(runs, tmp_path / "sweep.nc")
    np.testing.assert_array_equal(load(tmp_path / "sweep.nc")["gap"], runs["gap"])


def test_thermal_growth_takes_from_the_gap_too(grown, tmp_path):
    path = tmp_path / "thermal.csv"
    path.write_text("speed_over_f1,growth_um\n0,0\n0.2,10\n0.4,40\n")
    case = at_rest(clearance={**GAPS, "at": "rest", "thermal_growth": str(path)})
    path.unlink()
    taken = [
        gaps_at(at_rest().gaps, grown, 0.5, Omega) - gaps_at(case.gaps, grown, 0.5, Omega)
        for Omega in rad_s(grown, np.array([0.1, 0.2, 0.3]))
    ]
    assert taken == pytest.approx([5e-6, 1e-5, 2.5e-5], rel=1e-9)


SMALL = {"leading_edge_um": 4, "trailing_edge_um": 40, "at": "rest"}


def test_gap_that_the_tip_outgrows_is_refused_with_both_numbers_and_the_speed(grown):
    """4 um at xi = 1/16; at the last of three speeds, 0.35 f1, the tip has grown by 38 um.

    At a speed between, as those that the sweep adds around peaks, as well.
    """
    case = at_rest(clearance=SMALL, speeds={"over_f1": [0.2, 0.35, 0.3]})
    Omega = rad_s(grown, 0.35)
    growth = 5e-5 * (Omega / grown.Omega_m) ** 2 * (1 - 0.2 / 16)
    assert str(refused(SceneError, check_scene, case, grown)) == (
        "clearance: the gap at rest is 4 um at xi = 0.0625, and the tip grows there by "
        f"{1e6 * growth:.4g} um at {RPM * Omega:.6g} rpm (0.35 f1(0)): contact before the casing "
        "distorts; allowed from that, or lower speeds"
    )
    fits = at_rest(clearance=SMALL | {"leading_edge_um": 1.01e6 * growth})
    check_scene(fits.but(speeds={"over_f1": [0.2, 0.35]}), grown)
    assert refused(SceneError, prepare, case, grown, 600.0).key == "clearance"
    too_fast = at_rest(speeds={"rad_s": [651.0]})  # all are: there is no gap to tell
    assert refused(SceneError, check_scene, too_fast, grown).key == "speeds.rpm"


def test_speed_outside_the_thermal_table_and_model_without_growth_are_refused(grown):
    table = {"speed_rpm": [0, 1000], "growth_um": [0, 1]}
    case = at_rest(clearance={**GAPS, "at": "rest", "thermal_growth": table})
    error = refused(SceneError, check_scene, case, grown)
    assert (error.key, error.allowed) == ("clearance.thermal_growth", pytest.approx((0, 1000)))
    unknown = replace(grown, growth=np.empty((0, 0)))
    assert refused(SceneError, check_scene, at_rest(), unknown).key == "clearance.at"
    check_scene(scene(), unknown)


def test_least_gap_is_that_of_the_worst_speed(grown):
    case = at_rest(speeds={"over_f1": [0.1, 0.35, 0.2]})
    worst = gaps_at(case.gaps, grown, 0.0625, rad_s(grown, 0.35))
    least = least_gap(case.gaps, grown, case.liner.m, case.speeds.omega(grown.f1))
    assert least == pytest.approx(float(worst), rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        (
            {"clearance": {**GAPS, "thermal_growth": {"speed_rad_s": [0, 1], "growth_um": [0, 0]}}},
            "clearance.thermal_growth",
        ),
        ({"speeds": {"over_f1": [0.2, 0.3], "in_turn": True}}, "speeds.in_turn"),
        ({"start": {"scene": "b", "speed_over_f1": 0.2}}, "start.speed_over_f1"),
        ({"clearance": {**GAPS, "at": "cold"}}, "clearance.at"),
        (
            {"clearance": {**GAPS, "at": "rest", "thermal_growth": {"growth_um": [0, 0]}}},
            "clearance.thermal_growth",
        ),
        (
            {
                "clearance": {
                    **GAPS,
                    "at": "rest",
                    "thermal_growth": {"speed_rad_s": [1, 0], "growth_um": [0, 0]},
                }
            },
            "clearance.thermal_growth.speed_rpm",
        ),
    ],
)
def test_settings_that_do_not_hold_together(changes, key):
    assert refused(SettingsError, at_rest, **changes).key == key
