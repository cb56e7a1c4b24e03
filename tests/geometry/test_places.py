"""Interface nodes by every rule, on the coarse reference blade."""

import meshio
import numpy as np
import pytest
from blades import given, nodes_of

from geometry.interface import InterfaceNodes
from geometry.mesh import MeshError, build_mesh
from geometry.profile import profile_at


def built(blade, rule, folder):
    mesh, interface = folder / "blade.msh", folder / "interface.csv"
    build_mesh(given(blade, interface=rule), mesh, interface)
    return meshio.read(mesh), InterfaceNodes.load(interface)


def on_tip(sections, xi, side):
    """Camber line (0) or pressure side (-1) at chord fraction xi, on the tip cylinder."""
    x = sections.tip_radius
    for _ in range(20):
        profile = profile_at(sections, x)
        w = 4 * xi * (1 - xi)
        half = profile.thickness / 2 * (profile.edge + (1 - profile.edge) * w)
        _, y, z = profile.place(xi, profile.camber * w + side * half)[0]
        x = np.sqrt(sections.tip_radius**2 - y**2)
    return np.array([x, y, z])


def test_pressure_side_nodes_lie_on_the_edge_of_the_tip_that_leads(coarse_blade, tmp_path):
    mesh, nodes = built(coarse_blade, {"nodes": 5, "along": "pressure-side"}, tmp_path)
    s = coarse_blade.sections
    # the chord of the developed tip is that of the section but for its ends: measured 2.5e-4
    nearby = np.linspace(-5e-4, 5e-4, 41)
    for point, xi in zip(nodes.points, np.arange(0.1, 1, 0.2), strict=True):
        side = np.array([on_tip(s, xi + d, -1) for d in nearby])
        gap = np.linalg.norm(side - point, axis=1).min()
        assert gap < 1e-6  # half the way, 1.6 um, between points of `side`; measured 0.7 um
    assert np.abs(nodes.radius - s.tip_radius).max() < 1e-8
    for group, radius in (("root", s.hub_radius), ("tip", s.tip_radius)):  # found again
        points = nodes_of(mesh, group)
        assert len(points) > 30
        np.testing.assert_allclose(np.hypot(points[:, 0], points[:, 1]), radius, atol=1e-8)


def listed(sections, *places):
    return [np.round(1e3 * on_tip(sections, *place), 3).tolist() for place in places]


def test_listed_points_become_nodes_inside_the_tip_and_on_its_edge(coarse_blade, tmp_path):
    points = listed(coarse_blade.sections, (0.2, -1), (0.4, 0), (0.6, -1))
    mesh, nodes = built(coarse_blade, {"points_mm": points}, tmp_path)
    # three digits put the points up to 0.5 um off the tip along each axis
    np.testing.assert_allclose(1e3 * nodes.points, points, atol=1e-3)
    assert np.abs(nodes.radius - coarse_blade.sections.tip_radius).max() < 1e-8
    gap = np.linalg.norm(nodes.points[:, None] - nodes_of(mesh, "tip"), axis=2).min(axis=1)
    assert gap.max() < 1e-15


@pytest.mark.parametrize(
    ("move", "sentence"),
    [
        ([5, 0, 0], r"interface.points_mm: point 2 lies 5 mm off the tip; allowed 0.1 mm"),
        ([0, 10, 0], r"point 2 lies [5-9]\.\d+ mm off the tip"),  # beside it, at its radius
    ],
)
def test_a_listed_point_off_the_tip_is_refused(coarse_blade, tmp_path, move, sentence):
    points = listed(coarse_blade.sections, (0.2, 0), (0.4, 0))
    points[1] = (np.array(points[1]) + move).tolist()
    with pytest.raises(MeshError, match=sentence):
        built(coarse_blade, {"points_mm": points}, tmp_path)
    assert not list(tmp_path.iterdir())


def test_points_listed_from_the_trailing_edge_are_refused(coarse_blade, tmp_path):
    points = listed(coarse_blade.sections, (0.4, 0), (0.2, 0))
    with pytest.raises(MeshError, match="do not run downstream"):
        built(coarse_blade, {"points_mm": points}, tmp_path)
