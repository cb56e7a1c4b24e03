"""The mesh against the blade's definition; invalid blades are refused with one sentence."""

from dataclasses import replace
from pathlib import Path

import gmsh
import meshio
import numpy as np
import pytest
from blades import EDGES, jacobians, nodes_of, on_tip, volume
from refused import refused

import geometry.mesh
from geometry.base import RPM, WriteError
from geometry.mesh import MeshError, build_mesh
from geometry.profile import profile_at


@pytest.fixture(scope="module")
def summary(coarse_mesh):
    return coarse_mesh.summary


@pytest.fixture(scope="module")
def mesh(coarse_mesh):
    return meshio.read(coarse_mesh.mesh)


def test_every_jacobian_is_positive_at_all_ten_nodes(summary, mesh):
    corners = np.eye(4)
    nodes = np.vstack([corners, [(corners[a] + corners[b]) / 2 for a, b in EDGES]])
    assert jacobians(mesh.points, mesh.cells_dict["tetra10"], nodes).min() > 0
    assert summary.smallest_jacobian > 0


def test_summary_counts_and_measures_what_is_in_the_file(summary, mesh):
    assert summary.nodes == len(mesh.points)
    assert summary.cells == len(mesh.cells_dict["tetra10"])
    exact = volume(mesh.points, mesh.cells_dict["tetra10"])
    assert summary.volume == pytest.approx(exact, rel=1e-12)  # round-off of 800 cells


def test_volume_is_that_of_the_cad(summary):
    # curved ten-node cells: measured -1.3e-7; straight cells on the same corners miss 0.9 %
    assert summary.volume == pytest.approx(summary.cad_volume, rel=1e-6)


def test_volume_is_the_integral_of_the_closed_form_area(summary, coarse_blade):
    """The planes' integral is 1.6e-4 too large; with the cylinders' cut it is right to 1e-6.

    Hub and tip are cylinders, so a column at y ends y^2/2r short of the plane x = r.
    """
    blade = coarse_blade.sections
    hub, middle, tip = (profile_at(blade, blade.hub_radius + f * blade.span) for f in (0, 0.5, 1))
    planes = blade.span * (hub.area + 4 * middle.area + tip.area) / 6  # area is quadratic in x
    cut = moment(hub) / (2 * blade.hub_radius) - moment(tip) / (2 * blade.tip_radius)
    assert summary.volume / planes - 1 == pytest.approx(-1.6e-4, abs=1e-5)
    # left: y^4/8r^3, slope of the sides within the cut, nine lofted planes; measured 1.6e-7
    assert summary.volume == pytest.approx(planes + cut, rel=1e-6)


def moment(profile):
    """Integral of y^2 over the section, m4, by a product Gauss rule."""
    points, weights = np.polynomial.legendre.leggauss(6)  # exact: degree 10 along the chord
    points, weights = (points + 1) / 2, weights / 2
    xi, eta = (axis.ravel() for axis in np.meshgrid(points, points))
    w = 4 * xi * (1 - xi)
    thickness = profile.thickness * (profile.edge + (1 - profile.edge) * w)
    y = profile.place(xi, profile.camber * w + (eta - 0.5) * thickness)[:, 1]
    return (np.outer(weights, weights).ravel() * profile.chord * thickness) @ y**2


def test_groups_are_blade_root_and_tip_and_none_is_a_point(mesh):
    """A group of dimension 0 makes DOLFINx's reader abort."""
    groups = {name: int(dimension) for name, (_, dimension) in mesh.field_data.items()}
    assert groups == {"blade": 3, "root": 2, "tip": 2}
    assert {block.type for block in mesh.cells} == {"tetra10", "triangle6"}


@pytest.mark.parametrize(("group", "radius"), [("root", 0.4224), ("tip", 0.5624)])
def test_root_and_tip_lie_on_their_cylinders_with_every_node_there(mesh, group, radius):
    """No facet of root or tip is left unclamped or uncounted."""
    nodes = nodes_of(mesh, group)
    assert len(nodes) > 30
    # OpenCASCADE's own tolerance is 1e-7; gmsh projects nodes to round-off of it
    np.testing.assert_allclose(np.hypot(nodes[:, 0], nodes[:, 1]), radius, atol=1e-8)
    everywhere = np.hypot(mesh.points[:, 0], mesh.points[:, 1])
    assert (abs(everywhere - radius) < 1e-8).sum() == len(nodes)


REFUSED = [
    # at this stagger and camber the leading edge's camber line runs upstream
    ({"tip__stagger_deg": 80, "tip__camber_percent": 30}, "does not run downstream; check the st"),
    # thickness is negative below the hub: the loft turns inside out
    ({"hub__thickness_mm": 0.01, "tip__thickness_mm": 10}, r"root face of .* check its thickness"),
    # leaned out of the tip cylinder
    ({"tip_lean_tangential_mm": 3000}, "loft to 2 solids, not one; check the sections"),
    # leaned so far that the cylinder cuts the section at 70 degrees
    ({"tip_lean_axial_mm": 400}, r"tip face of .* chord and lean against the radius"),
    # edges thinner than OpenCASCADE's 1e-7 m
    ({"edge_thickness_percent": 0.001}, "gmsh: .*; check the sections"),
]


@pytest.mark.parametrize(("sections", "sentence"), REFUSED)
def test_blade_that_cannot_be_built_is_refused_in_a_sentence(
    coarse_blade, tmp_path, sections, sentence
):
    blade = coarse_blade.but(**{f"sections__{key}": value for key, value in sections.items()})
    refused(MeshError, build_mesh, blade, tmp_path / "b.msh", match=sentence)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("size", "bound", "allowed"),
    [
        # 2.79e-5 m3 in cells of 3 um: 8.8e12 of them; 0.362 mm is the least allowed
        (0.003, "ge", 1.05 * 0.362),
        (200, "le", 148.4 / 4),  # longer than the blade
    ],
)
def test_size_of_elements_is_refused_before_meshing(
    coarse_blade, tmp_path, monkeypatch, size, bound, allowed
):
    monkeypatch.setattr(geometry.mesh, "generate", lambda size: pytest.fail("meshes"))
    blade = coarse_blade.but(mesh__element_size_mm=size)
    error = refused(MeshError, build_mesh, blade, tmp_path / "b.msh")
    assert (error.key, error.value) == ("mesh.element_size_mm", size)
    assert error.allowed[bound] == pytest.approx(allowed, rel=1e-3)


def test_speed_in_rpm_is_refused_and_the_fastest_tips_are_not(coarse_blade, tmp_path):
    rpm = coarse_blade.model_copy(update={"max_speed_rpm": RPM * 6207.0})
    error = refused(MeshError, build_mesh, rpm, tmp_path / "b.msh")
    assert (error.key, error.value) == ("max_speed_rpm", RPM * 6207.0)
    assert not list(tmp_path.iterdir())
    fast = coarse_blade.model_copy(update={"max_speed_rpm": RPM * 600 / 0.5624})
    line = np.array([on_tip(coarse_blade.sections, xi, 0) for xi in (0, 0.5, 1)])
    geometry.mesh._check_speed(line, fast)


@pytest.mark.parametrize(
    ("fault", "sentence"),
    [
        ({"smallest_jacobian": -0.25}, r"_mm: 10: .* inside out \(Jacobian ratio -0.25\)"),
        ({"smallest_jacobian": 0.0}, "inside out"),
        ({"smallest_jacobian": np.nan}, "inside out"),
        ({"volume": np.nan}, "_mm: 10: the mesh is"),
        ({"volume": 2.9e-5}, r"_mm: 10: the mesh is \+3.8 % off the volume .* 2.79\d*e-05 m3"),
    ],
)
def test_mesh_that_fails_a_check_is_not_written(
    summary, coarse_blade, tmp_path, monkeypatch, fault, sentence
):
    bad = replace(summary, **fault)
    monkeypatch.setattr(geometry.mesh, "_summary", lambda *_: bad)
    refused(MeshError, build_mesh, coarse_blade, tmp_path / "blade.msh", match=sentence)
    assert not list(tmp_path.iterdir())


def test_same_blade_gives_the_same_mesh(mesh, coarse_blade, tmp_path):
    build_mesh(coarse_blade, tmp_path / "blade.msh")
    again = meshio.read(tmp_path / "blade.msh")
    np.testing.assert_array_equal(again.points, mesh.points)
    np.testing.assert_array_equal(again.cells_dict["tetra10"], mesh.cells_dict["tetra10"])


@pytest.mark.parametrize("share", [0.3, 0.9])
def test_a_mesh_not_written_whole_leaves_no_file(coarse_blade, tmp_path, monkeypatch, share):
    """On a full disk gmsh writes what has room, and says nothing."""
    write = gmsh.write

    def write_part(path):
        write(path)
        data = Path(path).read_bytes()
        Path(path).write_bytes(data[: int(share * len(data))])

    monkeypatch.setattr(gmsh, "write", write_part)
    error = refused(WriteError, build_mesh, coarse_blade, tmp_path / "blade.msh")
    assert error.file == str(tmp_path / "blade.msh")
    assert not list(tmp_path.iterdir())
