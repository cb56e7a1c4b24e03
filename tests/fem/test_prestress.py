"""Equilibrium and tangent against energy and residual; one prestress variant against the other."""

import re

import numpy as np
import pytest
from refused import refused
from scipy.sparse.linalg import norm

import ufl
from dolfinx import fem

from fem import prestress
from fem.cholesky import Cholesky
from fem.prestress import EquilibriumError, equilibrium_forms, linear_states, mass, nonlinear_states
from geometry.base import RPM
from geometry.blade import Material
from rom.modes import ShiftInvert


@pytest.fixture(scope="module")
def block(box):
    """A stubby block that spins about its clamped end, with 3-D stresses."""
    return box([3, 1, 1], [1.0, 0.4, 0.3])


def spin_load(solid, position):
    """Centrifugal load per Omega^2 at ``position`` on the free DoFs."""
    form = fem.form(solid.spin_load(position, ufl.TestFunction(solid.V)))
    return fem.assemble_vector(form).array[solid.free]


def energy(solid, Omega, u):
    """Strain energy of Eq. (b) less the work of the centrifugal force, J, written anew."""
    lambda_, mu = solid.lame()
    F = ufl.Identity(3) + ufl.grad(u)
    strain = (F.T * F - ufl.Identity(3)) / 2
    x = ufl.SpatialCoordinate(solid.mesh) + u
    density = solid.material.density_kg_m3
    elastic = lambda_ / 2 * ufl.tr(strain) ** 2 + mu * ufl.inner(strain, strain)
    spin = density * Omega**2 / 2 * (x[0] ** 2 + x[1] ** 2)
    return fem.form((elastic - spin) * ufl.dx(metadata={"quadrature_degree": 4}))


@pytest.fixture(scope="module")
def spun_block(block):
    """The block at 10 % strain, and the energy at displacements of its free DoFs."""
    Omega = 2500.0
    (state,) = nonlinear_states(block, np.array([Omega]))
    u = fem.Function(block.V)
    form = energy(block, fem.Constant(block.mesh, Omega), u)

    def at(free):
        u.x.array[block.free] = free
        return fem.assemble_scalar(form)

    return state, at


DIRECTIONS = pytest.mark.parametrize("seed", range(4))


def along(spun_block, seed):
    """A random direction and the energy's derivatives along it at the equilibrium.

    The energy is a quartic polynomial, for which five-point differences are exact.
    """
    state, at = spun_block
    d = np.random.default_rng(seed).uniform(-1, 1, len(state.u_static))
    h = 0.02
    values = np.array([at(state.u_static + t * h * d) for t in (-2, -1, 0, 1, 2)])
    first = np.array([1, -8, 0, 8, -1]) @ values / (12 * h)
    second = np.array([-1, 16, -30, 16, -1]) @ values / (12 * h**2)
    return d, first, second


@DIRECTIONS
def test_tangent_is_the_second_derivative_of_the_energy(spun_block, seed):
    d, _, second = along(spun_block, seed)
    # round-off of the difference: the energies are of the order of second h^2; measured 2e-15
    assert d @ (spun_block[0].K @ d) == pytest.approx(second, rel=1e-13)


@DIRECTIONS
def test_tangent_is_the_derivative_of_the_residual(block, spun_block, seed):
    """Row by row; five-point differences are exact for the residual, a cubic polynomial."""
    state, _ = spun_block
    u, v = fem.Function(block.V), ufl.TestFunction(block.V)
    Omega = fem.Constant(block.mesh, state.speed)
    residual, _ = equilibrium_forms(block, Omega, u, v, ufl.TrialFunction(block.V))
    form = fem.form(residual)
    d = np.random.default_rng(seed).uniform(-1, 1, len(state.u_static))
    h = 0.02

    def at(t):
        u.x.array[block.free] = state.u_static + t * h * d
        return fem.assemble_vector(form).array[block.free]

    slope = (at(-2) - 8 * at(-1) + 8 * at(1) - at(2)) / (12 * h)
    # round-off of the residuals, whose terms are the stiffness times h d; measured 6e-16
    np.testing.assert_allclose(state.K @ d, slope, rtol=0, atol=1e-13 * abs(slope).max())


@DIRECTIONS
def test_energy_is_stationary_at_the_equilibrium(block, spun_block, seed):
    d, first, _ = along(spun_block, seed)
    load = spin_load(block, ufl.SpatialCoordinate(block.mesh)) * spun_block[0].speed ** 2
    # Newton stops below 1e-9 of this load; as much again for round-off of the difference
    assert abs(first) < 2e-9 * np.linalg.norm(load) * np.linalg.norm(d)


def test_tangent_follows_the_equilibrium_from_speed_to_speed(block):
    """K(Omega) du/d(Omega^2) = rho P (X + u): finite differences of the static path itself."""
    Omega, step = 1500.0, 1.0
    before, state, after = nonlinear_states(block, Omega + np.array([-step, 0, step]))
    slope = (after.u_static - before.u_static) / (after.speed**2 - before.speed**2)
    position = ufl.SpatialCoordinate(block.mesh) + block.field(state.u_static)
    load = spin_load(block, position)
    # central difference: (step/Omega)^2 = 4e-7, times coefficients of order one
    np.testing.assert_allclose(state.K @ slope, load, rtol=0, atol=1e-6 * abs(load).max())


def test_linear_stiffness_is_linear_in_the_square_of_the_speed(block):
    rest, half, full = linear_states(block, np.array([0.0, 1000, 2000]))
    second = full.K - 4 * half.K + 3 * rest.K  # Eq. (3), in units of 3/4 Omega_m^4
    assert abs(second).max() < 1e-15 * 8 * abs(full.K).max()  # round-off of the sum
    np.testing.assert_allclose(full.u_static, 4 * half.u_static, rtol=1e-15)


def initial_displacement_stiffness(solid, u1):
    """K_u: what `linear` leaves out, strain that the deflection u1 adds to Eq. (c)."""
    v, du = ufl.TestFunction(solid.V), ufl.TrialFunction(solid.V)
    u1 = solid.field(u1)

    def strain(w):
        return ufl.sym(ufl.grad(w))

    def coupled(w):
        return ufl.sym(ufl.grad(u1).T * ufl.grad(w))

    return solid.matrix(
        (
            ufl.inner(solid.stress(strain(du)), coupled(v))
            + ufl.inner(solid.stress(coupled(du)), strain(v))
        )
        * solid.dx
    )


def test_nonlinear_tends_to_linear_at_low_speed(block):
    """Departures of K: order 2 in Omega, and order 4 with K_u, which `linear` leaves out, put back.

    Departures of u_static: order 4, that is 2 relative to u_static itself.
    """
    speeds = np.array([200.0, 400.0])  # strains of 1e-4 to 1e-3
    pairs = zip(linear_states(block, speeds), nonlinear_states(block, speeds), strict=True)
    K_departure, K_rest, u_departure = [], [], []
    for linear, nonlinear in pairs:
        K_u = initial_displacement_stiffness(block, linear.u_static)
        difference = nonlinear.K - linear.K
        K_departure.append(norm(difference))
        K_rest.append(norm(difference - K_u))
        u_departure.append(np.linalg.norm(nonlinear.u_static - linear.u_static))
    orders = [np.log2(b / a) for a, b in (K_departure, K_rest, u_departure)]
    assert orders == pytest.approx([2, 4, 4], abs=0.02)  # next terms: a strain of 1e-3


MODES = 7  # as the paper compares


def test_variants_side_by_side_on_the_blade(coarse_blade, solid):
    """Equal at rest; at Omega_m apart by what the deflection adds to the strain, phi^T K_u phi."""
    M, speeds = mass(solid), np.array([0.0, coarse_blade.top_speed])
    linear, nonlinear = (
        [(state, ShiftInvert(state.K, M).modes(MODES)) for state in states(solid, speeds)]
        for states in (linear_states, nonlinear_states)
    )
    frequencies = [[modes.omega for _, modes in variant] for variant in (linear, nonlinear)]
    at_rest, at_speed = np.moveaxis(frequencies, 1, 0)
    departure = at_speed[1] / at_speed[0] - 1
    state, modes = linear[1]
    K_u = initial_displacement_stiffness(solid, state.u_static)
    expected = np.einsum("im,im->m", modes.Phi, K_u @ modes.Phi) / (2 * modes.omega**2)
    # one stiffness at rest; SLEPc is asked for 1e-10
    np.testing.assert_allclose(at_rest[1], at_rest[0], rtol=1e-9)
    # to 0.6 % and of either sign; what is left is of second order in the deflection: measured 6e-4
    assert abs(departure).max() > 5e-3
    np.testing.assert_allclose(departure, expected, rtol=0, atol=8e-4)
    np.testing.assert_array_equal(np.sign(departure), np.sign(expected))


def test_slender_bodies_at_low_speed_reach_their_equilibrium(box):
    """At strains of 1e-8, where (F^T F - I)/2 formed from F would leave 7e-7 of the load."""
    beam = box([20, 1, 1], [1.0, 0.01, 0.01])
    (state,) = nonlinear_states(beam, np.array([1.0]))
    assert state.residual <= 1e-9


def test_residual_meets_its_tolerance_and_rest_has_no_deflection(block):
    rest, spun = nonlinear_states(block, np.array([0.0, 1000.0]))
    assert not rest.u_static.any()
    assert 0 < spun.residual <= 1e-9


# 10 kPa; unchecked, since no blade is so soft
FOAM = Material.model_construct(young_modulus_GPa=1e-5, poisson_ratio=0.3, density_kg_m3=4430)


def test_equilibrium_that_is_not_found_names_speeds_and_residual(box):
    """The speed reached is near the one refused, not the last that was asked for."""
    speeds = np.array([0.0, 0.5, 1000.0])
    states = nonlinear_states(box([4, 1, 1], [1.0, 0.2, 0.2], FOAM), speeds)
    next(states), next(states)
    message = (
        r"no static equilibrium at (\S+) rpm \(the last at (\S+) rpm\): after \d+ Newton steps "
        r"the residual is \d.*e[+-]\d+ of the centrifugal load \(wanted 1e-09; .+\); "
        r"lower the highest speed or use prestress: linear$"
    )
    error = refused(EquilibriumError, next, states, match=message)
    at, last = map(float, re.match(message, str(error)).groups())
    assert 0.5 * RPM < last < at <= last + 0.05 * 1000 * RPM


@pytest.fixture
def foam(box):
    return box([3, 1, 1], [1.0, 0.4, 0.3], FOAM)


def test_speeds_between_reach_what_one_step_does_not(foam):
    (stepped,) = nonlinear_states(foam, np.array([30.0]))
    assert stepped.residual <= 1e-9
    assert np.linalg.eigvalsh(stepped.K.toarray())[0] > 0
    # by way of twenty speeds of one's own: the same equilibrium
    *_, slowly = nonlinear_states(foam, np.linspace(1.5, 30, 20))
    scale = abs(slowly.u_static).max()
    np.testing.assert_allclose(stepped.u_static, slowly.u_static, rtol=0, atol=1e-6 * scale)


def test_equilibrium_that_is_not_stable_is_refused(foam, monkeypatch):
    """In one step foam collapses onto the axis, where nothing pulls: stationary, not stable."""
    monkeypatch.setattr(prestress, "SMALLEST_STEP", 1.0)
    states = nonlinear_states(foam, np.array([30.0]))
    refused(EquilibriumError, next, states, match="at 286.479 rpm is not stable .* at 0 rpm")


def test_with_a_factor_the_states_are_the_same_without_newton(block, monkeypatch):
    """Modified Newton finds all equilibria, each with the factor of the last K."""
    speeds, cholesky = np.linspace(0, 1000, 6), Cholesky()
    plain = list(nonlinear_states(block, speeds))
    monkeypatch.setattr(prestress, "_solve", None)
    b = np.random.default_rng(2).normal(size=(len(plain[0].u_static), 1))
    for one, other in zip(plain, nonlinear_states(block, speeds, cholesky), strict=True):
        assert other.speed == one.speed and other.residual <= 1e-11
        # both residuals are below 1e-9 of the load: measured 6e-11
        scale = abs(plain[-1].u_static).max()
        np.testing.assert_allclose(other.u_static, one.u_static, rtol=0, atol=1e-9 * scale)
        assert abs(other.K - one.K).max() < 1e-9 * abs(one.K).max()
        x = cholesky.solve(b)
        np.testing.assert_allclose(other.K @ x, b, rtol=0, atol=1e-9)


def test_where_modified_newton_does_not_converge_newton_does(foam, monkeypatch):
    """Also by speeds between, from the last of which modified Newton converges."""
    found = []
    solve = prestress._solve
    monkeypatch.setattr(prestress, "_solve", lambda *a: found.append(a[1]) or solve(*a))
    (stepped,) = nonlinear_states(foam, np.array([30.0]))
    alone = found.copy()
    found.clear()
    modified, iterate = [], prestress._Equilibria._modified_newton

    def spy(path, cholesky, load):
        modified.append(float(path.Omega.value))
        return iterate(path, cholesky, load)

    monkeypatch.setattr(prestress._Equilibria, "_modified_newton", spy)
    _, after_rest = nonlinear_states(foam, np.array([0.0, 30.0]), Cholesky())
    assert [*found, 30.0] == alone and len(found) > 1  # from the same start, to the same speeds
    assert set(modified) == {30.0}  # between, no K would tell whether it is stable
    scale = abs(stepped.u_static).max()
    np.testing.assert_allclose(after_rest.u_static, stepped.u_static, rtol=0, atol=1e-8 * scale)


def test_an_equilibrium_whose_own_stiffness_is_indefinite_is_refused(block):
    class Indefinite(Cholesky):
        negative = 2

    states = nonlinear_states(block, np.array([900.0]), Indefinite())
    refused(EquilibriumError, next, states, match=r"at 8594.37 rpm .* \(2 negative .* at 0 rpm")
