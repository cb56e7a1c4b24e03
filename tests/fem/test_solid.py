"""Mass and stiffness at rest: rigid-body motion, inertia and symmetry."""

from typing import NamedTuple

from fem.petsc import MPI  # noqa: F401  ahead of DOLFINx

import gmsh
import numpy as np
import pytest

from dolfinx import fem

from fem.prestress import linear_states, mass, nonlinear_states
from fem.solid import make_solid
from geometry.sections import loft_parameters
from geometry.shape import session
from rom.modes import ShiftInvert


def stiffness_at_rest(solid):
    return next(nonlinear_states(solid, np.array([0.0]))).K


def rigid_modes(solid, about=(0.0, 0.0, 0.0)):
    """Three translations and three rotations (n, 6)."""
    x, y, z = (solid.free_coordinates() - about).T
    o, i = np.zeros_like(x), np.ones_like(x)
    fields = [(i, o, o), (o, i, o), (o, o, i), (o, -z, y), (z, o, -x), (-y, x, o)]
    return np.column_stack([np.column_stack(field).ravel() for field in fields])


@pytest.fixture(scope="module")
def free_blade(solid):
    """The coarse blade, clamped nowhere."""
    mesh, material, V = solid.mesh, solid.material, solid.V
    return make_solid(mesh, material, V, np.empty(0, dtype=np.int32))


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


class Inertia(NamedTuple):
    mass: float  # kg
    centre: np.ndarray  # (3,), m
    central: np.ndarray  # (3, 3), kg m2, about the centre


@pytest.fixture(scope="module")
def cad(coarse_blade) -> Inertia:
    """The lofted solid by OpenCASCADE's own quadrature."""
    with session("the reference blade lofts"):
        solid = loft_parameters(coarse_blade.sections).solid
        volume = gmsh.model.occ.getMass(3, solid)
        centre = np.array(gmsh.model.occ.getCenterOfMass(3, solid))
        central = np.reshape(gmsh.model.occ.getMatrixOfInertia(3, solid), (3, 3))
    density = coarse_blade.material.density_kg_m3
    return Inertia(density * volume, centre, density * central)


def test_mass_centre_and_inertia_are_those_of_the_cad(free_blade, cad):
    """r^T M r with r the rigid motions about the CAD's centre: m I, nothing, inertia.

    On finer meshes mass, centre and inertia stay 3.8e-8, 8e-9 m and 1e-7 apart: that much is
    OpenCASCADE's quadrature. The rest is the curved cells' distance from the CAD's faces.
    """
    r = rigid_modes(free_blade, about=cad.centre)
    R = r.T @ (mass(free_blade) @ r)
    # measured on 800 cells: 1.4e-7, 8e-8 m, and 8e-6 (about x; 1e-6 about y and z)
    np.testing.assert_allclose(R[:3, :3], cad.mass * np.eye(3), rtol=3e-7, atol=1e-14)
    np.testing.assert_allclose(R[:3, 3:], 0, atol=2e-7 * cad.mass)
    radii = np.sqrt(cad.central.diagonal())
    departure = (R[3:, 3:] - cad.central) / np.outer(radii, radii)
    np.testing.assert_allclose(departure, 0, atol=2e-5)


@pytest.mark.parametrize("states", [linear_states, nonlinear_states])
def test_matrices_of_the_blade_are_symmetric_to_round_off(solid, states, monkeypatch):
    """As DOLFINx assembles them, before ``SymmetricForm`` takes the last bit away."""
    assembled, assemble = [], fem.assemble_matrix

    def kept(matrix, form):
        assembled.append(assemble(matrix, form))

    monkeypatch.setattr("dolfinx.fem.assemble_matrix", kept)
    list(states(solid, np.array([0.0, 650.0])))
    mass(solid)
    assert len(assembled) >= 3  # of two speeds or K0 and K1, and M
    for A in (matrix.to_scipy() for matrix in assembled):
        assert 0 < abs(A - A.T).max() < 1e-15 * abs(A).max()


def test_free_blade_has_six_zero_modes(free_blade):
    M, K = mass(free_blade), stiffness_at_rest(free_blade)
    # K alone is singular; any shift below the first elastic mode will do
    shift = (2 * np.pi * 100) ** 2
    values = np.sort(ShiftInvert(K + shift * M, M).modes(8).omega ** 2 - shift)
    # the solver works to 1e-10 of the shift, and K's round-off comes on top: 3e-11 was measured
    assert abs(values[:6]).max() < 1e-9 * values[6]
    assert values[6] > (2 * np.pi * 500) ** 2  # 1.01 kHz


def test_clamped_nodes_are_gone_and_only_those(solid, coarse_blade, coarse_mesh):
    x, y, _ = solid.free_coordinates().T
    everything = solid.V.tabulate_dof_coordinates()
    on_hub = np.hypot(everything[:, 0], everything[:, 1]) < coarse_blade.sections.hub_radius + 1e-8
    assert np.hypot(x, y).min() > coarse_blade.sections.hub_radius + 1e-8
    assert len(solid.free) == 3 * (coarse_mesh.summary.nodes - on_hub.sum())
