"""The tip's radial displacement of second order: a beam's closed form, rotor 67 under tip loads."""

from dataclasses import dataclass

import numpy as np
import pytest
from boxes import make_box
from numpy.typing import NDArray
from rotor67 import coarse, mesh_at_rest

import ufl
from dolfinx import fem

from fem.assemble import over_speeds
from fem.cholesky import Cholesky
from fem.prestress import equilibrium_forms, linear_states, mass
from fem.second_order import SecondOrder
from fem.solid import Solid, SymmetricForm, read_solid
from geometry.blade import Material
from geometry.hats import mean, over_edges
from geometry.tip import EDGES
from rom.modes import ShiftInvert

LENGTH, THICKNESS = 1.0, 0.02
SLENDER = Material(young_modulus_GPa=100, poisson_ratio=0, density_kg_m3=4000)
MOVED = 2e-4  # m
BEAM = -0.581  # -1/2 of the integral of the squared slope of a beam's first mode, w^2/L


def test_a_cantilever_shortens_as_its_mode_has_slope():
    """The mean of the end, which its rotation leaves alone; without nonlinear prestress."""
    solid = make_box((40, 2, 2), (LENGTH, THICKNESS, 1.2 * THICKNESS), SLENDER)
    (state,) = linear_states(solid, [0.0])
    inverse = ShiftInvert(state.K, mass(solid))
    mode = inverse.modes(1).Phi[:, 0]
    ends = np.unique(solid.tip)
    mean = np.zeros((3, 3 * len(solid.V.tabulate_dof_coordinates())))
    for c in range(3):
        mean[c, 3 * ends + c] = 1 / len(ends)
    u, v, w = mean[:, solid.free] @ mode
    assert abs(u) < 1e-6 * np.hypot(v, w)
    x = inverse.solve(mean[:1, solid.free].T)[:, 0]
    found = SecondOrder(solid, "linear").along(state.u_static, x, mode)
    assert found * LENGTH / (v**2 + w**2) == pytest.approx(BEAM, rel=0.01)


@dataclass
class Rest:
    """Rotor 67 at rest: the rows of its tip, its matrices, its equilibria under loads."""

    solid: Solid
    R: NDArray[np.float64]  # (3, 2, n), u_r, u_t, u_z at both edges
    M: NDArray[np.float64]
    K: NDArray[np.float64]
    cholesky: Cholesky

    def under(self, load):
        """Displacements (n,) of the nonlinear equilibrium under a ``load`` (n,), N, by Newton."""
        v, du = ufl.TestFunction(self.solid.V), ufl.TrialFunction(self.solid.V)
        u, free = fem.Function(self.solid.V), self.solid.free
        Omega = fem.Constant(self.solid.mesh, 0.0)
        residual, tangent = equilibrium_forms(self.solid, Omega, u, v, du)
        form, K = fem.form(residual), SymmetricForm(tangent, free)
        for _ in range(20):
            r = fem.assemble_vector(form).array[free] - load
            if np.linalg.norm(r) < 1e-10 * np.linalg.norm(load):
                return u.x.array[free].copy()
            u.x.array[free] -= Cholesky().of(K.matrix()).solve(r[:, None])[:, 0]
        pytest.fail("no equilibrium")


@pytest.fixture(scope="module")
def rest(tmp_path_factory):
    blade, cholesky = coarse(), Cholesky()
    mesh = mesh_at_rest(blade, str(tmp_path_factory.mktemp("rotor67")))
    solid = read_solid(str(mesh), blade.material)
    fom, states = over_speeds(blade, "rotor67", mesh, [0.0], cholesky, solid)
    P = over_edges(EDGES, fom.xi, mean(fom.across))
    R = np.stack([P @ fom.rows(letter).toarray() for letter in "rtz"])
    return Rest(solid, R, fom.M, next(states).K, cholesky)


@pytest.mark.nightly
@pytest.mark.parametrize("edge", [0, 1])
def test_it_is_that_of_the_equilibrium_of_rotor_67_under_a_tip_load(rest, edge):
    """At both edges: the part of the displacement that is even in the load, without the first mode.

    The tangential load moves its edge by ``MOVED``: a thin edge bends further by terms of fourth
    order, 16 % of it at 0.5 mm.
    """
    inverse = ShiftInvert(rest.K, rest.M, rest.cholesky)
    modes, row = inverse.modes(1), rest.R[1, edge]
    mode, omega = modes.Phi[:, 0], modes.omega[0]
    load = row * MOVED / (row @ inverse.solve(row[:, None])[:, 0])
    plus, minus = rest.under(load), rest.under(-load)
    odd, even = (plus - minus) / 2, (plus + minus) / 2
    without = even - mode * (mode @ (rest.M @ even))
    along = SecondOrder(rest.solid, "nonlinear").along
    for radial in rest.R[0]:
        x = inverse.solve(radial[:, None])[:, 0] - mode * (radial @ mode) / omega**2
        assert along(0 * mode, x, odd) == pytest.approx(radial @ without, rel=0.05)
