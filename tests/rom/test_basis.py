"""The basis of Eqs. (4)-(5), and that enriched by natural modes."""

import numpy as np
import pytest
from refused import refused
from scipy.linalg import eigh
from scipy.sparse import csr_matrix

from geometry.blade import EnrichedBasis
from rom.basis import Components, enriched_basis, paper_basis, project
from rom.components import at_speeds
from rom.modes import ModesError, ShiftInvert
from rom.reduce import constraint_modes, fixed_components, reduce


@pytest.fixture(scope="module")
def at_three_speeds(paper_matrices):
    return [fixed_components(K, paper_matrices.M, paper_matrices.S, 4) for K in paper_matrices.K]


@pytest.fixture(scope="module")
def at_four_speeds(coarse_matrices):
    fom = coarse_matrices
    each = at_speeds(fom, 6)
    return [Components(constraint_modes(at.A, fom.S), at.modes.Phi) for at in each]


def left_out(T, columns):
    """Largest part of ``columns`` outside the span of T, over their largest entry."""
    rest = columns - T @ np.linalg.lstsq(T, columns, rcond=None)[0]
    return abs(rest).max() / abs(columns).max()


@pytest.mark.parametrize("kind", ["coarse", "paper"])
def test_constraint_modes_are_static_with_unit_interface(kind, request):
    """K Phi_R = S^T mu, forces on the interface only; S Phi_R = I."""
    fom = request.getfixturevalue(f"{kind}_matrices")
    components = request.getfixturevalue(
        {"coarse": "at_four_speeds", "paper": "at_three_speeds"}[kind]
    )
    for K, component in zip(fom.K, components, strict=True):
        Phi_R = component.Phi_R
        np.testing.assert_allclose(fom.S @ Phi_R, np.eye(24), rtol=0, atol=1e-9)
        mu = Phi_R.T @ (K @ Phi_R)  # reactions: work of Phi_R, by virtual work
        residual = K @ Phi_R - fom.S.T @ mu
        # a direct solve leaves round-off of |K| |Phi|: measured 4e-10
        assert abs(residual).max() < 1e-8 * abs(K @ Phi_R).max()
        np.testing.assert_allclose(mu, mu.T, rtol=0, atol=1e-9 * abs(mu).max())


@pytest.mark.parametrize("kind", ["coarse", "paper"])
def test_the_interface_dofs_are_reduced_coordinates(kind, request):
    """S T = [I, 0]: one by one along the chord, radial, tangential, axial."""
    fom = request.getfixturevalue(f"{kind}_matrices")
    _, T = request.getfixturevalue(f"{kind}_reduced")
    np.testing.assert_allclose(fom.S @ T, np.eye(24, T.shape[1]), rtol=0, atol=1e-9)


@pytest.mark.parametrize(("directions", "kept"), [("r", 1), ("rt", 2)])
def test_the_interface_dofs_of_fewer_directions_are_so_too(coarse_matrices, directions, kept):
    rom, T = reduce(coarse_matrices, EnrichedBasis(), directions)
    c = coarse_matrices.S @ T
    mine = np.flatnonzero(np.arange(24) % 3 < kept)
    np.testing.assert_allclose(c[mine], np.eye(8 * kept, rom.n), rtol=0, atol=1e-9)
    assert rom.directions == ("radial", "tangential", "axial")[:kept]
    np.testing.assert_allclose(c[::3], rom.rows(rom.xi), rtol=0, atol=1e-9)


def test_fixed_interface_modes_are_modes_of_the_clamped_interface(paper_matrices, at_three_speeds):
    """S phi = 0, and K phi - omega^2 M phi are reactions on the interface."""
    fom = paper_matrices
    for K, component in zip(fom.K, at_three_speeds, strict=True):
        phi = component.X
        np.testing.assert_allclose(phi.T @ (fom.M @ phi), np.eye(4), rtol=0, atol=1e-7)
        assert abs(fom.S @ phi).max() < 1e-12 * abs(phi).max()
        squares = np.sum(phi * (K @ phi), axis=0)
        assert np.all(np.diff(squares) > 0)
        out = K @ phi - fom.M @ phi * squares
        reactions = fom.S.T @ np.linalg.lstsq(fom.S.T.toarray(), out, rcond=None)[0]
        left = np.linalg.norm(out - reactions, axis=0) / np.linalg.norm(K @ phi, axis=0)
        assert left.max() < 1e-8  # measured 4e-10


def test_points_selected_give_the_partition_of_craig_and_bampton(small):
    """S a selection: K_ii and M_ii have the modes, -K_ii^-1 K_ib the constraint modes (1968)."""
    fom = small.matrices([1.0])
    b = np.array([9, 10, 11, 3, 4, 5])
    i = np.setdiff1d(np.arange(20), b)
    K, M = small.K(1.0), small.M
    component = fixed_components(fom.K[0], fom.M, fom.S, 5)
    values, vectors = eigh(K[np.ix_(i, i)], M[np.ix_(i, i)])
    omega = np.sqrt(np.sum(component.X * (K @ component.X), axis=0))
    np.testing.assert_allclose(omega, np.sqrt(values[:5]), rtol=1e-9)
    overlap = component.X[i].T @ M[np.ix_(i, i)] @ vectors[:, :5]
    np.testing.assert_allclose(abs(overlap), np.eye(5), atol=1e-6)
    assert abs(component.X[b]).max() < 1e-12
    expected = -np.linalg.solve(K[np.ix_(i, i)], K[np.ix_(i, b)])
    np.testing.assert_allclose(component.Phi_R[i], expected, atol=1e-12)


def test_columns_of_the_paper_are_orthonormal(paper_reduced):
    _, T = paper_reduced
    Psi = T[:, 24:]
    np.testing.assert_allclose(Psi.T @ Psi, np.eye(Psi.shape[1]), atol=1e-13)  # round-off of SVD


def test_enriched_columns_are_fixed_interface_modes_at_rest(coarse_matrices, coarse_reduced):
    """Psi^T M Psi = I, Psi^T K(0) Psi = diag(omega^2); the lowest are those of the full model."""
    fom, (_, T) = coarse_matrices, coarse_reduced
    Psi = T[:, 24:]
    np.testing.assert_allclose(project(fom.M, Psi), np.eye(Psi.shape[1]), atol=1e-9)  # round-off
    stiffness = project(fom.K[0], Psi)
    squares = np.diag(stiffness)
    assert np.all(np.diff(squares) > 0)
    off = stiffness - np.diag(squares)
    assert abs(off / np.sqrt(np.outer(squares, squares))).max() < 1e-9  # round-off
    fixed = fixed_components(fom.K[0], fom.M, fom.S, 5).X
    omega = np.sqrt(np.diag(project(fom.K[0], fixed)))
    ratio = np.sqrt(squares[:5]) / omega
    assert np.all(ratio > 1 - 1e-8)  # Rayleigh-Ritz
    assert ratio.max() < 1 + 1e-4  # of twenty natural modes at each speed: measured 1e-5


def test_basis_spans_the_component_modes_of_all_three_speeds(at_three_speeds):
    """With no direction dropped, Phi_R and the fixed-interface modes of every speed lie in it."""
    T = paper_basis(at_three_speeds, 1e-12)
    for component in at_three_speeds:
        # round-off of unit columns of which the smallest singular values are 1e-6
        assert left_out(T, component.Phi_R) < 1e-10
        assert left_out(T, component.X) < 1e-10


def test_enriched_basis_spans_the_natural_modes_too(coarse_matrices, at_four_speeds):
    """Up to the rank tolerance: 1e-6 of unit energy, here over 1e-3 of the amplitude."""
    fom = coarse_matrices
    T = enriched_basis(at_four_speeds, fom.S, fom.K[0], fom.M, 1e-6)
    for component in at_four_speeds:
        for columns in (component.Phi_R, component.X):
            assert left_out(T, columns) < 1e-5


def test_directions_below_the_tolerance_are_dropped(at_three_speeds):
    """n is at most 3 eta + 3 n_c as in the paper, and smaller for a larger tolerance."""
    sizes = [paper_basis(at_three_speeds, t).shape[1] for t in (1e-12, 1e-6, 1e-2, 0.9)]
    assert sizes[0] <= 3 * 4 + 3 * 24
    assert sizes == sorted(sizes, reverse=True)
    assert sizes[-1] < sizes[1] < sizes[0]
    assert sizes[-1] > 24


def test_enriched_directions_below_the_tolerance_are_dropped(coarse_matrices, at_four_speeds):
    fom = coarse_matrices
    tolerances = (1e-6, 1e-3, 0.9)
    sizes = [enriched_basis(at_four_speeds, fom.S, fom.K[0], fom.M, t).shape[1] for t in tolerances]
    assert 24 < sizes[2] < sizes[1] < sizes[0] <= 4 * 24 + 4 * 6


def test_identical_speeds_add_nothing(coarse_matrices, at_three_speeds, at_four_speeds):
    """Starred columns vanish; columns of zero norm are left out."""
    assert paper_basis([at_three_speeds[0]] * 3, 1e-8).shape[1] == 24 + 4
    fom = coarse_matrices
    # energies of a thin blade have round-off of 1e-12: directions of 1.3e-6 of the largest
    same = enriched_basis([at_four_speeds[0]] * 3, fom.S, fom.K[0], fom.M, 1e-5)
    assert same.shape[1] == 24 + 6


def test_patches_that_the_mesh_does_not_resolve_are_refused(small):
    """Two rows of S are equal up to round-off: C is singular."""
    fom = small.matrices([0.0])
    S = fom.S.toarray()
    S[3] = S[0] * (1 + 1e-12)
    S = csr_matrix(S)
    A = ShiftInvert(fom.K[0], fom.M).solve(S.T.toarray())
    error = refused(ModesError, constraint_modes, A, S)
    assert error.key == "interface.patches"


def test_compliance_of_the_interface_is_not_singular_on_the_coarse_tip(coarse_matrices):
    """Its condition, scaled, is far from the limit of 1e8: measured 5e4."""
    fom = coarse_matrices
    C = fom.S @ ShiftInvert(fom.K[0], fom.M).solve(fom.S.T.toarray())
    scale = 1 / np.sqrt(np.diag(C))
    assert np.linalg.cond(C * np.outer(scale, scale)) < 1e6
    np.testing.assert_allclose(C, C.T, rtol=0, atol=1e-9 * abs(C).max())


def test_projection_is_symmetric_to_the_last_bit():
    rng = np.random.default_rng(2)
    A, T = rng.normal(size=(30, 30)), rng.normal(size=(30, 7))
    reduced = project(A + A.T, T)
    np.testing.assert_array_equal(reduced, reduced.T)
    np.testing.assert_allclose(reduced, T.T @ (A + A.T) @ T, rtol=1e-12, atol=1e-12)
