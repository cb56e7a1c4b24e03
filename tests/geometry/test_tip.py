"""Camber line and pressure side of an outline against the profile's closed form."""

import numpy as np
import pytest

from geometry.errors import MeshError
from geometry.profile import interface_points, profile_at
from geometry.tip import camber_height, camber_points, pressure_points

R = 0.5624
FRACTIONS = np.linspace(0, 1, 2000)
MIDDLES = (np.arange(8) + 0.5) / 8


@pytest.fixture(scope="module")
def profile(coarse_blade):
    return profile_at(coarse_blade.sections, R)


def on_cylinder(points):
    """Wrap y, z of a plane section on the tip cylinder, y as arc: the tip developed is exact."""
    _, y, z = points.T
    return np.column_stack([R * np.cos(y / R), R * np.sin(y / R), z])


def side(profile, xi, sign):
    w = 4 * xi * (1 - xi)
    half = profile.thickness / 2 * (profile.edge + (1 - profile.edge) * w)
    return on_cylinder(profile.place(xi, profile.camber * w + sign * half))


def outline_of(profile):
    """Blunt: each edge is the straight line between the ends of both sides."""
    return np.vstack([side(profile, FRACTIONS, +1), side(profile, FRACTIONS[::-1], -1)])


# polyline of 2000 pieces: sagitta (camber + t/2) / 2000^2 = 6e-10 m; measured 3e-10
POLYLINE = 1e-9


def test_camber_points_are_the_closed_form(profile):
    expected = on_cylinder(profile.camber_line(MIDDLES))
    found = camber_points(outline_of(profile), 8)
    np.testing.assert_allclose(found, expected, atol=POLYLINE)


def test_pressure_points_are_on_the_side_ahead(profile):
    found = pressure_points(outline_of(profile), 8)
    np.testing.assert_allclose(found, side(profile, MIDDLES, -1), atol=POLYLINE)
    assert np.all(found[:, 1] > camber_points(outline_of(profile), 8)[:, 1])


def test_order_and_start_of_the_outline_do_not_matter(profile):
    outline = outline_of(profile)
    expected = camber_points(outline, 5)
    for other in (outline[::-1], np.roll(outline, 777, axis=0)):
        np.testing.assert_allclose(camber_points(other, 5), expected, atol=1e-13)


def test_where_the_outline_has_its_points_does_not_matter(profile):
    """Half of them are near the leading edge: the principal axis is off the chord."""
    xi = np.concatenate([np.linspace(0, 0.05, 2000), FRACTIONS[101:]])
    outline = np.vstack([side(profile, xi, +1), side(profile, FRACTIONS[::-1], -1)])
    expected = on_cylinder(profile.camber_line(MIDDLES))
    np.testing.assert_allclose(camber_points(outline, 8), expected, atol=POLYLINE)


@pytest.mark.parametrize("angle", [0.3, 3.1, -2.0])
def test_points_turn_with_the_tip(profile, angle):
    """Also across theta = pi, where the angle jumps."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    for points in (camber_points, pressure_points):
        expected = points(outline_of(profile), 8) @ turn.T
        found = points(outline_of(profile) @ turn.T, 8)
        np.testing.assert_allclose(found, expected, atol=1e-13)


def test_a_mirror_swaps_the_sides(profile):
    """Against the rotation, what was behind is ahead; the camber line stays."""
    mirror = np.diag([1, -1, 1])
    mirrored = outline_of(profile) @ mirror
    expected = on_cylinder(profile.camber_line(MIDDLES)) @ mirror
    np.testing.assert_allclose(camber_points(mirrored, 8), expected, atol=POLYLINE)
    expected = side(profile, MIDDLES, +1) @ mirror
    np.testing.assert_allclose(pressure_points(mirrored, 8), expected, atol=POLYLINE)


def test_camber_height_is_the_mean_over_the_stations(profile):
    """Of the parabola over the chord between the first and the last; measured 1e-7 off."""
    xi = (np.arange(20) + 0.5) / 20
    w = 4 * xi * (1 - xi)
    height = camber_height(outline_of(profile))
    assert height == pytest.approx(0.03 * (w - w[0]).mean() / 0.95, rel=1e-6)
    half_turn = np.diag([1, -1, -1])
    assert camber_height(outline_of(profile) @ half_turn) == pytest.approx(-height, rel=1e-10)
    assert camber_height(outline_of(profile) @ np.diag([1, 1, -1])) == pytest.approx(height)


def test_round_edges_on_a_straight_camber_line():
    """A stadium 60 x 2 mm at 50 degrees: its camber line is its axis, ends included."""
    half, radius, angle = 0.03, 1e-3, np.radians(50)
    t = np.linspace(-np.pi / 2, np.pi / 2, 31)
    cap = np.column_stack([half - radius + radius * np.cos(t), radius * np.sin(t)])
    stadium = np.vstack([cap, -cap])
    c, s = np.cos(angle), np.sin(angle)
    flat = stadium @ np.array([[-s, c], [c, s]])  # columns y, z
    found = camber_points(on_cylinder(np.column_stack([np.zeros(len(flat)), flat])), 6)
    along = (2 * (np.arange(6) + 0.5) / 6 - 1) * half
    expected = on_cylinder(np.column_stack([np.zeros(6), -s * along, c * along]))
    np.testing.assert_allclose(found, expected, atol=1e-12)
    around = on_cylinder(np.column_stack([np.zeros(len(flat)), flat]))
    assert camber_height(around) == pytest.approx(0, abs=1e-10)  # has no hollow side


def test_radius_is_interpolated_on_a_tip_that_is_no_cylinder(profile):
    outline = outline_of(profile)
    cone = outline * (1 + outline[:, 2:]) ** [1, 1, 0]
    for points in (camber_points, pressure_points):
        found = points(cone, 8)
        radius = np.hypot(found[:, 0], found[:, 1])
        np.testing.assert_allclose(radius, R * (1 + found[:, 2]), atol=POLYLINE)


def test_coarse_outline_of_the_real_tip_is_near_the_rule_of_the_sections(profile, coarse_blade):
    """Eleven points a side, as on a coarse mesh; measured 0.037 mm.

    The sections' rule shares the chord of the plane section; here it is that of the cylinder.
    """
    xi = np.linspace(0, 1, 11)
    outline = np.vstack([side(profile, xi, +1), side(profile, xi[::-1], -1)])
    expected = interface_points(coarse_blade.sections, 8)
    np.testing.assert_allclose(camber_points(outline, 8), expected, atol=5e-5)


def test_outline_that_folds_over_its_chord_is_refused():
    """A half ring: the lines across its chord near the ends meet four sides."""
    t = np.linspace(-0.8 * np.pi, 0.8 * np.pi, 101)
    ring = np.vstack(
        [r * np.column_stack([np.sin(a), np.cos(a)]) for r, a in ((0.03, t), (0.02, t[::-1]))]
    )
    points = np.column_stack([np.full(len(ring), R), ring])
    with pytest.raises(MeshError, match=r"folds over its chord.* meets 4 sides.*points_mm"):
        camber_points(points, 8)
