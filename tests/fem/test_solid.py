"""Mass and stiffness at rest against what a solid body must do."""

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.sparse.linalg import spsolve

import ufl
from dolfinx import fem

from fem.prestress import mass, nonlinear_states
from fem.solid import make_solid, read_solid
from geometry.blade import Material

STEEL = Material(young_modulus_GPa=210, poisson_ratio=0.3, density_kg_m3=7800)


def stiffness_at_rest(solid):
    return next(nonlinear_states(solid, np.array([0.0]))).K


def rigid_modes(solid):
    """Three translations and three rotations (n, 6)."""
    x, y, z = solid.free_coordinates().T
    o, i = np.zeros_like(x), np.ones_like(x)
    fields = [(i, o, o), (o, i, o), (o, o, i), (o, -z, y), (z, o, -x), (-y, x, o)]
    return np.column_stack([np.column_stack(field).ravel() for field in fields])


@pytest.fixture(scope="module")
def free_blade(coarse_blade, coarse_mesh):
    """The coarse blade, clamped nowhere."""
    clamped = read_solid(str(coarse_mesh.mesh), coarse_blade.material)
    return make_solid(clamped.mesh, clamped.material, clamped.V, np.empty(0, dtype=np.int32))


def test_translations_weigh_density_times_volume(free_blade, coarse_mesh):
    translations = rigid_modes(free_blade)[:, :3]
    weights = translations.T @ (mass(free_blade) @ translations)
    expected = 4430 * coarse_mesh.summary.volume * np.eye(3)  # gmsh's quadrature
    # both rules are exact for the determinant of a P2 map; their tables hold about twelve digits
    np.testing.assert_allclose(weights, expected, rtol=1e-11, atol=1e-15)


def test_rigid_motion_of_the_blade_meets_no_force(free_blade):
    """Curved ten-node cells hold a rotation exactly, so only round-off is left."""
    K, r = stiffness_at_rest(free_blade), rigid_modes(free_blade)
    scale = abs(K) @ abs(r)
    assert abs(K @ r).max(axis=0) == pytest.approx(np.zeros(6), abs=1e-12 * scale.max())


def test_free_body_has_six_zero_modes(box):
    solid = box([2, 1, 1], [1.0, 0.5, 0.4], clamped="nowhere")
    M, K = mass(solid).toarray(), stiffness_at_rest(solid).toarray()
    values = eigh(K, M, eigvals_only=True)
    # round-off is measured against the largest eigenvalue; the seventh is 1e-3 of that
    assert abs(values[:6]).max() < 1e-13 * values[-1]
    assert values[6] > 1e-5 * values[-1]


def test_clamped_nodes_are_gone_and_only_those(coarse_blade, coarse_mesh):
    solid = read_solid(str(coarse_mesh.mesh), coarse_blade.material)
    x, y, _ = solid.free_coordinates().T
    everything = solid.V.tabulate_dof_coordinates()
    on_hub = np.hypot(everything[:, 0], everything[:, 1]) < coarse_blade.sections.hub_radius + 1e-8
    assert np.hypot(x, y).min() > coarse_blade.sections.hub_radius + 1e-8
    assert len(solid.free) == 3 * (coarse_mesh.summary.nodes - on_hub.sum())


def manufactured_error(solid):
    """L2 error of a static solution whose exact field is known: u = s(x) (1, 2, -1)."""
    x = ufl.SpatialCoordinate(solid.mesh)
    s = ufl.sin(ufl.pi * x[0]) * ufl.sin(ufl.pi * (x[1] + 0.5)) * ufl.sin(ufl.pi * (x[2] + 0.5))
    exact = s * ufl.as_vector([1.0, 2.0, -1.0])
    E, nu = 210e9, 0.3  # Hooke's law with Young's modulus and Poisson's ratio, written anew
    strain = ufl.sym(ufl.grad(exact))
    stress = E / (1 + nu) * (strain + nu / (1 - 2 * nu) * ufl.tr(strain) * ufl.Identity(3))
    dx = ufl.dx(metadata={"quadrature_degree": 8})
    v = ufl.TestFunction(solid.V)
    load = fem.assemble_vector(fem.form(ufl.inner(-ufl.div(stress), v) * dx)).array
    u = fem.Function(solid.V)
    u.x.array[solid.free] = spsolve(stiffness_at_rest(solid).tocsc(), load[solid.free])
    squared = fem.assemble_scalar(fem.form(ufl.inner(u - exact, u - exact) * dx))
    return np.sqrt(squared)


def test_static_solutions_converge_at_order_three(box):
    sizes = np.array([2, 4, 6])
    errors = [manufactured_error(box([n] * 3, [1.0] * 3, STEEL, "all")) for n in sizes]
    orders = -np.diff(np.log(errors)) / np.diff(np.log(sizes))
    print("orders", orders, "errors", errors)
    assert orders[-1] > 2.8  # P2 in L2: 3 in the limit
    assert errors[-1] < 0.01 * np.sqrt(6 / 8)  # of ||u||, the square root of (1 + 4 + 1) / 2^3
