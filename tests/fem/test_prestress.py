"""Spinning bars and beams in closed form; the tangent against the energy it comes from."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_bvp
from scipy.sparse.linalg import eigsh, norm

import ufl
from dolfinx import fem

from fem.prestress import EquilibriumError, linear_states, mass, nonlinear_states
from geometry.blade import Material

E, RHO = 113.8e9, 4430.0
UNCOUPLED = Material(young_modulus_GPa=E * 1e-9, poisson_ratio=0, density_kg_m3=RHO)  # nu = 0
VARIANTS = pytest.mark.parametrize("states", [linear_states, nonlinear_states])


@pytest.fixture(scope="module")
def bar(box):
    """A slender bar of length 1 m, clamped on the axis."""
    return box([20, 1, 1], [1.0, 0.02, 0.02], UNCOUPLED)


@pytest.fixture(scope="module")
def block(box):
    """A stubby block that spins about its clamped end, with 3-D stresses."""
    return box([3, 1, 1], [1.0, 0.4, 0.3])


def test_linear_bar_stretches_as_in_closed_form(bar):
    Omega = 500.0
    (state,) = linear_states(bar, np.array([Omega]))
    x, u = bar.free_coordinates()[:, 0], state.u_static[::3]
    exact = RHO * Omega**2 / E * (x / 2 - x**3 / 6)
    # quadratic cells on a cubic, and the clamp's end effect (b/L)^3: measured 5e-6
    np.testing.assert_allclose(u, exact, rtol=0, atol=2e-5 * exact.max())


def test_nonlinear_bar_stretches_as_its_ordinary_differential_equation(bar):
    """St Venant-Kirchhoff with nu = 0: P = E (1 + u') (u' + u'^2/2), P' + rho Omega^2 (x + u) = 0.

    At this speed the root is stretched by 6 % and the linear solution is over 0.5 % off.
    """
    Omega = 1700.0
    (state,) = nonlinear_states(bar, np.array([Omega]))
    load = RHO * Omega**2 / E

    def slopes(x, y):
        u, du = y
        return np.stack([du, -load * (x + u) / (1 + 3 * du + 1.5 * du**2)])

    x = np.linspace(0, 1, 50)
    start = np.stack([load * (x / 2 - x**3 / 6), load * (1 - x**2) / 2])
    ode = solve_bvp(slopes, lambda at_0, at_L: [at_0[0], at_L[1]], x, start, tol=1e-9)
    x, u = bar.free_coordinates()[:, 0], state.u_static[::3]
    exact = ode.sol(x)[0]
    # as in the linear bar: measured 4e-6
    np.testing.assert_allclose(u, exact, rtol=0, atol=2e-5 * exact.max())
    linear = load * (x / 2 - x**3 / 6)
    assert abs(exact - linear).max() > 5e-3 * exact.max()


def spin_load(solid, position):
    """Centrifugal load per Omega^2 at ``position`` on the free DoFs."""
    form = fem.form(solid.spin_load(position, ufl.TestFunction(solid.V)))
    return fem.assemble_vector(form).array[solid.free]


def southwell():
    """d omega^2 / d Omega^2 of a clamped-free beam on the axis, bending along it: 1.193."""
    b = 1.875104068711961  # first root of cos b cosh b = -1
    ratio = (np.cosh(b) + np.cos(b)) / (np.sinh(b) + np.sin(b))

    def mode(x):
        return np.cosh(b * x) - np.cos(b * x) - ratio * (np.sinh(b * x) - np.sin(b * x))

    def slope(x):
        return b * (np.sinh(b * x) + np.sin(b * x) - ratio * (np.cosh(b * x) - np.cos(b * x)))

    work = quad(lambda x: (1 - x**2) / 2 * slope(x) ** 2, 0, 1)[0]
    return work / quad(lambda x: mode(x) ** 2, 0, 1)[0]


@VARIANTS
def test_beam_stiffens_by_the_published_coefficients(box, states):
    """Out of the plane of rotation omega^2 rises by 1.193 Omega^2, in it by 0.193 Omega^2."""
    assert southwell() == pytest.approx(1.193, abs=5e-4)  # Southwell and Gough, 1921
    beam = box([20, 1, 1], [1.0, 0.02, 0.03], UNCOUPLED)
    Omega = 20.0
    rest, spun = states(beam, np.array([0.0, Omega]))
    M = mass(beam)
    _, modes = eigsh(rest.K, 2, M, sigma=0)
    for component, expected in [(1, southwell() - 1), (2, southwell())]:  # y in plane, z out of it
        mode = modes[:, np.argmax(np.linalg.norm(modes[component::3], axis=0))]
        rise = mode @ ((spun.K - rest.K) @ mode) / Omega**2 / (mode @ (M @ mode))
        # shear, rotary inertia and the initial strain are of the order (b/L)^2 = 9e-4
        assert rise == pytest.approx(expected, abs=1e-3)


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
    print("orders", orders)
    assert orders == pytest.approx([2, 4, 4], abs=0.02)  # next terms: a strain of 1e-3


def test_residual_meets_its_tolerance_and_rest_has_no_deflection(block):
    rest, spun = nonlinear_states(block, np.array([0.0, 1000.0]))
    assert not rest.u_static.any()
    assert 0 < spun.residual <= 1e-9


FOAM = Material(young_modulus_GPa=1e-5, poisson_ratio=0.3, density_kg_m3=4430)  # 10 kPa


def test_equilibrium_that_is_not_found_names_speed_and_residual(box):
    states = nonlinear_states(box([4, 1, 1], [1.0, 0.2, 0.2], FOAM), np.array([0.0, 30.0]))
    next(states)
    message = (
        r"no static equilibrium at 30 rad/s: after \d+ Newton steps the residual is \d.*e[+-]\d+ "
        r"of the centrifugal load \(wanted 1e-09; .+\); "
        r"lower max_speed_rad_s or use prestress: linear$"
    )
    with pytest.raises(EquilibriumError, match=message):
        next(states)


def test_equilibrium_that_is_not_stable_is_refused(box):
    """Foam collapses onto the axis, where nothing pulls: an equilibrium, not a stable one."""
    states = nonlinear_states(box([3, 1, 1], [1.0, 0.4, 0.3], FOAM), np.array([0.0, 30.0]))
    next(states)
    message = r"found at 30 rad/s is not stable \(\d+ negative .* of K\); lower max_speed_rad_s$"
    with pytest.raises(EquilibriumError, match=message):
        next(states)
