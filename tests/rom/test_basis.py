"""The basis of Eqs. (4)-(5)."""

import numpy as np
import pytest

from rom.basis import Split, components, load_basis, multi_speed_basis, save_basis


@pytest.fixture(scope="module")
def split(coarse_matrices):
    return Split.of(coarse_matrices.M.shape[0], coarse_matrices.interface_dofs)


def test_split_keeps_the_interface_node_by_node_and_the_rest_in_order():
    split = Split.of(9, np.array([[6, 7, 8], [0, 1, 2]]))
    np.testing.assert_array_equal(split.b, [6, 7, 8, 0, 1, 2])
    np.testing.assert_array_equal(split.i, [3, 4, 5])


def test_constraint_modes_leave_no_force_off_the_interface(coarse_matrices, split):
    for K in coarse_matrices.K:
        Phi_R = components(K, coarse_matrices.M, split, 1).Phi_R
        coupling = K[split.i][:, split.b].toarray()
        force = K[split.i][:, split.i] @ Phi_R + coupling
        # residual of a direct solve: round-off of |K| |Phi|, measured 6e-15
        assert abs(force).max() < 1e-13 * abs(coupling).max()


def test_boundary_dofs_keep_their_meaning(coarse_matrices, coarse_reduced):
    """Node by node, leading edge first: radial, tangential, axial."""
    _, T = coarse_reduced
    at_interface = T[coarse_matrices.interface_dofs.ravel()]
    np.testing.assert_array_equal(at_interface, np.eye(24, T.shape[1]))


def test_columns_off_the_interface_are_orthonormal(coarse_reduced, split):
    _, T = coarse_reduced
    Psi = T[split.i][:, len(split.b) :]
    np.testing.assert_allclose(Psi.T @ Psi, np.eye(Psi.shape[1]), atol=1e-13)  # round-off of SVD


def test_basis_spans_the_component_modes_of_all_three_speeds(coarse_matrices, split):
    """With no direction dropped, [I; Phi_R] and [0; Phi_L] of every speed lie in it."""
    M, n_b = coarse_matrices.M, len(split.b)
    at_speeds = [components(K, M, split, 4) for K in coarse_matrices.K]
    T = multi_speed_basis(at_speeds, split, 1e-12)
    for component in at_speeds:
        constraint = np.zeros((len(T), n_b))
        constraint[split.b, np.arange(n_b)], constraint[split.i] = 1, component.Phi_R
        fixed = np.zeros((len(T), 4))
        fixed[split.i] = component.Phi_L / np.linalg.norm(component.Phi_L, axis=0)
        for columns in (constraint, fixed):
            rest = columns - T @ np.linalg.lstsq(T, columns, rcond=None)[0]
            # round-off of unit columns of which the smallest singular values are 1e-6
            assert abs(rest).max() < 1e-10


def test_directions_below_the_tolerance_leave(coarse_matrices, split):
    """Dimension never exceeds n = 3 eta + 3 n_c of the paper, and falls with the tolerance."""
    at_speeds = [components(K, coarse_matrices.M, split, 4) for K in coarse_matrices.K]
    sizes = [multi_speed_basis(at_speeds, split, t).shape[1] for t in (1e-12, 1e-6, 1e-2, 0.9)]
    assert sizes[0] <= 3 * 4 + 3 * 24
    assert sizes == sorted(sizes, reverse=True)
    assert sizes[-1] < sizes[1] < sizes[0]
    assert sizes[-1] > 24


def test_identical_speeds_add_nothing(coarse_matrices, split):
    """Starred columns vanish, and a column of norm zero is left out, not divided by it."""
    rest = components(coarse_matrices.K[0], coarse_matrices.M, split, 4)
    assert multi_speed_basis([rest] * 3, split, 1e-8).shape[1] == 24 + 4


def test_basis_file_reads_back_bit_for_bit(tmp_path):
    T = np.random.default_rng(3).normal(size=(7, 4))
    save_basis(T, tmp_path / "basis.h5")
    np.testing.assert_array_equal(load_basis(tmp_path / "basis.h5"), T)
