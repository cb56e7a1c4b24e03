"""Fields of the whole blade and their VTK file, read back by ParaView's library."""

import meshio
import numpy as np
import pytest
import pyvista as pv
from blades import EDGES
from refused import refused

from fem.fields import away, fields, on_solid


@pytest.fixture(scope="module")
def shaken(coarse_blade, coarse_mesh, coarse_matrices):
    """The coarse blade at Omega_m, and a vibration that names its place."""
    coordinates = coarse_matrices.coordinates
    static = coarse_matrices.u_static[-1]
    return fields(coarse_blade, coarse_mesh.mesh, coordinates, static, place(coordinates).ravel())


def place(X):
    return 1e-3 * X[:, [1, 2, 0]]


def test_displacements_are_where_they_belong_whatever_their_order(
    coarse_blade, coarse_mesh, coarse_matrices, shaken
):
    radius = np.hypot(shaken.points[:, 0], shaken.points[:, 1])
    clamped = radius < coarse_blade.sections.hub_radius + 1e-8  # geometry.mesh.ON_CYLINDER
    assert 0 < clamped.sum() < len(clamped) == coarse_mesh.summary.nodes
    np.testing.assert_array_equal(shaken.vibration[~clamped], place(shaken.points[~clamped]))
    assert not shaken.vibration[clamped].any() and not shaken.static[clamped].any()
    order = np.random.default_rng(1).permutation(len(coarse_matrices.coordinates))
    X = coarse_matrices.coordinates[order]
    static = coarse_matrices.u_static[-1].reshape(-1, 3)[order].ravel()
    again = fields(coarse_blade, coarse_mesh.mesh, X, static, place(X).ravel())
    np.testing.assert_array_equal(again.static, shaken.static)
    np.testing.assert_array_equal(again.vibration, shaken.vibration)


def test_nodes_of_another_mesh_are_refused(coarse_blade, coarse_mesh, coarse_matrices):
    X, u = coarse_matrices.coordinates, coarse_matrices.u_static[-1]
    refused(ValueError, fields, coarse_blade, coarse_mesh.mesh, X + 1e-5, u, u, match="differ by")


def test_middle_nodes_are_amid_the_edges_that_vtk_means(box):
    """Node 4 + i; cells with straight sides, where the place is exact."""
    solid = box([3, 2, 2], [1.0, 0.4, 0.3])
    u = np.zeros(len(solid.free))
    found = on_solid(solid, u, u, "linear")
    middle = found.points[found.cells[:, EDGES]].mean(axis=2)
    np.testing.assert_allclose(found.points[found.cells[:, 4:]], middle, rtol=0, atol=1e-15)
    a, b, c, d = np.moveaxis(found.points[found.cells[:, :4]], 1, 0)
    volumes = np.einsum("ci,ci->c", np.cross(b - a, c - a), d - a) / 6
    assert volumes.min() > 0  # VTK's cells are right-handed
    assert volumes.sum() == pytest.approx(1.0 * 0.4 * 0.3, rel=1e-13)


def test_cells_are_those_of_the_mesh_file(coarse_mesh, shaken):
    """Node for node, by place, as another reader orders them."""
    mesh = meshio.read(coarse_mesh.mesh)
    cells = np.sort(sorted_cells(mesh.points, mesh.cells_dict["tetra10"]), axis=0)
    assert cells.shape == (coarse_mesh.summary.cells, 3)
    ours = np.sort(sorted_cells(shaken.points, shaken.cells), axis=0)
    np.testing.assert_allclose(ours, cells, rtol=0, atol=1e-14)


def sorted_cells(points, cells):
    """Three numbers of each cell: the distance over its edges, in any order of the corners."""
    bends = points[cells[:, 4:]] - points[cells[:, EDGES]].mean(axis=2)
    return np.stack([np.linalg.norm(bends, axis=2).max(axis=1), *points[cells].mean(1).T[:2]], 1)


def test_vtk_opens_the_file_with_all_fields(tmp_path, shaken):
    shaken.save(tmp_path / "field.vtu", {"time_rounds": 19.5})
    grid = pv.read(tmp_path / "field.vtu")
    assert set(grid.celltypes) == {pv.CellType.QUADRATIC_TETRA}
    np.testing.assert_array_equal(grid.points, shaken.points)
    for name, expected in {
        "static displacement (m)": shaken.static,
        "vibration (m)": shaken.vibration,
        "displacement (m)": shaken.static + shaken.vibration,
        "von Mises (Pa)": shaken.total.von_mises,
        "von Mises of prestress (Pa)": shaken.prestress.von_mises,
    }.items():
        np.testing.assert_array_equal(grid[name], expected, name)
    assert grid.field_data["time_rounds"] == 19.5
    assert meshio.read(tmp_path / "field.vtu").points.shape == shaken.points.shape
    xx, yy, zz, xy, yz, xz = grid["stress (Pa)"].T
    sigma = shaken.total.stress
    np.testing.assert_array_equal([xy, yz, xz], [sigma[:, 0, 1], sigma[:, 1, 2], sigma[:, 0, 2]])
    shear = 3 * (xy**2 + yz**2 + xz**2)
    squared = ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + shear
    np.testing.assert_allclose(np.sqrt(squared), grid["von Mises (Pa)"], rtol=1e-10)
    np.testing.assert_array_equal(grid["strain"][:, 3], shaken.total.strain[:, 0, 1])


def test_prestress_alone_is_the_stress_without_vibration(solid, shaken):
    static = shaken.static.ravel()[solid.free]
    still = on_solid(solid, static, 0 * static, "nonlinear")
    np.testing.assert_array_equal(still.total.stress, shaken.prestress.stress)
    assert shaken.total.von_mises.max() > 1.1 * shaken.prestress.von_mises.max()
    both = on_solid(solid, static, static, "linear")
    np.testing.assert_allclose(both.total.stress, 2 * both.prestress.stress, rtol=1e-9, atol=1.0)


def test_the_stress_away_from_clamp_and_tip_leaves_out_the_clamp(box):
    """A bar bent at its end: the largest stress is at the clamp.

    The zones may have widths of their own, as in the study of the interface: not the same at both
    ends, and not by the length.
    """
    solid = box([40, 2, 2], [1.0, 0.1, 0.1])
    points = solid.V.tabulate_dof_coordinates()
    bent = np.zeros_like(points)
    x, y, _ = points.T  # of a cantilever loaded at its end, sections stay plane
    bent[:, 0], bent[:, 1] = -y * (6 * x - 3 * x**2) / 2, x**2 * (3 - x) / 2
    found = on_solid(solid, 0 * solid.free, bent.ravel()[solid.free] * 1e-3, "linear")
    from_end, inside = np.minimum(x, 1 - x), away(solid)
    clear = abs(from_end - 0.05) > 1e-9  # nodes there are on either side, by round-off
    np.testing.assert_array_equal(inside[clear], from_end[clear] > 0.05)
    stress = found.total.von_mises
    assert x[stress.argmax()] < 0.01 and 0.05 < x[inside][stress[inside].argmax()] < 0.1
    np.testing.assert_array_equal(away(solid, 0.106, 0.206), (x > 0.106) & (x < 1 - 0.206))
