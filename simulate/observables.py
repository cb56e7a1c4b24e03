"""What users read off a sweep: spectra, amplitudes along engine orders, worn lobes."""

from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.signal import ShortTimeFFT, find_peaks
from scipy.signal.windows import hann
from scipy.stats import entropy

from simulate.places import share_weights

LOBE_BLUR = np.radians(4)  # rad; narrower dips, as of one round's rub, do not split a lobe
LOBE_PROMINENCE = 0.15  # of the deepest wear; shallower bumps are no lobes
BLURRED = 4096  # points of a blurred profile
MODE_BAND = 0.5  # engine orders to either side of a natural frequency that count as its mode's
HALF_ORDER = 0.25  # an engine order k collects the spectrum in k -+ 0.25


def spectrum(u_r: NDArray[np.float64]) -> NDArray[np.float64]:
    """One-sided amplitude spectrum of a whole number of rounds, m.

    Bin b is engine order b / rounds: no window is needed, engine orders are bins.

    >>> theta = 2 * np.pi * np.arange(128) / 64  # two rounds
    >>> amplitudes = spectrum(1e-5 + 3e-5 * np.cos(4 * theta))
    >>> amplitudes[[0, 8]].round(9)  # the mean, and order 4
    array([1.e-05, 3.e-05])
    """
    amplitude = 2 * np.abs(np.fft.rfft(u_r)) / len(u_r)
    amplitude[0] /= 2
    if len(u_r) % 2 == 0:
        amplitude[-1] /= 2
    return amplitude


def amplitude(
    spectra: NDArray[np.float64], rounds: int, k: int | None = None
) -> NDArray[np.float64]:
    """||Y||: largest amplitude of ``spectra`` (..., bins) of so many rounds, but for the mean.

    With ``k`` the largest near that engine order. nan where a run failed.

    >>> spectra = np.array([[9.0, 0.1, 0.2, 0.3, 5.0], [9.0, 0.4, 6.0, 0.2, 0.1]])  # at two speeds
    >>> amplitude(spectra, rounds=1)
    array([5., 6.])
    >>> amplitude(spectra, rounds=1, k=4)
    array([5. , 0.1])
    """
    orders = np.arange(spectra.shape[-1]) / rounds
    near = orders > 0 if k is None else np.abs(orders - k) <= HALF_ORDER
    return spectra[..., near].max(axis=-1)


def spectrogram(
    u_r: NDArray[np.float64], samples_per_round: int, window: int, slices: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Amplitudes (orders, windows) over time: a steady tone has its own. Hann window.

    Parameters
    ----------
    window, slices
        Rounds in a window; windows a round. Only those that lie within the run are taken.

    Returns
    -------
    rounds, orders, amplitude
        At the middle of each window; engine orders; in the unit of ``u_r``.
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
    """Share of the energy of ``u_r``, a whole number of rounds, within half an order of f1(Omega).

    ``speed_over_f1`` and ``f1`` are Omega and f1(Omega), both over f1(0). The mean is left out;
    energy is amplitude squared. nan where nothing moves.
    """
    energy = spectrum(u_r)[1:] ** 2
    orders = np.arange(1, len(energy) + 1) * samples_per_round / len(u_r)
    near = np.abs(orders - f1 / speed_over_f1) <= MODE_BAND
    total = energy.sum()
    return float(energy[near].sum() / total) if total > 0 else float("nan")


def spectral_entropy(amplitudes: NDArray[np.float64]) -> float:
    """Shannon entropy of the energy (amplitude squared) over its bins, over that of equal bins.

    0: all energy in one bin, a pure tone; 1: the same in every bin. White noise of random phase
    has 1 - (1 - gamma) / ln(bins), gamma = 0.577 (Euler). nan where there is no energy.
    Source: Shannon 1948; normalised as in Inouye et al. 1991.

    >>> spectral_entropy(np.array([0.0, 2.0, 0.0, 0.0])), spectral_entropy(np.ones(4))
    (0.0, 1.0)
    """
    energy = np.square(amplitudes)
    return float(entropy(energy, base=len(energy))) if energy.any() else float("nan")


def leading_gap(sweep: xr.Dataset) -> float:
    """Gap at chord fraction 1/16, m: what outputs are told over."""
    return float(sweep.attrs["gap_m"])


def leading_wear(sweep: xr.Dataset) -> NDArray[np.float64]:
    """Worn depth (speeds, nu), m, mean over the leading eighth of the chord."""
    return share_weights(sweep["end"].values)[0] @ sweep["wear"].values


@dataclass(frozen=True)
class Worn:
    """A worn profile in numbers."""

    lobes: int
    deepest: float  # in the unit of the profile
    between: float  # shallowest over deepest, blurred as lobes are: 1 where worn evenly


def worn(profile: NDArray[np.float64]) -> Worn:
    """Numbers of a worn profile (nu,)."""
    smooth = blurred(profile, LOBE_BLUR)
    between = float(smooth.min() / smooth.max()) if smooth.max() > 0 else 0.0
    return Worn(lobe_count(profile), float(profile.max()), between)


def on_rods(wear: NDArray[np.float64], nu: int) -> NDArray[np.float64]:
    """Profiles (strips, rods) at ``nu`` rods 2 pi j / nu, linear between theirs.

    >>> on_rods(np.array([[0.0, 2.0]]), 4)
    array([[0., 1., 2., 1.]])
    """
    rods = wear.shape[1]
    at = np.arange(nu) * rods / nu
    return np.array([np.interp(at, np.arange(rods), strip, period=rods) for strip in wear])


def blurred(profile: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    """Profile (nu,) around the casing, blurred by a Gaussian of ``angle`` (rad), at BLURRED points.

    Beyond its first few hundred harmonics nothing is left of it.
    """
    harmonics = np.fft.rfft(profile, norm="forward")[: BLURRED // 2]
    harmonics *= np.exp(-((angle * np.arange(harmonics.size)) ** 2) / 2)
    return np.fft.irfft(harmonics, BLURRED, norm="forward")


def lobe_count(wear: NDArray[np.float64]) -> int:
    """Worn lobes of a profile (nu,): maxima that stand out of the blurred depth.

    >>> theta = 2 * np.pi * np.arange(512) / 512
    >>> lobe_count(np.maximum(1e-5 * np.cos(3 * theta), 0))
    3
    """
    if wear.max() <= 0:
        return 0
    smooth = blurred(wear, LOBE_BLUR)
    start = int(smooth.argmin())  # cut the circle where it is least worn: no lobe is split
    unrolled = np.concatenate([np.roll(smooth, -start), smooth[start : start + 1]])
    return len(find_peaks(unrolled, prominence=LOBE_PROMINENCE * smooth.max())[0])
