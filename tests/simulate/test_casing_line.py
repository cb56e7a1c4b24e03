"""The casing's shape as a line of points, the rotor shifted against it: gaps, runs, refusals."""

from dataclasses import replace

import numpy as np
import pytest
from refused import refused
from runs import marched, rad_s, set_up
from scenes import scene

from geometry.base import SettingsError
from geometry.hats import middles
from simulate.contact.gaps import gaps_at
from simulate.marching import SceneError, check_scene

SLOPE, SHIFT, GAP = -0.2, 3e-4, 1e-4
XI = middles(8)


@pytest.fixture(scope="module")
def cone(coarse_rom):
    """The coarse blade with its tip on a cone; at Omega_m it is 20 um longer, 50 um downstream."""
    camber = coarse_rom.camber.copy()
    z = camber[:, 2]
    camber[:, 0] = 0.25 + SLOPE * (z - z[0])
    of_speed = np.array([0 * coarse_rom.xi, 1 + 0 * coarse_rom.xi]) / coarse_rom.Omega_m**2
    moved = {"growth": 2e-5 * of_speed, "advance": 5e-5 * of_speed}
    return replace(coarse_rom, camber=camber, slope=np.empty(0), **moved)


def beside(rom, gap, beyond=1.0):
    """Points of a casing with this gap, m, beside the tip, its ends ``beyond`` those of the tip."""
    r, _, z = rom.line(np.array([0.0, 1.0])).T
    ends = beyond * np.array([-1e-3, 1e-3])
    return {
        "z_mm": (1e3 * (z + ends)).tolist(),
        "r_mm": (1e3 * (r + gap + SLOPE * ends)).tolist(),
    }


def of_line(line, **changes):
    return scene(clearance=None, casing__line=line, **changes)


def test_gap_is_the_line_less_the_tip_where_the_speed_has_brought_it(cone):
    """Longer by the growth, and downstream, where a cone of this slope is narrower."""
    case = of_line(beside(cone, GAP))
    for share in (0.0, 0.5, 1.0):
        gaps = gaps_at(case.gaps, cone, XI, share * cone.Omega_m)
        expected = GAP + share**2 * (SLOPE * 5e-5 - 2e-5)
        np.testing.assert_allclose(gaps, expected, rtol=1e-9)
    given = {"leading_edge_m": GAP, "trailing_edge_m": GAP, "at": "rest"}
    gaps = gaps_at(scene(clearance=given).gaps, cone, XI, cone.Omega_m)
    np.testing.assert_allclose(gaps, GAP + SLOPE * 5e-5 - 2e-5, rtol=1e-9)


def test_a_run_beside_a_line_is_that_with_its_gaps_and_its_slope(cone):
    growth = 0.2 * 5e-5 + 2e-5
    gap = GAP - growth * (rad_s(cone, 0.3) / cone.Omega_m) ** 2
    now = {"leading_edge_m": gap, "trailing_edge_m": gap}
    changes = {"casing__harmonics": [{"order": 2, "amplitude_um": 130}]}
    line = of_line(beside(cone, GAP), **changes)
    cases = line, scene(clearance=now, casing__slope=SLOPE, **changes)
    (one, other), (a, b) = ([f(case, cone) for case in cases] for f in (marched, set_up))
    np.testing.assert_allclose(a.places.slope, b.places.slope, rtol=1e-9)
    assert one.wear.max() > 1e-6
    np.testing.assert_allclose(one.wear, other.wear, atol=1e-6 * float(one.wear.max()))


def test_a_shift_changes_the_gap_by_the_slope_times_it(cone, tmp_path):
    """A number or a table over the speed; along the radius it changes nothing, to the last bit."""
    path = tmp_path / "shift.csv"
    path.write_text("speed_over_f1,shift_mm\n0,0\n0.4,0.6\n")
    Omega, given = rad_s(cone, 0.2), scene()
    before = gaps_at(given.gaps, cone, XI, Omega)
    for shift in (1e6 * SHIFT, str(path)):
        case = given.but(casing__axial_shift_um=shift)
        np.testing.assert_allclose(
            gaps_at(case.gaps, cone, XI, Omega), before + SLOPE * SHIFT, rtol=1e-9
        )
        flat = case.but(casing__slope=0.0)
        np.testing.assert_array_equal(gaps_at(flat.gaps, cone, XI, Omega), before)
        assert case.gaps.vary == isinstance(shift, str)
    line = of_line(beside(cone, GAP), casing__axial_shift_um=1e6 * SHIFT)
    np.testing.assert_allclose(gaps_at(line.gaps, cone, XI, 0.0), GAP + SLOPE * SHIFT, rtol=1e-9)


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"casing__line": {"z_mm": [0, 1], "r_mm": [250, 250]}}, "clearance"),
        ({"clearance": None}, "clearance"),
        (
            {
                "clearance": None,
                "casing__line": {"z_mm": [0, 1], "r_mm": [250, 250]},
                "casing__slope": 0.1,
            },
            "casing.slope",
        ),
        (
            {"clearance": None, "casing__line": {"z_mm": [1, 0], "r_mm": [250, 250]}},
            "casing.line.z_mm",
        ),
        ({"casing__axial_shift_um": {"shift_um": [0, 1]}}, "casing.axial_shift_um"),
        ({"casing__axial_shift_um": "no-such-file.csv"}, "casing.axial_shift_um"),
    ],
)
def test_settings_that_do_not_hold_together(changes, key):
    assert refused(SettingsError, scene, **changes).key == key


def test_a_line_or_a_shift_that_does_not_fit_the_tip_is_refused(cone):
    """Beyond its ends, inside the tip, on a model without growth; a gap that the shift closes."""
    for case, key, told in (
        (of_line(beside(cone, GAP, beyond=-1.0)), "casing.line", "should cover the tip"),
        (of_line(beside(cone, -GAP)), "casing.line", "0.1 mm inside the tip"),
        (scene(casing__axial_shift_um=1000), "clearance", "the shift of the rotor closes it"),
    ):
        error = refused(SceneError, check_scene, case, cone)
        assert error.key == key and told in error.text
    unknown = replace(cone, growth=np.empty((0, 0)))
    assert refused(SceneError, check_scene, of_line(beside(cone, GAP)), unknown).key == (
        "casing.line"
    )
    table = {"speed_rpm": [0, 10], "shift_um": [0, 0]}
    short = refused(SceneError, check_scene, scene(casing__axial_shift_um=table), cone)
    assert short.key == "casing.axial_shift_um" and short.allowed == pytest.approx((0, 10))
