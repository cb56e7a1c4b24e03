"""Response peaks of a sweep along engine orders, and the linear crossings of f1 with them.

Speeds are over f1(0), amplitudes over the gap at xi = 1/16. Figures, summaries and claims all use
these peaks.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rom.model import Rom
from simulate.errors.observables import Numbers
from simulate.errors.signals import amplitude, leading_gap
from simulate.scene import BESIDE
from simulate.sweeps.dataset import scene_of

ORDERS = range(3, 15)  # engine orders along which peaks are sought
# Speeds over the crossing at which a peak may lie: contact stiffens, a tangential force may soften
STIFFENED, SOFTENED, HIGHEST = 0.97, 0.93, 1.4
PROMINENCE = 0.5  # least prominence of a peak over its height
LEAST = 0.1  # gaps, least amplitude of a reported peak
LEAST_AT_END = 1.0  # gaps, least amplitude of a reported peak at an end of the sweep
SIDEBANDS = (
    -BESIDE,
    BESIDE,
)  # orders coupled to an engine order by the casing's two nodal diameters


@dataclass(frozen=True)
class Peak:
    """Largest response along an engine order near its linear crossing with f1, and its results.

    Or, of a sweep without a peak, its largest response. Without results where none were asked for,
    or the run there has none; those of ``peak_results``.
    """

    k: int | None  # engine order; None without a peak
    index: int  # of the speed
    Omega_c: float  # critical speed under contact, Eq. (22), over f1(0): a speed of the sweep
    amplitude: float | None = None  # ||Y||, over the gap
    crossing: float | None = None  # linear, over f1(0)
    at_end: bool = False  # first or last speed of the sweep: the response may still grow beyond
    clear: bool = False  # prominent on both sides along its order, and no sideband of another
    spacing: float | None = None  # over f1(0), to the further neighbour in the sweep
    status: str = ""
    lobes: int | None = None  # worn there, of the leading eighth; None where no wear is recorded
    course: dict[str, Any] = field(default_factory=dict, hash=False)  # ``dataset.course`` there
    verdict: str = ""  # of second runs (``neighbour``); empty where none was marched
    numbers: Numbers = field(default_factory=dict, hash=False)  # in the units of ``NUMBERS``
    errors: Numbers = field(default_factory=dict, hash=False)  # of each number, in its unit
    other: Numbers = field(default_factory=dict, hash=False)  # of the second of two motions
    parts: dict[str, Numbers] = field(
        default_factory=dict, hash=False
    )  # relative changes by second run
    runs: int = 0  # marched for it
    seconds: float = 0.0  # CPU time

    @property
    def over_crossing(self) -> float:
        """Omega_c over the linear crossing."""
        return self.Omega_c / self.crossing

    @property
    def reported(self) -> bool:
        """Whether figures and tables name it: it is clear, or high at an end of the sweep."""
        if self.at_end:
            return self.amplitude >= LEAST_AT_END
        return self.clear and self.amplitude >= LEAST

    def plain(self) -> dict[str, Any]:
        """All fields as plain values; of a peak along an engine order ``over_crossing`` as well."""
        return vars(self) | ({"over_crossing": self.over_crossing} if self.k else {})


def crossing(rom: Rom, k: int) -> float:
    """Linear crossing f1(Omega) = k Omega, Eq. (21), over f1(0); nan where it is above Omega_m.

    >>> round(crossing(rom, 4), 2)
    0.31
    """
    unit = rom.omega1
    return crossing_of(lambda speed: rom.modes(speed * unit)[0][0] / unit, k, rom.Omega_m / unit)


def crossing_of(f1: Callable[[float], float], k: int, highest: float) -> float:
    """Speed up to ``highest`` at which f1(speed) = k speed; nan where there is none.

    >>> round(crossing_of(lambda speed: 1 + 0.4 * speed**2, 4, highest=0.5), 4)
    0.2566
    """
    from scipy.optimize import brentq  # a slow import, which many jobs do not need

    def above(speed: float) -> float:
        return f1(speed) - k * speed

    return float(brentq(above, 0, highest, xtol=1e-9)) if above(highest) < 0 else float("nan")


def along_order(runs: xr.Dataset, k: int | None = None) -> NDArray[np.float64]:
    """Amplitude (speeds,), over the gap, of u_r at xi = 1/16 along engine order ``k``.

    Without ``k`` the largest of all orders. nan where a run has no spectrum.
    """
    rounds = scene_of(runs).record.spectrum_rounds
    along = amplitude(runs["spectrum"].values, rounds, k)  # single precision, as files hold it
    return along.astype(float) / leading_gap(runs)


def peak_of(runs: xr.Dataset, rom: Rom, k: int) -> Peak | None:
    """Peak of a sweep along engine order ``k``; None without a result near the crossing."""
    tangential = scene_of(runs).contact.along
    speeds = runs["speed_over_f1"].values
    return peak_among(speeds, partial(along_order, runs), k, crossing(rom, k), tangential)


def peak_among(
    speeds: NDArray[np.float64],
    along_of: Callable[[int], NDArray[np.float64]],
    k: int,
    at: float,
    tangential: bool,
) -> Peak | None:
    """Peak along engine order ``k``; None without a result near the crossing.

    Parameters
    ----------
    speeds : (speeds,), over f1(0), ascending
    along_of : amplitudes (speeds,), over the gap, along an engine order; nan without a spectrum
    at : linear crossing of ``k``, over f1(0)
    tangential : whether the scene has a tangential force
    """
    along = along_of(k)
    lowest = SOFTENED if tangential else STIFFENED
    near = (speeds >= lowest * at) & (speeds <= HIGHEST * at)
    inside = np.flatnonzero(near & np.isfinite(along))
    if len(inside) == 0:
        return None
    best = int(inside[along[inside].argmax()])
    sidebands = [along_of(beside)[best] for beside in sidebands_of(k)]
    return Peak(
        k=k,
        index=best,
        Omega_c=float(speeds[best]),
        amplitude=float(along[best]),
        crossing=at,
        at_end=best in (0, len(speeds) - 1),
        clear=bool(_is_prominent(along, best) and along[best] >= max(sidebands)),
    )


def sidebands_of(k: int) -> list[int]:
    """Engine orders that the casing's two nodal diameters couple to order ``k``."""
    return [k + step for step in SIDEBANDS if k + step > 0]


def peaks_of(runs: xr.Dataset, rom: Rom) -> dict[int, Peak]:
    """Peaks of a sweep by engine order, for those in ``ORDERS`` that have one.

    None without spectra.
    """
    orders = ORDERS if "spectrum" in runs else ()
    return {k: peak for k in orders if (peak := peak_of(runs, rom, k))}


def reported(runs: xr.Dataset, rom: Rom) -> dict[int, Peak]:
    """Peaks of a sweep that figures and tables name, by engine order."""
    return {k: peak for k, peak in peaks_of(runs, rom).items() if peak.reported}


def _is_prominent(along: NDArray[np.float64], index: int) -> bool:
    """Whether the amplitude at ``index`` falls by ``PROMINENCE`` of itself on both sides."""
    from scipy.signal import find_peaks  # a slow import, which many jobs do not need

    prominence = PROMINENCE * along[index]
    return index in find_peaks(np.nan_to_num(along), prominence=prominence)[0]
