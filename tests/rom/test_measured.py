"""Measured frequencies in a model: what they change, a beam whose root is softer, refusals."""

import numpy as np
import pytest
from refused import refused
from rods import of_end, of_modes

from rom.measured import as_clamped, told, with_frequencies
from rom.model import Rom, RomError

HUB, LENGTH, ELEMENTS = 0.5, 1.0, 24  # m
EI, RHO_A = 1.0, 1.0  # N m2, kg/m
SOFTER = 0.95  # f1 over that of the clamped beam


def beam(root=np.inf):
    """Model of a beam that rotates about an axis its bending is along; root of a stiffness, N m.

    Hermite elements, exact for the tension of the rotation.
    """
    a, n = LENGTH / ELEMENTS, 2 * (ELEMENTS + 1)
    M, K, T = np.zeros((3, n, n))
    s, w = np.polynomial.legendre.leggauss(6)
    s, w = (s + 1) / 2, a * w / 2
    N = np.array([1 - 3 * s**2 + 2 * s**3, a * (s - 2 * s**2 + s**3),
                  3 * s**2 - 2 * s**3, a * (s**3 - s**2)])  # fmt: skip
    slope = np.array([6 * s**2 - 6 * s, a * (1 - 4 * s + 3 * s**2),
                      6 * s - 6 * s**2, a * (3 * s**2 - 2 * s)]) / a  # fmt: skip
    bend = np.array([12 * s - 6, a * (6 * s - 4), 6 - 12 * s, a * (6 * s - 2)]) / a**2
    for e in range(ELEMENTS):
        x = HUB + (e + s) * a
        tension = RHO_A * ((HUB + LENGTH) ** 2 - x**2) / 2  # over Omega^2
        of = slice(2 * e, 2 * e + 4)
        M[of, of] += RHO_A * np.einsum("is,js,s->ij", N, N, w)
        K[of, of] += EI * np.einsum("is,js,s->ij", bend, bend, w)
        T[of, of] += np.einsum("is,js,s->ij", slope, slope, w * tension)
    free = np.r_[n - 2, n - 1, 2 : n - 2]  # the end first
    if np.isfinite(root):
        K[1, 1] += root
        free = np.r_[free, 1]
    M, K, T = (of[np.ix_(free, free)] for of in (M, K, T))
    return of_end(M, K, ("radial",), LENGTH, highest=3.0, by_rotation=T)


def softer(share):
    """The beam whose root is as soft that f1 is a ``share`` of that clamped."""
    low, high, clamped = 1e-1, 1e6, beam().f1
    for _ in range(80):
        root = np.sqrt(low * high)
        low, high = (root, high) if beam(root).f1 < share * clamped else (low, root)
    return beam(low)


def of_beam(rom, Omega, modes=2):
    """First frequencies of bending, Hz: those that move the end, without its tilt."""
    omega, Phi = rom.modes(Omega)
    moves = abs(rom.rows(np.array([0.5]))[0] @ Phi) > 1e-6
    return omega[moves][:modes] / (2 * np.pi)


def test_beam_is_that_of_the_closed_form():
    """Clamped: 1.8751^2 and 4.6941^2 over 2 pi."""
    expected = np.array([1.87510407, 4.69409113]) ** 2 / (2 * np.pi)
    np.testing.assert_allclose(of_beam(beam(), 0.0), expected, rtol=2e-6)


@pytest.fixture
def given(coarse_rom):
    """The coarse blade with two frequencies of its own."""
    Hz = coarse_rom.modes(0.0)[0] / (2 * np.pi)
    return {1: 0.95 * Hz[0], 3: 1.02 * Hz[2]}


def test_other_modes_and_all_shapes_stay(coarse_rom, given):
    """At rest, to 1e-10; K(Omega) stays symmetric, and what rotation adds."""
    rom, (omega, Phi) = with_frequencies(coarse_rom, given), coarse_rom.modes(0.0)
    found, shapes = rom.modes(0.0)
    expected = omega.copy()
    expected[[0, 2]] = 2 * np.pi * np.array([given[1], given[3]])
    others = np.delete(np.arange(rom.n), [0, 2])
    np.testing.assert_allclose(found[others], expected[others], rtol=1e-10)
    # of f1 the solver of eigenvalues itself has no more digits
    np.testing.assert_allclose(found[[0, 2]], expected[[0, 2]], rtol=1e-8)
    alike = np.abs(Phi.T @ rom.M @ shapes)
    np.testing.assert_allclose(alike, np.eye(rom.n), rtol=0, atol=1e-9)  # so far the solver's own
    assert np.array_equal(rom.K[1:], coarse_rom.K[1:])
    assert rom.f1 == pytest.approx(given[1], rel=1e-12)
    assert "f1 at rest is" in next(told(rom)) and "-5 %" in next(told(rom))


def test_all_shapes_stay_to_round_off():
    """Of a model whose frequencies lie as near as those of the first modes of a blade."""
    omega = np.array([1.0, 3.9, 5.1, 9.7, 12.0])
    clamped = of_modes(omega, np.array([1.0, 0.4, -0.7, 0.2, 0.5]), length=1.0, highest=1.0)
    before, Phi = clamped.modes(0.0)
    Hz = before / (2 * np.pi)
    rom = with_frequencies(clamped, {1: 0.96 * Hz[0], 2: 1.03 * Hz[1]})
    found, shapes = rom.modes(0.0)
    np.testing.assert_allclose(found[2:], before[2:], rtol=1e-10)
    np.testing.assert_allclose(found[:2], before[:2] * [0.96, 1.03], rtol=1e-10)
    np.testing.assert_allclose(np.abs(Phi.T @ rom.M @ shapes), np.eye(rom.n), rtol=0, atol=1e-10)


def test_clamped_model_comes_back(coarse_rom, given, tmp_path):
    """That of the check against the full model; of a file, too."""
    with_frequencies(coarse_rom, given).save(tmp_path / "rom.nc")
    back = as_clamped(Rom.load(tmp_path / "rom.nc"))
    np.testing.assert_allclose(back.K[0], coarse_rom.K[0], rtol=0, atol=1e-9 * coarse_rom.K.max())
    np.testing.assert_allclose(back.modes(0.0)[0], coarse_rom.modes(0.0)[0], rtol=1e-9)
    assert with_frequencies(coarse_rom, {}) is coarse_rom


@pytest.mark.parametrize(("share", "most"), [(0.95, 0.006), (0.901, 0.011)])
def test_beam_with_a_softer_root(share, most):
    """Up to 0.6 f1(0), in the modes given, beside its own model: the clamped one is off by more."""
    own, clamped = softer(share), beam()
    rom = with_frequencies(clamped, dict(enumerate(of_beam(own, 0.0), 1)))
    speeds = np.linspace(0, 0.6, 13) * own.omega1
    errors = [of_beam(rom, Omega) / of_beam(own, Omega) - 1 for Omega in speeds]
    assert np.abs(errors).max() < most
    assert np.abs(of_beam(clamped, speeds[-1]) / of_beam(own, speeds[-1]) - 1).max() > 2 * most


def test_refuses_what_is_no_shift_of_the_same_mode(coarse_rom):
    """Beyond 10 %, and modes that are not there: in one line."""
    f1 = coarse_rom.f1
    error = refused(RomError, with_frequencies, coarse_rom, {1: 0.89 * f1})
    assert error.key == "frequencies_Hz.1"
    assert "model the root" in str(error)
    assert refused(RomError, with_frequencies, coarse_rom, {90: 1e3}).key == "frequencies_Hz.90"
