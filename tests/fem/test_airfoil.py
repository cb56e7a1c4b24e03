"""Where stress is read, its error by the mesh, and a plate with a hole through the whole of it."""

from fem.petsc import MPI

import gmsh
import numpy as np
import pytest
from boxes import make_box
from scipy.sparse.linalg import eigsh, splu

import ufl
from dolfinx import fem
from dolfinx.io.gmsh import model_to_mesh

from fem.assemble import assemble
from fem.fatigue import FIVE, von_mises
from fem.fields import airfoil, disagreement, dofs_at, linearised, thickness
from fem.solid import make_solid, read_solid, small_strain
from fem.worst_node import cycles, worst
from geometry.base import SettingsError
from geometry.blade import Material, Stress
from geometry.mesh import build_mesh
from geometry.shape import session

STILL = Material(young_modulus_GPa=200, poisson_ratio=0.0, density_kg_m3=7800)


def test_the_thickness_is_the_largest_circle_in_the_clamped_face():
    """Of a bar the smaller side; none without a clamp."""
    bar = make_box([8, 2, 3], [0.1, 0.006, 0.03])
    assert thickness(bar) == pytest.approx(0.006, rel=1e-9)
    assert thickness(make_box([2, 2, 2], [0.1, 0.1, 0.1], clamped="nowhere")) == 0.0
    assert thickness(make_box([2, 2, 2], [0.1, 0.1, 0.1], clamped="all")) == 0.0


def test_a_sharp_clamp_is_left_out_by_a_thickness_a_fillet_by_its_elements():
    """Ten elements of 10 mm along a bar 6 mm thick; the tip is left out by a twentieth of it."""
    bar = make_box([10, 2, 3], [0.1, 0.006, 0.03])
    x = bar.V.tabulate_dof_coordinates()[:, 0]
    inside, distance = airfoil(bar, Stress())
    assert (x[inside].min(), x[inside].max(), distance) == pytest.approx((0.01, 0.09, 0.006))
    inside, distance = airfoil(bar, Stress(root="fillet"))
    assert (x[inside].min(), distance) == pytest.approx((0.015, 0.0))
    for root in ("sharp", "fillet"):
        inside, distance = airfoil(bar, Stress(root=root, away_mm=22))
        assert (x[inside].min(), distance) == pytest.approx((0.025, 0.022))
    with pytest.raises(SettingsError, match=r"stress.away_mm: 200: no node of the mesh is farther"):
        airfoil(bar, Stress(away_mm=200))


def test_cells_agree_on_a_quadratic_field_and_not_on_one_pushed_node():
    box = make_box([2, 2, 1], [1.0, 0.5, 0.4], clamped="nowhere")
    X = box.free_coordinates()
    quadratic = np.stack([X[:, 0] ** 2, X[:, 0] * X[:, 1], X[:, 2] ** 2], axis=1).ravel()
    pushed = np.zeros(len(box.free))
    pushed[3 * 5 + 1] = 1e-4
    along = np.stack([quadratic, pushed])
    still, of_quadratic, of_pushed = disagreement(box, 0 * pushed, along, "linear", 5)
    largest = linearised(box, 0 * pushed, along, "linear")[1]
    assert still == 0.0
    assert of_quadratic < 1e-12 * abs(largest[1]).max()
    assert of_pushed > 0.1 * abs(largest[2]).max()


@pytest.fixture(scope="module")
def plate():
    """200 x 100 x 4 mm with a hole of 10 mm, clamped at an end."""
    with session("hole"):
        occ = gmsh.model.occ
        whole = occ.addBox(0, -0.05, 0, 0.2, 0.1, 0.004)
        hole = occ.addCylinder(0.1, 0, 0, 0, 0, 0.004, 0.005)
        occ.cut([(3, whole)], [(3, hole)])
        occ.synchronize()
        gmsh.model.addPhysicalGroup(3, [1], 1)
        near = gmsh.model.mesh.field
        near.add("MathEval", 1)
        near.setString(1, "F", "0.001+0.3*abs(sqrt((x-0.1)^2+y^2)-0.005)")
        near.setAsBackgroundMesh(1)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.012)
        gmsh.model.mesh.generate(3)
        mesh = model_to_mesh(gmsh.model, MPI.COMM_SELF, 0, gdim=3).mesh
    V = fem.functionspace(mesh, ("Lagrange", 2, (3,)))
    clamped = fem.locate_dofs_geometrical(V, lambda x: np.isclose(x[0], 0))
    return make_solid(mesh, STILL, V, clamped)


def test_a_plate_with_a_hole_has_three_times_the_gross_stress(plate):
    """Width of ten diameters: 3.03 of the gross stress, Howland 1930; nu = 0, so that no clamp."""
    S = 100e6
    u, v = ufl.TrialFunction(plate.V), ufl.TestFunction(plate.V)
    x = ufl.SpatialCoordinate(plate.mesh)
    at_end = ufl.conditional(ufl.gt(x[0], 0.2 - 1e-9), S, 0.0)
    K = plate.matrix(ufl.inner(plate.stress(small_strain(u)), small_strain(v)) * plate.dx)
    load = fem.assemble_vector(fem.form(at_end * v[0] * ufl.ds(plate.mesh)))
    stretched = splu(K.tocsc()).solve(load.array[plate.free])
    inside, _ = airfoil(plate, Stress(root="fillet"))
    nodes = np.flatnonzero(inside)
    sigma = linearised(plate, 0 * stretched, stretched[None], "linear")[1]
    swing = np.stack([np.ones(32), np.cos(2 * np.pi * np.arange(32) / 32)], axis=1)
    five = (sigma[:, nodes] @ FIVE.T).astype(np.float32)
    found, _ = worst(five, lambda few: sigma[:, nodes[few]], [swing], None)
    alternating = cycles(sigma[:, [nodes[found]]], swing)[1].item()
    at = plate.V.tabulate_dof_coordinates()[nodes[found]]
    assert alternating / S == pytest.approx(3.03, rel=0.03)
    assert np.hypot(at[0] - 0.1, at[1]) == pytest.approx(0.005, rel=0.01)
    assert abs(at[1]) > 0.0049
    off = disagreement(plate, 0 * stretched, stretched[None], "linear", nodes[found])[1]
    assert abs(alternating - 3.03 * S) < off < 0.1 * alternating


@pytest.mark.slow
def test_a_finer_mesh_changes_the_stress_by_less_than_its_error(coarse_blade, tmp_path):
    """Of rotation and of five modes, at their worst nodes; elements finer by the root of two."""
    found = [largest(coarse_blade.but(mesh__element_size_mm=size), tmp_path) for size in (5, 3.54)]
    (stress, error), (finer, _) = found
    assert np.all(abs(finer - stress) < error)
    assert np.median(error / stress) < 0.1


def largest(blade, folder):
    """Largest von Mises stress of the airfoil, of rotation and of modes, and errors by the mesh."""
    mesh = folder / f"{blade.mesh.element_size_mm}.msh"
    build_mesh(blade, mesh)
    fom, solid = assemble(blade, "mine", mesh, [0.0, 500.0]), read_solid(str(mesh), blade.material)
    _, modes = eigsh(fom.K[1], 5, fom.M, sigma=0)
    order = dofs_at(fom.coordinates, solid.free_coordinates()).ravel()
    along = np.vstack([fom.u_static[1], modes.T])[:, order]
    still, nodes = np.zeros(along.shape[1]), np.flatnonzero(airfoil(solid, blade.stress)[0])
    stress = von_mises(linearised(solid, still, along, "linear")[1][1:, nodes])
    worst = nodes[stress.argmax(axis=1)]
    errors = [
        disagreement(solid, still, along, "linear", node)[1 + k] for k, node in enumerate(worst)
    ]
    return stress.max(axis=1), np.array(errors)
