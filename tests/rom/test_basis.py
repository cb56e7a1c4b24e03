"""The basis of Eqs. (4)-(5), and the one enriched by natural modes."""

import numpy as np
import pytest

from geometry.blade import EnrichedBasis
from rom.basis import (
    Split,
    components,
    enriched_basis,
    paper_basis,
    project,
)
from rom.reduce import reduce


@pytest.fixture(scope="module")
def split(coarse_matrices):
    return Split.of(coarse_matrices.M.shape[0], coarse_matrices.interface_dofs)


@pytest.fixture(scope="module")
def at_three_speeds(paper_matrices, split):
    return [components(K, paper_matrices.M, split, 4) for K in paper_matrices.K]


@pytest.fixture(scope="module")
def at_four_speeds(coarse_matrices, split):
    return [components(K, coarse_matrices.M, split, 4, 3) for K in coarse_matrices.K]


def in_full(split, at_interface, off_it):
    """Columns (n_full, m) from their interface rows and the others."""
    columns = np.zeros((len(split.b) + len(split.i), off_it.shape[1]))
    columns[split.b], columns[split.i] = at_interface, off_it
    return columns


def left_out(T, columns):
    """What T does not span of ``columns``, over their largest entry."""
    rest = columns - T @ np.linalg.lstsq(T, columns, rcond=None)[0]
    return abs(rest).max() / abs(columns).max()


def test_split_keeps_the_interface_node_by_node_and_the_rest_in_order():
    split = Split.of(9, np.array([[6, 7, 8], [0, 1, 2]]))
    np.testing.assert_array_equal(split.b, [6, 7, 8, 0, 1, 2])
    np.testing.assert_array_equal(split.i, [3, 4, 5])


def test_constraint_modes_leave_no_force_off_the_interface(coarse_matrices, split, at_four_speeds):
    for K, component in zip(coarse_matrices.K, at_four_speeds, strict=True):
        coupling = K[split.i][:, split.b].toarray()
        force = K[split.i][:, split.i] @ component.Phi_R + coupling
        # residual of a direct solve: round-off of |K| |Phi|, measured 6e-15
        assert abs(force).max() < 1e-13 * abs(coupling).max()


@pytest.mark.parametrize("reduced", ["paper_reduced", "coarse_reduced"])
def test_boundary_dofs_keep_their_meaning(coarse_matrices, reduced, request):
    """Node by node, leading edge first: radial, tangential, axial."""
    _, T = request.getfixturevalue(reduced)
    at_interface = T[coarse_matrices.interface_dofs.ravel()]
    np.testing.assert_array_equal(at_interface, np.eye(24, T.shape[1]))


@pytest.mark.parametrize(("directions", "kept"), [("r", 1), ("rt", 2)])
def test_fewer_directions_keep_their_meaning_too(coarse_matrices, directions, kept):
    rom, T = reduce(coarse_matrices, EnrichedBasis(), directions)
    interface = coarse_matrices.interface_dofs[:, :kept].ravel()
    np.testing.assert_array_equal(T[interface], np.eye(8 * kept, rom.n))
    assert rom.directions == ("radial", "tangential", "axial")[:kept]
    np.testing.assert_array_equal(T[coarse_matrices.interface_dofs[:, 0]][:, rom.radial], np.eye(8))


def test_columns_of_the_paper_off_the_interface_are_orthonormal(paper_reduced, split):
    _, T = paper_reduced
    Psi = T[split.i][:, len(split.b) :]
    np.testing.assert_allclose(Psi.T @ Psi, np.eye(Psi.shape[1]), atol=1e-13)  # round-off of SVD


def test_enriched_columns_are_fixed_interface_modes_at_rest(coarse_matrices, coarse_reduced, split):
    """Psi^T M Psi = I, Psi^T K(0) Psi = diag(omega^2); the lowest are those of the full model."""
    _, T = coarse_reduced
    Psi = T[split.i][:, len(split.b) :]
    M_ii = coarse_matrices.M[split.i][:, split.i]
    K_ii = coarse_matrices.K[0][split.i][:, split.i]
    np.testing.assert_allclose(project(M_ii, Psi), np.eye(Psi.shape[1]), atol=1e-11)  # round-off
    stiffness = project(K_ii, Psi)
    squares = np.diag(stiffness)
    assert np.all(np.diff(squares) > 0)
    off = stiffness - np.diag(squares)
    assert abs(off / np.sqrt(np.outer(squares, squares))).max() < 1e-9  # round-off
    fixed = components(coarse_matrices.K[0], coarse_matrices.M, split, 5).Phi_L
    omega = np.sqrt(np.diag(project(K_ii, fixed)))
    # nine of them at each speed are in the span but for the rank tolerance: measured 1e-5
    np.testing.assert_allclose(np.sqrt(squares[:5]), omega, rtol=1e-3)


def test_basis_spans_the_component_modes_of_all_three_speeds(at_three_speeds, split):
    """With no direction dropped, [I; Phi_R] and [0; Phi_L] of every speed lie in it."""
    T = paper_basis(at_three_speeds, split, 1e-12)
    for component in at_three_speeds:
        constraint = in_full(split, np.eye(len(split.b)), component.Phi_R)
        fixed = in_full(split, 0, component.Phi_L)
        # round-off of unit columns of which the smallest singular values are 1e-6
        assert left_out(T, constraint) < 1e-10
        assert left_out(T, fixed) < 1e-10


def test_enriched_basis_spans_the_natural_modes_too(coarse_matrices, at_four_speeds, split):
    """Up to the rank tolerance, that is: 1e-6 of unit energy, here over 1e-3 of the amplitude."""
    K, M = coarse_matrices.K[0], coarse_matrices.M
    T = enriched_basis(at_four_speeds, split, K, M, 1e-6)
    for component in at_four_speeds:
        constraint = in_full(split, np.eye(len(split.b)), component.Phi_R)
        for columns in (constraint, in_full(split, 0, component.Phi_L), component.Phi):
            assert left_out(T, columns) < 1e-5


def test_directions_below_the_tolerance_leave(at_three_speeds, split):
    """Dimension never exceeds n = 3 eta + 3 n_c of the paper, and falls with the tolerance."""
    sizes = [paper_basis(at_three_speeds, split, t).shape[1] for t in (1e-12, 1e-6, 1e-2, 0.9)]
    assert sizes[0] <= 3 * 4 + 3 * 24
    assert sizes == sorted(sizes, reverse=True)
    assert sizes[-1] < sizes[1] < sizes[0]
    assert sizes[-1] > 24


def test_enriched_directions_leave_too(coarse_matrices, at_four_speeds, split):
    K, M = coarse_matrices.K[0], coarse_matrices.M
    sizes = [enriched_basis(at_four_speeds, split, K, M, t).shape[1] for t in (1e-6, 1e-3, 0.9)]
    assert 24 < sizes[2] < sizes[1] < sizes[0] <= 4 * 24 + 4 * (4 + 3)


def test_identical_speeds_add_nothing(coarse_matrices, at_four_speeds, split):
    """Starred columns vanish, and a column of norm zero is left out, not divided by it."""
    rest = at_four_speeds[0]
    assert paper_basis([rest] * 3, split, 1e-8).shape[1] == 24 + 4
    K, M = coarse_matrices.K[0], coarse_matrices.M
    assert enriched_basis([rest] * 3, split, K, M, 1e-6).shape[1] == 24 + 4 + 3


def test_projection_is_symmetric_to_the_last_bit():
    rng = np.random.default_rng(2)
    A, T = rng.normal(size=(30, 30)), rng.normal(size=(30, 7))
    reduced = project(A + A.T, T)
    np.testing.assert_array_equal(reduced, reduced.T)
    np.testing.assert_allclose(reduced, T.T @ (A + A.T) @ T, rtol=1e-12, atol=1e-12)
