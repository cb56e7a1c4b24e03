"""Signals of a run: spectra, amplitudes along engine orders, worn lobes; whole records."""

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from simulate.contact.places import share_weights
from simulate.scene import LEADING, TRAILING

LOBE_BLUR = np.radians(4)  # rad; dips narrower than this do not split a lobe
LOBE_PROMINENCE = 0.15  # least prominence of a lobe, over the deepest wear
BLURRED = 4096  # points of a blurred profile
HALF_ORDER = 0.25  # the amplitude at engine order k is taken within k -+ 0.25
RESOLVED = 2  # bins, distance of a line from an integer order at which it is on none
FALLS, RUBS = 0.5, 0.9  # of the decay of a free vibration: a line that falls by more is one
LASTS = 0.99  # share that is left at least of a line that lasts, with hardly any damping


def spectrum(u_r: NDArray[np.float64]) -> NDArray[np.float64]:
    """One-sided amplitude spectrum of a whole number of revolutions, m.

    Bin b is engine order b / revolutions: no window is needed, engine orders are bins.

    >>> theta = 2 * np.pi * np.arange(128) / 64  # two revolutions
    >>> amplitudes = spectrum(1e-5 + 3e-5 * np.cos(4 * theta))
    >>> amplitudes[[0, 8]].round(9)  # the mean, and order 4
    array([1.e-05, 3.e-05])
    """
    amplitude = 2 * np.abs(np.fft.rfft(u_r)) / len(u_r)
    amplitude[0] /= 2
    if len(u_r) % 2 == 0:
        amplitude[-1] /= 2
    return amplitude


def lines(
    u_r: NDArray[np.float64],
    rounds: int,
    zeta: Callable[[NDArray[np.float64]], float | NDArray[np.float64]],
    driven: NDArray[np.bool_],
) -> dict[str, Any]:
    """Lines of the signals ``u_r`` (samples, places) of a whole number of revolutions.

    A free vibration decays by exp(-2 pi zeta x n) from the first half of the revolutions to the
    second, n revolutions later, x = f / Omega. A line lasts that falls by less than ``FALLS`` of
    that; along an engine order that the casing drives, where a rub may end, by less than ``RUBS``.
    Nothing is on an order beside which, ``RESOLVED`` bins away or more, a line is twice as strong.
    A line on no integer order is kept where it is the largest of its spectrum; without two
    revolutions in each half none is.

    Parameters
    ----------
    zeta : damping ratios of the modes at orders (k,) of Omega
    driven : (orders,), whether the casing drives the engine orders 1, 2, ...

    Returns
    -------
    By the names of a sweep's variables, amplitudes in the unit of the signals: ``along`` (places,
    orders), along engine orders 1, 2, ... where they last; ``beside`` (places,), largest on no
    integer order that lasts, 0: none; ``beside_order`` (places,), f / Omega of these, nan without
    one; ``free``, 1 where the largest at the first place is a free vibration of the start, else 0.
    """
    orders, half = np.arange(1, len(driven) + 1), rounds // 2
    part, resolved = half * (len(u_r) // rounds), half >= RESOLVED
    whole, first, last = (
        np.apply_along_axis(spectrum, 0, signals).T
        for signals in (u_r, u_r[: part or None], u_r[-part:])
    )
    on_order = _around(whole, rounds * orders, (RESOLVED - 1) * resolved)
    width = int(HALF_ORDER * rounds)
    along = _around(whole, rounds * orders, width)  # as ``amplitude``
    along *= on_order > _around(whole, rounds * orders, width + RESOLVED * resolved) / 2
    kept = np.zeros_like(whole)
    if resolved:
        x = np.arange(last.shape[1])
        free = np.exp(-2 * np.pi * np.maximum(zeta(x / half), 0) * (rounds - half) * x / half)
        lasting = last > first * np.minimum(1 - FALLS * (1 - free), LASTS)
        rubs = driven & (last > first * (1 - RUBS * (1 - free)))[:, half * orders]
        along *= rubs | lasting[:, half * orders]
        bins = np.arange(1, rounds * len(orders))
        from_order = bins - rounds * np.rint(bins / rounds).astype(int)
        near = np.rint(bins * half / rounds).astype(int)
        near += (near % half == 0) * np.sign(from_order)  # beside an order, not on it
        top = (whole[:, bins] > whole[:, bins - 1]) & (whole[:, bins] >= whole[:, bins + 1])
        off = top & (np.abs(from_order) >= RESOLVED) & lasting[:, near]
        kept[:, bins] = whole[:, bins] * (off & (whole[:, bins] > on_order.max(axis=1)[:, None]))
    beside = kept.max(axis=1)
    largest = max(along[0].max(), beside[0])
    return {
        "along": along,
        "beside": beside,
        "beside_order": np.where(beside > 0, kept.argmax(axis=1) / rounds, np.nan),
        "free": int(resolved and largest < whole[0, 1:].max()),
    }


def _around(
    spectra: NDArray[np.float64], bins: NDArray[np.int64], width: int
) -> NDArray[np.float64]:
    """Largest amplitudes (places, bins) within a ``width`` of the ``bins``."""
    return spectra[:, bins[:, None] + np.arange(-width, width + 1)].max(axis=-1)


def amplitude(
    spectra: NDArray[np.floating], rounds: int, k: float | None = None
) -> NDArray[np.floating]:
    """||Y|| (...): largest amplitude of ``spectra`` (..., bins) over ``rounds``, without the mean.

    With ``k``, the largest within 0.25 of that engine order; of a line on no integer order, f /
    Omega = k, of bins that are on none. nan where a run has no spectrum.

    >>> spectra = np.array([[9.0, 0.1, 0.2, 0.3, 5.0], [9.0, 0.4, 6.0, 0.2, 0.1]])  # at two speeds
    >>> amplitude(spectra, rounds=1)
    array([5., 6.])
    >>> amplitude(spectra, rounds=1, k=4)
    array([5. , 0.1])
    """
    orders = np.arange(spectra.shape[-1]) / rounds
    if k is None:
        return spectra[..., 1:].max(axis=-1)
    width = HALF_ORDER
    if off := abs(k - round(k)):
        width = min(HALF_ORDER, off - (RESOLVED - 0.5) / rounds)
    return spectra[..., np.abs(orders - k) <= width].max(axis=-1)


def filled[T: np.floating](values: NDArray[T], rows: int, at_end: bool = False) -> NDArray[T]:
    """The ``values`` (n, ...) with nan for the rows of revolutions that were not computed.

    These follow; or come before, where the values are ``at_end``.
    """
    whole = np.full((rows, *values.shape[1:]), np.nan, values.dtype)
    whole[rows - len(values) if at_end else 0 :][: len(values)] = values
    return whole


def leading_gap(sweep: xr.Dataset) -> float:
    """Gap at chord fraction 1/16, m, by which outputs are divided."""
    return float(sweep.attrs["gap_m"])


def gaps_at_ends(sweep: xr.Dataset) -> NDArray[np.float64]:
    """Gaps (speeds, 2), m, at chord fractions 1/16 and 15/16, of gaps given at rest."""
    xi = sweep["xi"].values
    return np.array([np.interp((LEADING, TRAILING), xi, gap) for gap in sweep["gap"].values])


def leading_wear(sweep: xr.Dataset) -> NDArray[np.float64]:
    """Worn depth (speeds, nu), m, mean over the leading eighth of the chord."""
    return share_weights(sweep["end"].values)[0] @ sweep["wear"].values


def on_rods(wear: NDArray[np.float64], nu: int) -> NDArray[np.float64]:
    """Profiles (strips, nu) interpolated linearly, from rods of ``wear`` (strips, rods).

    >>> on_rods(np.array([[0.0, 2.0]]), 4)
    array([[0., 1., 2., 1.]])
    """
    rods = wear.shape[1]
    places = np.arange(nu) * rods / nu
    return np.array([np.interp(places, np.arange(rods), strip, period=rods) for strip in wear])


def blurred(profile: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    """Profile (nu,) around the casing convolved with a Gaussian, (BLURRED,).

    ``angle``: standard deviation, rad; harmonics far above 1/angle vanish.
    """
    harmonics = np.fft.rfft(profile, norm="forward")[: BLURRED // 2]
    harmonics *= np.exp(-((angle * np.arange(harmonics.size)) ** 2) / 2)
    return np.fft.irfft(harmonics, BLURRED, norm="forward")


def lobe_count(wear: NDArray[np.float64]) -> int:
    """Number of worn lobes of a profile (nu,): prominent maxima of the blurred depth.

    >>> theta = 2 * np.pi * np.arange(512) / 512
    >>> lobe_count(np.maximum(1e-5 * np.cos(3 * theta), 0))
    3
    """
    if wear.max() <= 0:
        return 0
    smooth = blurred(wear, LOBE_BLUR)
    start = int(smooth.argmin())  # cut the circle where wear is least: no lobe is split
    unrolled = np.concatenate([np.roll(smooth, -start), smooth[start : start + 1]])
    least = LOBE_PROMINENCE * smooth.max()
    return int((maxima(unrolled, least)[1] >= least).sum())


def maxima(
    values: NDArray[np.float64], least: float = 0.0
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Places of the inner maxima of ``values`` (n,), and by how much each stands out.

    Those that cannot stand out by the ``least``, as they are not so far above the lowest value, are
    left out: a smooth profile has hundreds of the size of rounding.

    The prominence of topography: down to the higher of the lowest values on both sides, on the way
    to a higher one or to the end. That of ``scipy.signal.find_peaks``, whose import takes longer
    than most jobs spend on all their maxima.

    >>> maxima(np.array([0.0, 3.0, 1.0, 2.0, 0.0]))
    (array([1, 3]), array([3., 1.]))
    """

    def lowest(outward: NDArray[np.float64]) -> float:
        """Lowest value of those ``outward`` from a maximum before the first that is higher."""
        higher = np.flatnonzero(outward > outward[0])
        return outward[: higher[0] if len(higher) else None].min()

    tops = 1 + np.flatnonzero((values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:]))
    tops = tops[values[tops] - np.fmin.reduce(values, initial=np.inf) >= least]
    bases = [max(lowest(values[top::-1]), lowest(values[top:])) for top in tops]
    return tops, values[tops] - np.array(bases)
