"""Strain and stress in closed form, and those of the reduced model against the full one."""

import numpy as np
import pytest
from scipy.sparse.linalg import splu
from scipy.spatial.transform import Rotation

from fem.fields import TENSOR, linearised, stress
from fem.prestress import linear_states
from geometry.blade import Material
from rom.reconstruct import Basis
from rom.reduce import reduce

E, NU = 113.8e9, 0.342
TURN = Rotation.from_rotvec([0.3, -0.5, 0.9]).as_matrix()  # 61 deg


@pytest.fixture(scope="module")
def free_box(box):
    return box([2, 2, 1], [1.0, 0.5, 0.4], clamped="nowhere")


def displaced(solid, motion):
    """Displacements that take the nodes X (nodes, 3) to ``motion(X)``."""
    X = solid.free_coordinates()
    return (motion(X) - X).ravel()


def everywhere(tensor, nodes):
    return np.broadcast_to(tensor, (nodes, 3, 3))


@pytest.mark.parametrize("turn", [np.eye(3), TURN])
def test_uniaxial_stretch_by_a_tenth(free_box, turn):
    """Sides free: E_yy = -nu E_xx, S_xx = E E_xx; sigma = F S F^T / det F turns with the body."""
    E_xx = (1.1**2 - 1) / 2
    a, b = 1.1, np.sqrt(1 - 2 * NU * E_xx)
    u = displaced(free_box, lambda X: X * [a, b, b] @ turn.T)
    found = stress(free_box, u, "nonlinear")
    nodes = len(u) // 3
    strain = everywhere(E_xx * np.diag([1, -NU, -NU]), nodes)
    sigma = a**2 * E * E_xx / (a * b * b)
    # round-off of strains of 1: 1e-15 times the modulus
    np.testing.assert_allclose(found.strain, strain, atol=1e-13)
    turned = everywhere(turn @ np.diag([sigma, 0, 0]) @ turn.T, nodes)
    np.testing.assert_allclose(found.stress, turned, rtol=0, atol=1e-12 * E)
    np.testing.assert_allclose(found.von_mises, sigma, rtol=1e-11)


def test_small_stretch_is_hooke(free_box):
    """`linear`: sigma = E eps, whatever the size."""
    eps = 0.1
    u = displaced(free_box, lambda X: X * (1 + eps * np.array([1, -NU, -NU])))
    found = stress(free_box, u, "linear")
    np.testing.assert_allclose(found.von_mises, E * eps, rtol=1e-12)
    np.testing.assert_allclose(found.strain[:, 0, 0], eps, rtol=1e-12)


def test_turning_the_body_stresses_it_only_if_linear(free_box):
    u = displaced(free_box, lambda X: X @ TURN.T)
    nonlinear, linear = (stress(free_box, u, kind).von_mises for kind in ("nonlinear", "linear"))
    assert nonlinear.max() < 1e-13 * E  # round-off of strains of 1
    assert linear.max() > 0.1 * E


def test_every_node_has_its_own_strain(free_box):
    """A quadratic field is held exactly: all cells at a node agree."""
    u = displaced(free_box, lambda X: X + 1e-3 * np.stack([X[:, 0] ** 2, X[:, 0] * X[:, 1]], 1) @ P)
    found = stress(free_box, u, "linear")
    x, y, _ = free_box.V.tabulate_dof_coordinates().T
    strain = np.zeros((len(x), 3, 3))
    strain[:, 0, 0], strain[:, 1, 1] = 2e-3 * x, 1e-3 * x
    strain[:, 0, 1] = strain[:, 1, 0] = 0.5e-3 * y
    np.testing.assert_allclose(found.strain, strain, rtol=0, atol=1e-14)  # round-off of positions


P = np.array([[1.0, 0, 0], [0, 1.0, 0]])  # puts two components into three


def test_a_node_averages_its_cells(free_box):
    """One node pushed: its cells differ. The mean, from each cell's own gradient written anew."""
    u = np.zeros(len(free_box.free))
    u[3 * 5 + 1] = 1e-4
    found = stress(free_box, u, "linear")
    X, cells = free_box.V.tabulate_dof_coordinates(), free_box.V.dofmap.list
    values = [[] for _ in X]
    for cell in cells:
        # quadratic in x, y, z through the cell's ten nodes
        field = np.linalg.solve(monomials(X[cell]), u.reshape(-1, 3)[cell])
        for node in cell:
            grad = slopes(X[node]) @ field
            values[node].append((grad + grad.T) / 2)
    expected = np.array([np.mean(v, axis=0) for v in values])
    np.testing.assert_allclose(found.strain, expected, rtol=0, atol=1e-15)


def monomials(X):
    x, y, z = X.T
    one = np.ones_like(x)
    return np.stack([one, x, y, z, x * x, y * y, z * z, x * y, y * z, x * z], axis=1)


def slopes(X):
    """Gradient (3, 10) of the monomials at one point."""
    x, y, z = X
    return np.array(
        [
            [0, 1, 0, 0, 2 * x, 0, 0, y, 0, z],
            [0, 0, 1, 0, 0, 2 * y, 0, x, z, 0],
            [0, 0, 0, 1, 0, 0, 2 * z, 0, y, x],
        ]
    )


def test_spinning_bar_carries_what_is_outside(box):
    """rho Omega^2 (L^2 - r^2)/2; a quadratic displacement in place of a cubic: order 2 in h."""
    uncoupled = Material(young_modulus_GPa=113.8, poisson_ratio=0, density_kg_m3=4430)
    Omega, errors = 500.0, []
    for cells in (10, 20):
        bar = box([cells, 1, 1], [1.0, 0.02, 0.02], uncoupled)
        (state,) = linear_states(bar, np.array([Omega]))
        exact = 4430 * Omega**2 * (1 - bar.V.tabulate_dof_coordinates()[:, 0] ** 2) / 2
        found = stress(bar, state.u_static, "linear").von_mises
        errors.append(abs(found - exact).max() / exact.max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.3)  # measured 1.80
    assert errors[1] < 8e-4  # measured 5.5e-4


@pytest.mark.parametrize(("directions", "load"), [("r", 0), ("rtz", 0), ("rtz", 1)])
def test_reduced_model_gives_the_full_models_stress_under_a_tip_load(
    coarse_blade, solid, coarse_matrices, coarse_reduced, directions, load
):
    """100 N, radial or tangential, on the first patch at Omega_m, prestress included.

    Constraint modes answer interface loads but for the directions below `basis.rank_tolerance`,
    an error that tests/rom/test_reduce.py bounds in energy norm, which is the norm of stress, and
    of its square in the displacement at the load. Measured, displacement over its largest and von
    Mises over its largest: 2.2e-5 and 2.7e-4, 1.7e-5 and 3.4e-4, 8e-6 and 6.9e-4.
    """
    rtz = directions == "rtz"
    rom, T = coarse_reduced if rtz else reduce(coarse_matrices, coarse_blade.basis, directions)
    basis = Basis.of(coarse_matrices, T, rom.provenance)
    Omega, K = coarse_matrices.speeds[-1], coarse_matrices.K[-1]
    f = 100.0 * coarse_matrices.S[[load]].toarray()[0]  # on the first patch
    full = splu(K.tocsc()).solve(f)
    reduced = basis.reconstruct(np.linalg.solve(rom.stiffness(Omega), T.T @ f))
    static = basis.static(Omega)
    pairs = [
        [stress(solid, start + u, prestress).von_mises for u in (full, reduced)]
        for start, prestress in ((0, "linear"), (static, "nonlinear"))
    ]
    np.testing.assert_allclose(reduced, full, rtol=0, atol=6e-5 * abs(full).max())
    for of_full, of_reduced in pairs:
        assert abs(of_reduced - of_full).max() < 1.5e-3 * pairs[0][0].max()


@pytest.mark.parametrize("kind", ["nonlinear", "linear"])
def test_what_is_linearised_has_its_values_and_their_derivatives(free_box, kind):
    """Central differences about a large deflection: of second order in the step."""
    rng = np.random.default_rng(3)
    u, v = (1e-2 * rng.standard_normal(len(free_box.free)) for _ in range(2))
    found, own = linearised(free_box, u, np.array([v, -2 * v]), kind), stress(free_box, u, kind)

    def error(h):
        ends = [stress(free_box, u + sign * h * v, kind) for sign in (1, -1)]
        of = [(getattr(ends[0], n) - getattr(ends[1], n)) / (2 * h) for n in ("strain", "stress")]
        pairs = zip(found, of, strict=True)
        return [abs(a[1] - b[:, *TENSOR]).max() / abs(a[1]).max() for a, b in pairs]

    for coarse, fine in zip(error(1e-2), error(1e-3), strict=True):
        assert fine < max(0.011 * coarse, 1e-11)
    for of, value in zip(found, (own.strain, own.stress), strict=True):
        np.testing.assert_allclose(of[0], value[:, *TENSOR], atol=1e-14 * abs(value).max())
        np.testing.assert_allclose(of[2], -2 * of[1], atol=1e-12 * abs(of[1]).max())
