"""Slope of the tip: of a cone, of a cut by a plane, of what is too little to count."""

import numpy as np
import pytest

from geometry.tip import FLAT, LEAST_SLOPE, slope_of_tip

PLACES = 41
ANGLE = 0.06  # rad, of the line
LENGTH = 0.05  # m, axial


def tip(radius):
    """Nodes (n, 3) of a tip 3 mm thick and its camber line, with ``radius`` (r(theta, z))."""
    xi = np.linspace(0, 1, PLACES)
    lines = []
    for across in (-0.003, 0.0, 0.003):  # rad
        theta, z = 0.4 + ANGLE * xi + across, LENGTH * (xi - 0.3)
        lines.append(np.column_stack([radius(theta, z), theta, z]))
    r, theta, z = np.concatenate(lines).T
    return np.column_stack([r * np.cos(theta), r * np.sin(theta), z]), lines[1]


def plane(tilt):
    """Radius over theta and z of a plane across the radius at the line's mean angle, tilted."""
    middle = 0.4 + ANGLE / 2
    return lambda theta, z: (0.5 + tilt * z) / np.cos(theta - middle)


def test_a_cone_has_its_slope_at_each_place():
    nodes, line = tip(lambda theta, z: 0.5 - 0.2 * z + 2.0 * z**2)
    exact = -0.2 + 4.0 * line[:, 2]
    found = slope_of_tip(nodes, line)
    np.testing.assert_allclose(found[1:-1], exact[1:-1], atol=1e-12)  # central differences
    np.testing.assert_allclose(found, exact, atol=4.0 * LENGTH / PLACES)


@pytest.mark.parametrize("tilt", [0.0, -0.2])
def test_a_tip_cut_flat_has_the_one_slope_of_the_plane(tilt):
    """Its line has others, through its sagitta."""
    nodes, line = tip(plane(tilt))
    assert abs(np.gradient(line[:, 0], line[:, 2]) - tilt).max() > 0.01
    np.testing.assert_allclose(slope_of_tip(nodes, line), tilt, atol=1e-9)
    # off the plane by more than a flat cut may be, it is a line like any other
    bent = nodes + np.column_stack([3 * FLAT * np.cos(1e3 * nodes[:, 2]), 0 * nodes[:, :2]])
    assert abs(slope_of_tip(bent, line) - tilt).max() > 0.01


def test_smaller_slopes_count_as_none():
    for slope in (0.99 * LEAST_SLOPE, -0.99 * LEAST_SLOPE):
        nodes, line = tip(lambda theta, z, slope=slope: 0.5 + slope * z)
        assert not slope_of_tip(nodes, line).any()
    nodes, line = tip(lambda theta, z: 0.5 + 1.01 * LEAST_SLOPE * z)
    assert slope_of_tip(nodes, line).all()
