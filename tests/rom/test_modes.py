"""Modes and static solutions against dense algebra; errors name the value that failed."""

import numpy as np
import pytest
from refused import refused
from scipy.linalg import eigh
from scipy.sparse import block_diag, csr_matrix, diags
from scipy.sparse.linalg import spsolve

import rom.modes
from fem.cholesky import Cholesky
from rom.modes import ModesError, ShiftInvert

BOTH = pytest.mark.parametrize("find", [ShiftInvert.modes, ShiftInvert.in_blocks])


@pytest.fixture(scope="module")
def held(coarse_matrices):
    """Stiffness and mass of the blade with eight nodes of its tip held."""
    tip = np.unique(coarse_matrices.S.nonzero()[1] // 3)[::6]
    free = np.setdiff1d(np.arange(coarse_matrices.M.shape[0]), 3 * tip[:, None] + np.arange(3))
    return tuple(A[free][:, free] for A in (coarse_matrices.K[2], coarse_matrices.M))


@BOTH
def test_modes_are_those_of_dense_algebra(small, find):
    K, M = small.K(1.0), small.M
    values, vectors = eigh(K, M)
    modes = find(ShiftInvert(csr_matrix(K), csr_matrix(M)), 20)
    # SLEPc is asked for 1e-10 of omega^2, and gives round-off for all modes of a small system
    np.testing.assert_allclose(modes.omega, np.sqrt(values), rtol=1e-10)
    np.testing.assert_allclose(abs(modes.Phi.T @ M @ vectors), np.eye(20), atol=1e-8)


@BOTH
def test_modes_of_the_blade_are_mass_orthonormal_and_diagonalise_stiffness(held, find):
    K, M = held
    modes = find(ShiftInvert(K, M), 9)
    # SLEPc orthogonalises to round-off, measured 1e-14; omega^2 comes to 1e-10, measured 2e-12
    np.testing.assert_allclose(modes.Phi.T @ (M @ modes.Phi), np.eye(9), atol=1e-12)
    Lambda = modes.Phi.T @ (K @ modes.Phi) / modes.omega[-1] ** 2
    np.testing.assert_allclose(Lambda, np.diag(modes.omega**2) / modes.omega[-1] ** 2, atol=1e-10)
    assert np.all(np.diff(modes.omega) > 0)
    assert modes.residuals.max() < 1e-7  # of SLEPc 6e-10, of blocks 2e-8


@pytest.mark.parametrize("count", [1, 10, 24])
def test_modes_in_blocks_are_those_of_slepc(held, count):
    """Also of a system that is symmetric, whose frequencies come in pairs."""
    one = ShiftInvert(*held)
    pairs = ShiftInvert(*(block_diag([A, A], format="csr") for A in held))
    omega = one.modes(count).omega
    np.testing.assert_allclose(one.in_blocks(count).omega, omega, rtol=1e-10)
    np.testing.assert_allclose(pairs.in_blocks(2 * count).omega, np.repeat(omega, 2), rtol=1e-10)


@pytest.mark.parametrize("columns", [1, 3])
@pytest.mark.parametrize("order", ["C", "F"])
def test_solve_is_that_of_scipy(held, columns, order):
    K, M = held
    B = np.asarray(np.random.default_rng(5).normal(size=(K.shape[0], columns)), order=order)
    X = ShiftInvert(K, M).solve(B)
    assert X.shape == B.shape
    expected = spsolve(K.tocsc(), B).reshape(B.shape)
    # two direct solvers part by round-off times the condition of a thin blade: measured 2e-11
    np.testing.assert_allclose(X, expected, rtol=0, atol=1e-9 * abs(expected).max())


def test_solve_and_modes_share_a_factor_in_any_order(small):
    K, M = csr_matrix(small.K(0.0)), csr_matrix(small.M)
    B = np.eye(20)[:, :2]
    one, other = ShiftInvert(K, M), ShiftInvert(K, M)
    solved, few, all_ = one.solve(B), one.modes(3).omega, one.modes(20).omega
    all_first, few_then, solved_then = other.modes(20).omega, other.modes(3).omega, other.solve(B)
    # two subspaces, each to 1e-10 of omega^2
    np.testing.assert_allclose(few, few_then, rtol=1e-10)
    np.testing.assert_allclose(all_, all_first, rtol=1e-10)
    np.testing.assert_allclose(few, all_[:3], rtol=1e-10)
    np.testing.assert_array_equal(solved, solved_then)


@pytest.mark.parametrize("negative", [1, 3])
def test_unstable_blade_is_refused_however_far_its_negative_eigenvalues(negative):
    values = np.arange(1.0, 31)
    values[-negative:] = -1e6  # shift-and-invert about 0 never sees these
    inverse = ShiftInvert(diags(values, format="csr"), diags(np.ones(30), format="csr"))
    calls = (inverse.modes, 2), (inverse.in_blocks, 2), (inverse.solve, np.ones((30, 1)))
    for call, given in calls:
        refused(ModesError, call, given, match=rf"\({negative} negative eigenvalues\)")


@BOTH
def test_stiffness_that_is_not_symmetric_leaves_a_residual(small, find):
    K = small.K(0.0)
    K[15, 2] += 5.0  # the Cholesky factor reads one triangle, the residual both
    inverse = ShiftInvert(csr_matrix(K), csr_matrix(small.M))
    refused(ModesError, find, inverse, 4, match=r"residual of \d.*, above 1e-06")


def test_residual_above_the_tolerance_is_refused(held, monkeypatch):
    monkeypatch.setattr(rom.modes, "RESIDUAL_TOLERANCE", 1e-20)
    refused(ModesError, ShiftInvert(*held).modes, 3, match="above 1e-20")


@BOTH
def test_too_many_modes_are_refused(small, find):
    inverse = ShiftInvert(csr_matrix(small.K(0.0)), csr_matrix(small.M))
    refused(ModesError, find, inverse, 25, match="20 of 25 modes")


def test_a_factor_that_is_given_is_used(small, monkeypatch):
    K, M = csr_matrix(small.K(1.0)), csr_matrix(small.M)
    expected, cholesky = ShiftInvert(K, M).modes(4).omega, Cholesky().of(K)
    monkeypatch.setattr(Cholesky, "_prepare", None)
    np.testing.assert_allclose(ShiftInvert(K, M, cholesky).modes(4).omega, expected, rtol=1e-14)
