"""Factors of symmetric matrices against dense algebra, one matrix after the other."""

import numpy as np
import pytest
from scipy.sparse import csr_matrix, diags, identity

from fem.cholesky import Cholesky

N = 40


def banded(bands, seed):
    """A symmetric positive definite matrix with ``bands`` diagonals on either side of its own."""
    rng = np.random.default_rng(seed)
    upper = diags([rng.uniform(-1, 1, N - k) for k in range(1, bands + 1)], range(1, bands + 1))
    return csr_matrix(upper + upper.T + 2 * (bands + 1) * identity(N))


@pytest.fixture
def B():
    return np.random.default_rng(3).normal(size=(N, 3))


def test_matrices_of_one_pattern_and_of_another_are_each_solved(B):
    cholesky = Cholesky()
    assert not cholesky.made
    for A in (banded(2, 0), banded(2, 1), banded(5, 2), banded(2, 0)):
        X = cholesky.of(A).solve(B)
        np.testing.assert_allclose(X, np.linalg.solve(A.toarray(), B), rtol=0, atol=1e-14)
        assert cholesky.made and cholesky.negative == 0


@pytest.mark.parametrize("apart", [1, 2])
def test_as_many_entries_in_each_row_at_other_places_are_another_pattern(B, apart):
    def coupled(apart):
        pairs = np.arange(N).reshape(-1, 2, apart)  # of each with its partner
        A = 3 * np.eye(N)
        A[pairs[:, 0], pairs[:, 1]] = A[pairs[:, 1], pairs[:, 0]] = 1.0
        return csr_matrix(A)

    X = Cholesky().of(coupled(3 - apart)).of(coupled(apart)).solve(B)
    np.testing.assert_allclose(X, np.linalg.solve(coupled(apart).toarray(), B), atol=1e-14)


def test_one_pattern_shares_the_symbolic_factorisation(monkeypatch):
    prepared = []
    prepare = Cholesky._prepare
    monkeypatch.setattr(Cholesky, "_prepare", lambda c, A: prepared.append(A) or prepare(c, A))
    cholesky, A, other = Cholesky(), banded(2, 0), banded(5, 2)
    for matrix in (A, banded(2, 1), other):
        cholesky.of(matrix)
    assert prepared == [A, other]


def test_a_matrix_is_factorised_once(monkeypatch):
    """What has its factor already is told by being the same object."""
    cholesky, A = Cholesky(), banded(2, 0)
    cholesky.of(A)
    monkeypatch.setattr(cholesky, "_pc", None)
    assert cholesky.of(A) is cholesky


def test_a_matrix_is_not_changed_by_the_next_of_its_pattern():
    A, cholesky = banded(2, 0), Cholesky()
    cholesky.of(A).of(banded(2, 1))
    np.testing.assert_array_equal(A.toarray(), banded(2, 0).toarray())


@pytest.mark.parametrize("negative", [0, 1, 4])
def test_negative_pivots_count_negative_eigenvalues(negative):
    values = np.r_[-np.ones(negative), np.ones(N - negative)]
    assert Cholesky().of(diags(values, format="csr")).negative == negative
