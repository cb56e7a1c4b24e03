"""NASA rotor 37 on a coarse mesh: against its table, and as a substitute for the paper's blade."""

import meshio
import numpy as np
import pytest
from blades import camber_line, facets_of, given, nodes_of
from scipy.interpolate import CubicSpline

from fem.assemble import assemble
from geometry.blade import Blade
from geometry.mesh import build_mesh
from geometry.project import ROOT
from rom.modes import ShiftInvert

BLADES = ROOT / "workflow/blades"
SECTIONS, POINTS = 6, 80


@pytest.fixture(scope="module")
def rotor37():
    blade = Blade.load(BLADES / "rotor37.yaml")
    return given(blade, mesh={"element_size_mm": 4.0}, interface={"patches": 8})


@pytest.fixture(scope="module")
def built(rotor37, tmp_path_factory):
    mesh = tmp_path_factory.mktemp("rotor37") / "blade.msh"
    return build_mesh(rotor37, mesh, BLADES / rotor37.file), mesh


@pytest.fixture(scope="module")
def table():
    """Outlines (sections, points, xyz), m, in the file's axes: z outward."""
    values = np.loadtxt(BLADES / "rotor37-sections.csv", delimiter=",", skiprows=9)
    return 1e-3 * values[:, 1:].reshape(SECTIONS, POINTS, 3)


def area(outline):
    """Size of the vector area of a closed outline (points, 3), m2."""
    return np.linalg.norm(np.cross(outline, np.roll(outline, -1, axis=0)).sum(axis=0)) / 2


def test_volume_is_that_of_the_table_and_no_cell_is_turned(built, table):
    projected = [area(outline * [1, 1, 0]) for outline in table]
    height = table[..., 2].mean(axis=1)
    whole = CubicSpline(height, projected).integrate(height[0], height[-1])
    # the cut takes 0.3 % away, the curved sections' mean height is right to as much; -0.09 %
    assert built[0].volume == pytest.approx(whole, rel=5e-3)
    assert built[0].smallest_jacobian > 0.1  # measured 0.14, by gmsh's bounds


def test_root_and_tip_are_the_first_and_last_section(built, table):
    mesh = meshio.read(built[1])
    for group, outline in (("root", table[0]), ("tip", table[-1])):
        # cutting the ends takes 0.3 to 0.5 % away, flat facets on curved edges the rest
        share = size_of(mesh, group) / area(outline)
        assert 0.985 < share < 0.998  # measured 0.994 and 0.990
        points = nodes_of(mesh, group) @ [[0, 0, 1], [0, -1, 0], [1, 0, 0]]  # the file's axes
        gap = np.linalg.norm(points[:, None] - outline, axis=2).min(axis=1)
        assert gap.max() < 3e-3  # half the largest thickness, and half a step between points


def size_of(mesh, group):
    """Area of a physical group, its facets taken as flat, m2."""
    facets = facets_of(mesh, group)
    a, b, c = (mesh.points[facets[:, i]] for i in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def test_leading_edge_is_upstream_and_ahead_in_rotation(built):
    line = camber_line(built[1])
    radius = np.hypot(line[:, 0], line[:, 1])
    assert np.all(np.diff(line[:, 2]) > 0)  # downstream
    assert np.all(np.diff(np.arctan2(line[:, 1], line[:, 0])) < 0)
    assert np.all(np.diff(radius) < 0)  # the casing narrows
    # of the casing's cone at both ends of the tip, which is cut
    np.testing.assert_allclose(radius[[0, -1]], [0.2523, 0.2447], atol=2e-4)


def test_engine_order_4_crosses_f1_at_the_speed_of_the_papers_blade(built, rotor37):
    """0.3112 of f1(0) on a fine mesh; the paper's blade: 0.310."""
    fom = assemble(rotor37, "rotor37", built[1], np.linspace(0, rotor37.max_speed_rad_s, 3))
    f1 = np.array([ShiftInvert(K, fom.M).modes(1).omega[0] for K in fom.K])
    assert f1[0] == pytest.approx(2 * np.pi * 856.5, rel=5e-3)  # at 1.2 mm; measured +0.25 %
    # f1^2 is smooth in Omega^2: a parabola through three speeds meets (4 Omega)^2
    c2, c1, c0 = np.polyfit(fom.speeds**2, f1**2, 2)
    squares = np.roots([c2, c1 - 16, c0])
    crossing = np.sqrt(squares[squares > 0].min()) / f1[0]
    assert crossing == pytest.approx(0.311, abs=1e-3)
