"""Signals of a run that the claims compare: spectra over time, energy by mode, lobes that merge."""

import numpy as np
from numpy.typing import NDArray
from scipy.signal import ShortTimeFFT
from scipy.signal.windows import hann
from scipy.stats import entropy

from simulate.signals import LOBE_BLUR, blurred, spectrum

MODE_BAND = 0.5  # engine orders on either side of a natural frequency, ascribed to its mode


def spectrogram(
    u_r: NDArray[np.float64], samples_per_round: int, window: int, slices: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Amplitudes over time by a short-time Fourier transform with a Hann window.

    Scaled so that a harmonic has its own amplitude.

    Parameters
    ----------
    window : revolutions per window
    slices : windows per revolution; only those that lie within the run are computed

    Returns
    -------
    rounds, orders, amplitude
        Middle of each window (windows,), engine orders (orders,), and amplitudes (orders, windows)
        in the unit of ``u_r``.
    """
    transform = ShortTimeFFT(
        hann(window * samples_per_round, sym=False),
        hop=samples_per_round // slices,
        fs=samples_per_round,
        fft_mode="onesided2X",
        scale_to="magnitude",
        phase_shift=None,
    )
    first, last = transform.lower_border_end[1], transform.upper_border_begin(len(u_r))[1]
    amplitude = np.abs(transform.stft(u_r, p0=first, p1=last))
    return transform.delta_t * np.arange(first, last), transform.f, amplitude


def mode_share(
    u_r: NDArray[np.float64], samples_per_round: int, speed_over_f1: float, f1: float
) -> float:
    """Share of the spectral energy of ``u_r`` within half an engine order of f1(Omega).

    ``u_r`` spans a whole number of revolutions; ``speed_over_f1`` and ``f1`` are Omega and
    f1(Omega), both over f1(0). Energy is amplitude squared, without the mean. nan without any
    vibration.
    """
    energy = spectrum(u_r)[1:] ** 2
    orders = np.arange(1, len(energy) + 1) * samples_per_round / len(u_r)
    near = np.abs(orders - f1 / speed_over_f1) <= MODE_BAND
    total = energy.sum()
    return float(energy[near].sum() / total) if total > 0 else float("nan")


def spectral_entropy(amplitudes: NDArray[np.float64]) -> float:
    """Shannon entropy of the energy (amplitude squared) of all bins, over that of equal energies.

    0: all energy in one bin; 1: the same energy in every bin. White noise of random phase has
    1 - (1 - gamma) / ln(bins), gamma = 0.577 (Euler's constant). nan where there is no energy.
    Source: Shannon 1948; normalised as in Inouye et al. 1991.

    >>> spectral_entropy(np.array([0.0, 2.0, 0.0, 0.0])), spectral_entropy(np.ones(4))
    (0.0, 1.0)
    """
    energy = np.square(amplitudes)
    return float(entropy(energy, base=len(energy))) if energy.any() else float("nan")


def between_lobes(profile: NDArray[np.float64]) -> float:
    """Shallowest over deepest depth of a blurred profile (nu,): 1 for uniform wear, 0 without."""
    smooth = blurred(profile, LOBE_BLUR)
    return float(smooth.min() / smooth.max()) if smooth.max() > 0 else 0.0
