"""Chord, camber line and pressure side of an outline against the profile's closed form."""

import numpy as np
import pytest
from blades import height
from refused import refused

from geometry.base import MeshError
from geometry.profile import profile_at
from geometry.tip import DevelopedTip, cartesian

R = 0.5624
FRACTIONS = np.linspace(0, 1, 2000)
MIDDLES = (np.arange(8) + 0.5) / 8
PLACES = np.linspace(0, 1, 101)  # of the camber line, both ends included


@pytest.fixture(scope="module")
def profile(coarse_blade):
    return profile_at(coarse_blade.sections, R)


def on_cylinder(points):
    """Wrap y, z of a plane section on the tip cylinder, y as arc: the tip developed is exact."""
    _, y, z = points.T
    return np.column_stack([R * np.cos(y / R), R * np.sin(y / R), z])


def side(profile, xi, sign):
    return on_cylinder(profile.place(xi, height(profile, xi, sign)))


@pytest.fixture(scope="module")
def outline(profile):
    """Blunt: each edge is the straight line between the ends of both sides."""
    return np.vstack([side(profile, FRACTIONS, +1), side(profile, FRACTIONS[::-1], -1)])


# polyline of 2000 pieces: sagitta (camber + t/2) / 2000^2 = 6e-10 m; measured 3e-10
POLYLINE = 1e-9


def camber_line(outline):
    """Camber line (101, 3), m, x, y, z."""
    return cartesian(DevelopedTip.of(outline).camber_line())


@pytest.mark.parametrize(
    ("suction", "pressure", "error"),
    [
        (FRACTIONS, FRACTIONS, POLYLINE),
        # half of the points are near the leading edge: the principal axis is off the chord
        (np.concatenate([np.linspace(0, 0.05, 2000), FRACTIONS[101:]]), FRACTIONS, POLYLINE),
        # as on a coarse mesh: sagitta (camber + t/2) / 100 = 32 um a side
        (np.linspace(0, 1, 11), np.linspace(0, 1, 11), 5e-5),
    ],
)
def test_the_camber_line_is_that_of_the_closed_form_including_both_ends(
    profile, suction, pressure, error
):
    """Whatever the density of points on the outline."""
    outline = np.vstack([side(profile, suction, +1), side(profile, pressure[::-1], -1)])
    expected = side(profile, PLACES, 0)
    np.testing.assert_allclose(camber_line(outline), expected, atol=error)


def test_the_chord_fraction_is_zero_and_one_at_the_extremes_and_the_sections_between(
    profile, outline
):
    tip = DevelopedTip.of(outline)
    xi = tip.xi(outline)
    assert (xi.min(), xi.max()) == pytest.approx((0, 1), abs=4 * np.finfo(float).eps)
    for sign in (-1, 0, 1):
        line = side(profile, FRACTIONS, sign)
        np.testing.assert_allclose(tip.xi(line), FRACTIONS, atol=1e-8)  # as the camber line
    far = on_cylinder(profile.place([-0.1, 1.2], 0.0))
    np.testing.assert_allclose(tip.xi(far), [-0.1, 1.2], atol=1e-8)


def test_developed_tip_keeps_lengths_along_the_chord_and_ahead_of_it(profile, outline):
    """Heights are over the chord: its ends are at one height, the hollow side's ahead."""
    tip = DevelopedTip.of(outline)
    along, ahead = tip.developed(on_cylinder(profile.place([0, 1, 0.5], [0, 0, -1e-3]))).T
    assert along[1] - along[0] == pytest.approx(profile.chord, rel=1e-8)
    assert ahead - ahead[0] == pytest.approx([0, 0, 1e-3], abs=1e-9)


def pressure_side(outline, xi=MIDDLES):
    return cartesian(DevelopedTip.of(outline).pressure_side(xi))


def test_pressure_side_is_the_side_ahead(profile, outline):
    found = pressure_side(outline)
    np.testing.assert_allclose(found, side(profile, MIDDLES, -1), atol=POLYLINE)
    assert np.all(found[:, 1] > side(profile, MIDDLES, 0)[:, 1])


def test_order_and_start_of_the_outline_do_not_matter(outline):
    expected = camber_line(outline)
    for other in (outline[::-1], np.roll(outline, 777, axis=0)):
        np.testing.assert_allclose(camber_line(other), expected, atol=1e-13)
        np.testing.assert_allclose(
            DevelopedTip.of(other).xi(outline), DevelopedTip.of(outline).xi(outline)
        )


@pytest.mark.parametrize("angle", [0.3, 3.1, -2.0])
def test_points_turn_with_the_tip(outline, angle):
    """Also across theta = pi, where the angle jumps."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    for points in (camber_line, pressure_side):
        found = points(outline @ turn.T)
        np.testing.assert_allclose(found, points(outline) @ turn.T, atol=1e-13)
    xi = DevelopedTip.of(outline @ turn.T).xi(outline @ turn.T)
    np.testing.assert_allclose(xi, DevelopedTip.of(outline).xi(outline), atol=1e-11)


def test_a_mirror_swaps_the_sides(profile, outline):
    """The side behind is then ahead; the camber line is the same."""
    mirror = np.diag([1, -1, 1])
    mirrored = outline @ mirror
    expected = side(profile, PLACES, 0) @ mirror
    np.testing.assert_allclose(camber_line(mirrored), expected, atol=POLYLINE)
    expected = side(profile, MIDDLES, +1) @ mirror
    np.testing.assert_allclose(pressure_side(mirrored), expected, atol=POLYLINE)


def test_camber_height_is_the_mean_over_the_stations(outline):
    """Of the parabola over the chord between the first and the last; measured 1e-7 off."""
    xi = (np.arange(20) + 0.5) / 20
    w = 4 * xi * (1 - xi)
    height = DevelopedTip.of(outline).camber_height()
    assert height == pytest.approx(0.03 * (w - w[0]).mean() / 0.95, rel=1e-6)
    half_turn, mirror = np.diag([1, -1, -1]), np.diag([1, 1, -1])
    turned = DevelopedTip.of(outline @ half_turn).camber_height()
    assert turned == pytest.approx(-height, rel=1e-10)
    assert DevelopedTip.of(outline @ mirror).camber_height() == pytest.approx(height)


def test_round_edges_on_a_straight_camber_line():
    """A stadium 60 x 2 mm at 50 degrees: its camber line is its axis, ends included."""
    half, radius, angle = 0.03, 1e-3, np.radians(50)
    t = np.linspace(-np.pi / 2, np.pi / 2, 31)
    cap = np.column_stack([half - radius + radius * np.cos(t), radius * np.sin(t)])
    stadium = np.vstack([cap, -cap])
    c, s = np.cos(angle), np.sin(angle)
    flat = stadium @ np.array([[-s, c], [c, s]])  # columns y, z
    around = on_cylinder(np.column_stack([np.zeros(len(flat)), flat]))
    along = (2 * PLACES - 1) * half
    expected = on_cylinder(np.column_stack([np.zeros(101), -s * along, c * along]))
    np.testing.assert_allclose(camber_line(around), expected, atol=1e-12)
    assert DevelopedTip.of(around).camber_height() == pytest.approx(
        0, abs=1e-10
    )  # has no hollow side


def test_the_radius_is_interpolated_on_a_conical_tip(outline):
    cone = outline * (1 + outline[:, 2:]) ** [1, 1, 0]
    tip = DevelopedTip.of(cone)
    for r, _, z in (*tip.camber_line(), *tip.pressure_side(MIDDLES)):
        assert r == pytest.approx(R * (1 + z), abs=POLYLINE)


def test_outline_that_folds_over_its_chord_is_refused():
    """A half ring: the lines across its chord near the ends meet four sides."""
    t = np.linspace(-0.8 * np.pi, 0.8 * np.pi, 101)
    ring = np.vstack(
        [r * np.column_stack([np.sin(a), np.cos(a)]) for r, a in ((0.03, t), (0.02, t[::-1]))]
    )
    points = np.column_stack([np.full(len(ring), R), ring])
    refused(MeshError, DevelopedTip.of(points).camber_line, match="meets 4 sides")


def between(behind, thickness, z):
    """Outline (2 m, 3), m, of a tip with the angle ``behind`` (m,), rad, ``thickness`` and z."""
    theta = np.concatenate([behind, (behind + thickness)[::-1]])
    return np.column_stack([R * np.cos(theta), R * np.sin(theta), np.concatenate([z, z[::-1]])])


@pytest.fixture(scope="module")
def bent():
    """Angle behind, thickness, z: staggered by 48 degrees, bent, thick in the middle."""
    z = np.linspace(0, 0.04, 800)
    behind = 1.1 * z / R + 30 * (z - 0.02) ** 2 / R
    return behind, (0.4e-3 + 10 * z * (0.04 - z)) / R, z


def test_edges_at_equal_z_are_those_of_the_closed_form(bent):
    behind, thickness, z = bent
    tip = DevelopedTip.of(between(*bent))
    assert tip.has_two_edges
    edges, inside = [behind, behind + thickness], slice(1, -1)  # both ends are straight cuts
    found = tip.at_z(z)[:, inside]
    np.testing.assert_allclose(found, np.array(edges)[:, inside], rtol=0, atol=1e-12)
    at, share = np.linspace(50, 749, 30).astype(int), np.linspace(0, 1, 30)
    theta = behind[at] + share * thickness[at]
    xi, eta = tip.across(cartesian(np.column_stack([np.full(30, R), theta, z[at]])))
    np.testing.assert_allclose(eta, share, rtol=0, atol=1e-10)
    line = np.interp(xi, PLACES, tip.camber_line()[:, 2])
    np.testing.assert_allclose(line, z[at], rtol=0, atol=1e-12)


def test_a_tip_that_a_circle_meets_more_than_twice_has_no_two_edges(bent):
    """A bend that brings the sides back to the same z; whatever the density of its points."""
    for count in (40, 800):
        along, across = np.linspace(-0.02, 0.02, count), 1e-3
        turned = np.radians(75)
        rise = -60 * along**2
        s = along * np.sin(turned) + rise * np.cos(turned)
        z = along * np.cos(turned) - rise * np.sin(turned)
        theta = np.concatenate([s, (s + across)[::-1]]) / R
        folded = cartesian(np.column_stack([np.full(2 * count, R), theta, [*z, *z[::-1]]]))
        tip = DevelopedTip.of(folded)
        assert not tip.has_two_edges and tip.at_z(z).shape == (2, 0)
        refused(MeshError, tip.across, folded, match="interface.across: .*twice")
