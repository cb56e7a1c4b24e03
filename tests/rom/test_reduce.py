"""Full model against reduced model: what the basis makes exact, and what it bounds."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.sparse.linalg import splu

from fem.assemble import assemble
from rom.modes import ModesError, ShiftInvert
from rom.reduce import project, reduce
from rom.speeds import basis_speeds

ALL = 1e-12  # rank tolerance that drops round-off only


@pytest.fixture(scope="module")
def full_frequencies(coarse_matrices):
    """Of ten modes at the three speeds of the basis (3, 10), rad/s."""
    return np.array([ShiftInvert(K, coarse_matrices.M).modes(10).omega for K in coarse_matrices.K])


@pytest.fixture(scope="module")
def static(coarse_matrices):
    """Displacement fields under each unit interface load, per speed: (K, U (n_full, 24))."""
    b = coarse_matrices.interface_dofs.ravel()
    F = np.zeros((coarse_matrices.M.shape[0], len(b)))
    F[b, np.arange(len(b))] = 1
    return F, [(K, splu(K.tocsc()).solve(F)) for K in coarse_matrices.K]


def frequencies(rom, speeds):
    return np.array([rom.modes(speed)[0][:10] for speed in speeds])


def test_stiffness_is_the_projected_one_at_the_three_speeds(coarse_matrices, coarse_reduced):
    rom, T = coarse_reduced
    for speed, K in zip(coarse_matrices.speeds, coarse_matrices.K, strict=True):
        expected = T.T @ (K @ T)
        # round-off of the interpolation, coefficients up to 16
        np.testing.assert_allclose(rom.stiffness(speed), expected, atol=1e-12 * abs(expected).max())
    np.testing.assert_allclose(rom.M, T.T @ (coarse_matrices.M @ T), rtol=0, atol=1e-15)


def test_matrices_are_symmetric_to_the_last_bit(coarse_rom):
    for A in (coarse_rom.M, *coarse_rom.K):
        np.testing.assert_array_equal(A, A.T)


def test_model_says_what_it_is_of(coarse_blade, coarse_matrices, coarse_rom):
    assert coarse_rom.Omega_m == 650
    assert coarse_rom.span == pytest.approx(coarse_blade.sections.span, abs=1e-8)  # ON_CYLINDER
    assert coarse_rom.provenance == (
        f"mesh {coarse_matrices.mesh_hash}; eta 9; rank tolerance 0.0001"
    )
    np.testing.assert_array_equal(coarse_rom.points, coarse_matrices.interface_points)
    assert 2 * np.pi * coarse_rom.f1 == pytest.approx(coarse_rom.modes(0.0)[0][0], rel=1e-8)


def test_frequencies_lie_above_the_full_model_and_fall_with_more_modes(
    coarse_matrices, full_frequencies
):
    """Rayleigh-Ritz on nested spaces, which takes a rank tolerance that drops nothing."""
    above = [np.inf]
    for eta in (1, 4, 9):
        rom, _ = reduce(coarse_matrices, eta, ALL)
        now = frequencies(rom, coarse_matrices.speeds)
        # omega^2 takes round-off of the largest eigenvalue, 2e7 times the lowest; the margins
        # found are 2e-5 and more
        assert np.all(now >= full_frequencies * (1 - 1e-8))
        assert np.all(now <= np.array(above) * (1 + 1e-8))
        above = now
    assert np.all(above[:, :7] < full_frequencies[:, :7] * 1.005)


def test_default_basis_is_above_the_full_model_too(coarse_rom, full_frequencies):
    """Rayleigh-Ritz holds whatever the rank tolerance dropped."""
    ratio = frequencies(coarse_rom, basis_speeds(coarse_rom.Omega_m)) / full_frequencies
    assert ratio.min() > 1 - 1e-8


def test_static_response_to_interface_loads_is_exact_at_the_three_speeds(coarse_matrices, static):
    """What the constraint modes buy, for every load, at every point of the blade."""
    rom, T = reduce(coarse_matrices, 1, ALL)
    F, fields = static
    for speed, (_, U) in zip(coarse_matrices.speeds, fields, strict=True):
        u = T @ np.linalg.solve(rom.stiffness(speed), T.T @ F)
        # round-off times the condition number of a thin blade, 1e6: measured 6e-10
        np.testing.assert_allclose(u, U, rtol=0, atol=1e-8 * abs(U).max())


def test_static_response_at_the_default_rank_tolerance(coarse_matrices, coarse_reduced, static):
    """Directions below 1e-4 are gone: a few 1e-4 in energy norm, its square in compliance.

    The share left out of a unit column is at most the tolerance times the largest singular value,
    here 5; Galerkin's error in the compliance is the square of the error in energy norm, and it is
    always too stiff.
    """
    rom, T = coarse_reduced
    b = coarse_matrices.interface_dofs.ravel()
    F, fields = static
    for speed, (K, U) in zip(coarse_matrices.speeds, fields, strict=True):
        u = T @ np.linalg.solve(rom.stiffness(speed), T.T @ F)
        full, reduced = np.diag(U[b]), np.diag(u[b])
        energy = np.sqrt(np.diag((u - U).T @ (K @ (u - U))) / full)
        assert energy.max() < 1e-3  # measured 0, 1.9e-4, 5.7e-4
        np.testing.assert_allclose(1 - reduced / full, energy**2, rtol=0, atol=1e-8)  # as above


def test_all_fixed_interface_modes_give_the_whole_spectrum(small):
    """14 DoFs off the interface, 14 modes: the basis is all of space, at any speed."""
    rom, _ = reduce(small.matrices(basis_speeds(small.Omega_m)), 14, ALL)
    assert rom.n == 20
    for speed in (0.0, 0.7, 1.5, 2.2, 3.0):
        expected = np.sqrt(eigh(small.K(speed), small.M, eigvals_only=True))
        np.testing.assert_allclose(rom.modes(speed)[0], expected, rtol=1e-10)  # round-off


def test_linear_prestress_has_no_fourth_power(coarse_blade, coarse_mesh):
    blade = coarse_blade.model_copy(update={"prestress": "linear"})
    speeds = basis_speeds(blade.max_speed_rad_s)
    matrices = assemble(blade, coarse_mesh.mesh, coarse_mesh.interface, speeds)
    rom, _ = reduce(matrices, 9, 1e-4)
    share = abs(rom.K[2]).max() * rom.Omega_m**4 / abs(rom.K[0]).max()
    assert share < 1e-10  # round-off of the projection: measured 2e-12; `nonlinear` has 6e-3


@pytest.mark.parametrize("speeds", [[0, 300, 650], [0, 325], np.linspace(0, 650, 9)])
def test_other_speeds_are_refused(small, speeds):
    with pytest.raises(ValueError, match="a basis needs the speeds 0, Omega_m/2, Omega_m, not"):
        reduce(small.matrices(speeds), 3, 1e-4)


def test_unstable_speed_is_refused(coarse_matrices):
    K, M = coarse_matrices.K, coarse_matrices.M
    # 1.9e4 rad/s lies above some frequencies of the blade with its tip held
    unstable = replace(coarse_matrices, K=(K[0], K[1], K[2] - 1.9e4**2 * M))
    with pytest.raises(ModesError, match="not positive definite"):
        reduce(unstable, 3, 1e-4)


def test_projection_is_symmetric_to_the_last_bit():
    rng = np.random.default_rng(2)
    A, T = rng.normal(size=(30, 30)), rng.normal(size=(30, 7))
    reduced = project(A + A.T, T)
    np.testing.assert_array_equal(reduced, reduced.T)
    np.testing.assert_allclose(reduced, T.T @ (A + A.T) @ T, rtol=1e-12, atol=1e-12)
