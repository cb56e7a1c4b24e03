"""Sections in closed form, against polygons drawn from their definition."""

from dataclasses import replace

import numpy as np
import pytest
from blades import height

from geometry.profile import Airfoil, profile_at

HUB = Airfoil(0.42, 0.066, 0.0056, 0.004, 0.25, np.radians(18), (0.001, -0.003))
PROFILES = [
    pytest.param(HUB, id="hub"),
    pytest.param(replace(HUB, camber=0.02, edge=0.01), id="sharp and cambered"),
    pytest.param(replace(HUB, camber=0.0, edge=1.0, stagger=0.0), id="rectangle"),
    pytest.param(replace(HUB, thickness=0.03, stagger=np.radians(-70)), id="thick, turned back"),
]


def polygon(profile, n=2000):
    """Outline (2n, 2) in the plane (y, z), from the definition."""
    xi = np.linspace(0, 1, n)
    heights = [height(profile, xi, +1), height(profile, xi, -1)[::-1]]
    return profile.place(np.r_[xi, xi[::-1]], np.concatenate(heights))[:, 1:]


def area_and_centroid(points):
    """Shoelace formula."""
    next_ = np.roll(points, -1, axis=0)
    cross = points[:, 0] * next_[:, 1] - next_[:, 0] * points[:, 1]
    return cross.sum() / 2, ((points + next_) * cross[:, None]).sum(axis=0) / (3 * cross.sum())


@pytest.mark.parametrize("profile", PROFILES)
def test_area_and_centroid_are_those_of_a_fine_polygon(profile):
    area, centroid = area_and_centroid(polygon(profile))
    # chords of a parabola miss 1/n^2 = 2.5e-7 of its area
    assert abs(area) == pytest.approx(profile.area, rel=1e-6)
    assert centroid == pytest.approx(profile.offset, abs=1e-6 * profile.chord)


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("side", [+1, -1])
def test_bezier_curve_is_the_side_of_the_section(profile, side):
    t = np.linspace(0, 1, 11)
    curve = np.column_stack([(1 - t) ** 2, 2 * t * (1 - t), t**2]) @ profile.bezier(side)
    # the same parabola in two bases: round-off of lengths of 0.4 m
    np.testing.assert_allclose(curve, profile.place(t, height(profile, t, side)), atol=1e-15)


def test_leading_edge_is_upstream_and_ahead_and_the_suction_side_looks_back():
    xi = np.array([0, 0.5, 1])
    leading, middle, trailing = HUB.place(xi, height(HUB, xi, 0))
    assert leading[2] < trailing[2]
    assert leading[1] > trailing[1]
    assert middle[1] < (leading[1] + trailing[1]) / 2


def test_sections_run_linearly_from_hub_to_tip_and_beyond(coarse_blade):
    blade = coarse_blade
    hub, tip = blade.sections.hub, blade.sections.tip
    for fraction in (-0.03, 0, 0.4, 1, 1.03):
        profile = profile_at(
            blade.sections, blade.sections.hub_radius + fraction * blade.sections.span
        )
        chord = (1 - fraction) * hub.chord_mm + fraction * tip.chord_mm
        camber = (1 - fraction) * hub.camber_percent + fraction * tip.camber_percent
        expected = {
            "chord": chord * 1e-3,
            "thickness": ((1 - fraction) * hub.thickness_mm + fraction * tip.thickness_mm) * 1e-3,
            "camber": chord * 1e-3 * camber / 100,
            "edge": 0.25,
            "stagger": np.radians((1 - fraction) * 18 + fraction * 48),
            "offset": (fraction * 0.95e-3, fraction * -2.9e-3),
        }
        for name, value in expected.items():
            # round-off: x enters as (x - hub radius) / span
            assert getattr(profile, name) == pytest.approx(value, rel=1e-12, abs=1e-16), name
