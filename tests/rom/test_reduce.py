"""Reduced against full model: quantities that are exact, and bounds of errors."""

from dataclasses import replace

import numpy as np
import pytest
from refused import refused
from scipy.linalg import eigh
from scipy.sparse.linalg import splu

from geometry.blade import EnrichedBasis, PaperBasis
from rom.model import CODE
from rom.modes import ModesError, ShiftInvert
from rom.reduce import reduce


def paper(eta, rank_tolerance=1e-12):
    """The paper's basis; this rank tolerance drops round-off only."""
    return PaperBasis(kind="paper", fixed_interface_modes=eta, rank_tolerance=rank_tolerance)


@pytest.fixture(scope="module")
def full_frequencies(coarse_matrices):
    """Of ten modes at the four speeds of the default basis (4, 10), rad/s."""
    return np.array([ShiftInvert(K, coarse_matrices.M).modes(10).omega for K in coarse_matrices.K])


def static(fom):
    """Displacement fields under each unit interface load, per speed: (n_full, 24)."""
    F = fom.S.T.toarray()
    return F, [splu(K.tocsc()).solve(F) for K in fom.K]


THREE = [0, 1, 3]  # of the four speeds, those of the paper


def frequencies(rom, speeds):
    return np.array([rom.modes(speed)[0][:10] for speed in speeds])


@pytest.mark.parametrize("name", ["coarse", "paper"])
def test_stiffness_is_the_projected_one_at_the_speeds_of_the_basis(name, request):
    rom, T = request.getfixturevalue(f"{name}_reduced")
    coarse_matrices = request.getfixturevalue(f"{name}_matrices")
    for speed, K in zip(coarse_matrices.speeds, coarse_matrices.K, strict=True):
        expected = T.T @ (K @ T)
        # round-off of the interpolation, coefficients up to 16
        np.testing.assert_allclose(rom.stiffness(speed), expected, atol=1e-12 * abs(expected).max())
    expected = T.T @ (coarse_matrices.M @ T)
    np.testing.assert_allclose(rom.M, expected, rtol=0, atol=1e-15 * abs(expected).max())


def test_default_model_has_the_form_of_craig_and_bampton_at_rest(coarse_rom):
    """K(0) couples no interface DoF with a mode; the modes have unit mass."""
    K, M = coarse_rom.K[0], coarse_rom.M
    assert abs(K[:24, 24:]).max() < 1e-13 * abs(K).max()
    # round-off of the modes, which differs with the processor: 1.1e-11 on one
    np.testing.assert_allclose(M[24:, 24:], np.eye(coarse_rom.n - 24), atol=1e-10)


def test_a_reduction_says_how_many_speeds_are_left(coarse_blade, coarse_matrices):
    said = []
    reduce(coarse_matrices, coarse_blade.basis, "r", said.append)
    assert [line.split(",")[0] for line in said] == [f"speed {i} of 4" for i in (1, 2, 3, 4)]


def test_matrices_are_symmetric_to_the_last_bit(coarse_rom):
    for A in (coarse_rom.M, *coarse_rom.K):
        np.testing.assert_array_equal(A, A.T)


def test_a_model_has_its_provenance(coarse_blade, coarse_matrices, coarse_rom):
    assert coarse_rom.Omega_m == 650
    assert coarse_rom.span == pytest.approx(coarse_blade.sections.span, abs=1e-8)  # ON_CYLINDER
    origin, of_matrices = coarse_rom.provenance, coarse_matrices.provenance
    assert (origin.blade, origin.mesh) == ("coarse", of_matrices.mesh)
    assert origin.settings == coarse_blade.settings_of_model() | {"directions": "rtz"}
    origin.require_code(CODE, "rom-rtz.nc")
    for name in ("xi", "points", "camber"):
        np.testing.assert_array_equal(getattr(coarse_rom, name), getattr(coarse_matrices, name))
    assert 2 * np.pi * coarse_rom.f1 == pytest.approx(coarse_rom.modes(0.0)[0][0], rel=1e-8)


def test_frequencies_lie_above_the_full_model_and_fall_with_more_modes(
    paper_matrices, full_frequencies
):
    """Rayleigh-Ritz on nested spaces, which takes a rank tolerance that drops nothing."""
    above = [np.inf]
    for eta in (1, 4, 9):
        rom, _ = reduce(paper_matrices, paper(eta))
        now = frequencies(rom, paper_matrices.speeds)
        # omega^2 takes round-off of the largest eigenvalue, 2e7 times the lowest; the margins
        # found are 2e-5 and more
        assert np.all(now >= full_frequencies[THREE] * (1 - 1e-8))
        assert np.all(now <= np.array(above) * (1 + 1e-8))
        above = now
    assert np.all(above[:, :7] < full_frequencies[THREE, :7] * 1.005)


def test_default_basis_is_above_the_full_model_too_and_close(
    coarse_rom, coarse_matrices, full_frequencies
):
    """Rayleigh-Ritz holds whatever the rank tolerance dropped of the natural modes."""
    ratio = frequencies(coarse_rom, coarse_matrices.speeds) / full_frequencies
    assert ratio.min() > 1 - 1e-8
    assert ratio.max() < 1 + 2e-5  # of the order of the rank tolerance squared: measured 5e-6


def test_natural_modes_make_their_frequencies_exact_at_the_speeds_of_the_basis(
    coarse_matrices, full_frequencies
):
    """Two natural modes: two exact frequencies, no more."""
    rom, _ = reduce(coarse_matrices, EnrichedBasis(natural_modes=2, rank_tolerance=1e-5))
    error = frequencies(rom, coarse_matrices.speeds) / full_frequencies - 1
    assert abs(error[:, :2]).max() < 1e-8
    assert error[:, 5].min() > 1e-2


def test_static_response_to_interface_loads_is_exact_at_the_three_speeds(paper_matrices):
    """By the constraint modes, for every load, at every point of the blade."""
    rom, T = reduce(paper_matrices, paper(1))
    F, fields = static(paper_matrices)
    for speed, U in zip(paper_matrices.speeds, fields, strict=True):
        u = T @ np.linalg.solve(rom.stiffness(speed), T.T @ F)
        # round-off times the condition number of a thin blade, 1e6: measured 6e-10
        np.testing.assert_allclose(u, U, rtol=0, atol=1e-8 * abs(U).max())


def test_static_response_at_the_default_rank_tolerance(coarse_matrices, coarse_reduced):
    """Directions below 3e-3 are gone: a few 1e-3 in energy norm, its square in compliance.

    The share left out of a unit column is at most the tolerance times the largest singular value,
    here 5, of its own energy, which for the starred columns is small; Galerkin's error in the
    compliance is the square of the error in energy norm, and it is always too stiff.
    """
    fom, (rom, T) = coarse_matrices, coarse_reduced
    F, fields = static(fom)
    for speed, K, U in zip(fom.speeds, fom.K, fields, strict=True):
        u = T @ np.linalg.solve(rom.stiffness(speed), T.T @ F)
        full, reduced = np.diag(fom.S @ U), np.diag(fom.S @ u)
        energy = np.sqrt(np.diag((u - U).T @ (K @ (u - U))) / full)
        assert energy.max() < 3e-3  # measured 0, 4.1e-4, 1.0e-3, 1.4e-3
        np.testing.assert_allclose(1 - reduced / full, energy**2, rtol=0, atol=1e-8)  # as above


def test_all_fixed_interface_modes_give_the_whole_spectrum(small):
    """14 DoFs off the interface, 14 modes: the basis spans the whole space, at any speed."""
    rom, _ = reduce(small.matrices(small.Omega_m * np.array([0, 0.5, 1])), paper(14))
    assert rom.n == 20
    for speed in (0.0, 0.7, 1.5, 2.2, 3.0):
        expected = np.sqrt(eigh(small.K(speed), small.M, eigvals_only=True))
        np.testing.assert_allclose(rom.modes(speed)[0], expected, rtol=1e-10)  # round-off


@pytest.mark.parametrize("speeds", [[0, 300, 650], [0, 325], np.linspace(0, 650, 9)])
@pytest.mark.parametrize("basis", [paper(3), EnrichedBasis()])
def test_other_speeds_are_refused(small, basis, speeds):
    refused(ValueError, reduce, small.matrices(speeds), basis, match="needs the speeds")


def test_unstable_speed_is_refused(paper_matrices):
    K, M = paper_matrices.K, paper_matrices.M
    # 1.9e4 rad/s lies above some frequencies of the blade with its tip held
    unstable = replace(paper_matrices, K=(K[0], K[1], K[2] - 1.9e4**2 * M))
    refused(ModesError, reduce, unstable, paper(3, 1e-4), match="not positive definite")
