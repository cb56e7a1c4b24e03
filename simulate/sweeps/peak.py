"""Response peaks of a sweep along engine orders, and linear crossings of frequencies with them.

Speeds are over f1(0), amplitudes over the gap at xi = 1/16. Figures, summaries and claims all use
these peaks.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from itertools import product
from math import isnan
from typing import Any, Self

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from geometry.blade import RPM
from geometry.project import known
from rom.model import Rom
from simulate.errors.observables import Numbers
from simulate.errors.signals import amplitude, leading_gap
from simulate.scene import BESIDE
from simulate.sweeps.dataset import scene_of
from simulate.sweeps.plain import Course, CriticalSpeed

ORDERS = range(3, 15)  # engine orders along which peaks are sought, beside those of a scene
# Speeds over the crossing at which a peak may lie: contact stiffens, a tangential force may soften
STIFFENED, SOFTENED, HIGHEST = 0.97, 0.93, 1.4
BEYOND = 1.25  # of Omega_m: no farther than there are frequencies extrapolated
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
    course: Course = field(default_factory=Course, hash=False)
    verdict: str = ""  # of second runs (``neighbour``); empty without them
    beyond: str = ""  # ``BEYOND`` where linear kinematics does not hold
    numbers: Numbers = field(default_factory=dict, hash=False)  # in the units of ``NUMBERS``
    errors: Numbers = field(default_factory=dict, hash=False)  # of each number, in its unit
    other: Numbers = field(default_factory=dict, hash=False)  # of the second of two motions
    parts: dict[str, Numbers] = field(
        default_factory=dict, hash=False
    )  # relative changes by second run
    runs: int = 0  # made for it
    seconds: float = 0.0  # CPU time

    @property
    def over_crossing(self) -> float:
        """Omega_c over the linear crossing."""
        return self.Omega_c / known(self.crossing, "crossing")

    @property
    def reported(self) -> bool:
        """Whether figures and tables name it: it is clear, or high at an end of the sweep."""
        least = LEAST_AT_END if self.at_end else LEAST
        return (self.at_end or self.clear) and known(self.amplitude, "amplitude") >= least

    def plain(self) -> dict[str, Any]:
        """All fields as plain values; of a peak along an engine order ``over_crossing`` as well."""
        return vars(self) | ({"over_crossing": self.over_crossing} if self.k else {})

    @classmethod
    def of(cls, plain: Mapping[str, Any]) -> Self:
        """The peak of ``plain`` values, as files have them."""
        return cls(**{name: value for name, value in plain.items() if name != "over_crossing"})


def crossing(rom: Rom, k: int, mode: int = 1, beyond: int = 0) -> float:
    """Linear crossing of a mode, f(Omega) = k Omega, Eq. (21), over f1(0); nan above Omega_m.

    With a degree ``beyond`` that from Omega_m to ``BEYOND`` times it, of ``Rom.beyond``.

    >>> round(crossing(rom, 4), 2)
    0.31
    """
    unit = rom.omega1
    top = rom.Omega_m / unit
    omega = rom.beyond(beyond) if beyond else lambda Omega: rom.modes(Omega)[0]
    ends = (top, BEYOND * top) if beyond else (0.0, top)
    return crossing_of(lambda speed: omega(speed * unit)[mode - 1] / unit, k, *ends)


def crossing_of(f: Callable[[float], float], k: int, lowest: float, highest: float) -> float:
    """Speed from ``lowest`` to ``highest`` at which f(speed) falls below k speed; nan without one.

    >>> round(crossing_of(lambda speed: 1 + 0.4 * speed**2, 4, lowest=0.0, highest=0.5), 4)
    0.2566
    """
    from scipy.optimize import brentq  # a slow import, which many jobs do not need

    def above(speed: float) -> float:
        """How far f is above the line k speed."""
        return f(speed) - k * speed

    if not above(highest) < 0 <= above(lowest):
        return float("nan")
    return float(brentq(above, lowest, highest, xtol=1e-9))


def critical(rom: Rom, operating: Mapping[str, Any]) -> dict[str, Any]:
    """Critical speeds for the margins of operating speeds. Gyroscopic terms are not in the model.

    Parameters
    ----------
    operating : ``lines``, speeds by name, rpm; the number of ``modes``, their engine ``orders``,
        and further ones, at which ``peaks`` are sought, of mode 1 alone

    Returns
    -------
    ``operating``, with ``Hz``, frequencies of the modes at each line; ``crossings``; the speeds,
    rpm, ``through`` which f^2 goes on linearly above the last of them, and ``up_to`` which.
    """
    modes, orders = operating["modes"], operating["orders"]
    pairs = [*product([1], operating["peaks"]), *product(range(1, modes + 1), orders)]
    crossings = [_crossing(rom, mode, k) for mode, k in pairs]
    return {
        **operating,
        "Hz": {
            name: (rom.modes(rpm / RPM)[0][:modes] / (2 * np.pi)).tolist()
            for name, rpm in operating["lines"].items()
        },
        "crossings": [speed for speed in crossings if not isnan(speed["rpm"])],
        "through": (RPM * rom.speeds[-2:]).tolist(),
        "up_to": BEYOND * RPM * rom.Omega_m,
    }


def _crossing(rom: Rom, mode: int, k: int) -> CriticalSpeed:
    """A crossing, nan rpm without one, and that of the quadratic: they differ above Omega_m."""
    within, *beyond = (RPM * rom.omega1 * crossing(rom, k, mode, degree) for degree in (0, 1, 2))
    linear, quadratic = beyond if isnan(within) else (within, within)
    return {
        "what": "extrapolated crossing" if isnan(within) else "crossing",
        "mode": mode,
        "k": k,
        "rpm": linear,
        "quadratic_rpm": quadratic,
        "bound": False,
    }


def along_order(runs: xr.Dataset, k: int | None = None) -> NDArray[np.float64]:
    """Amplitude (speeds,), over the gap, of u_r at xi = 1/16 along engine order ``k``.

    Without ``k`` the largest of all orders. nan where a run has no spectrum.
    """
    rounds = scene_of(runs).record.rounds_of_spectrum
    along = amplitude(runs["spectrum"].values, rounds, k)  # single precision, as files hold it
    return along.astype(float) / leading_gap(runs)


def peak_of(runs: xr.Dataset, rom: Rom, k: int) -> Peak | None:
    """Peak of a sweep along engine order ``k``; None without a result near the crossing."""
    return peak_among(
        runs["speed_over_f1"].values,
        partial(along_order, runs),
        k,
        crossing(rom, k),
        tangential=scene_of(runs).contact.along,
    )


def peak_among(
    speeds: NDArray[np.float64],
    along_of: Callable[[int], NDArray[np.float64]],
    k: int,
    linear_crossing: float,
    tangential: bool,
) -> Peak | None:
    """Peak along engine order ``k``; None without a result near the crossing.

    Parameters
    ----------
    speeds : (speeds,), over f1(0), ascending
    along_of : amplitudes (speeds,), over the gap, along an engine order; nan without a spectrum
    linear_crossing : of ``k``, over f1(0)
    tangential : whether the scene has a tangential force
    """
    along = along_of(k)
    lowest = SOFTENED if tangential else STIFFENED
    near = (speeds >= lowest * linear_crossing) & (speeds <= HIGHEST * linear_crossing)
    inside = np.flatnonzero(near & np.isfinite(along))
    if len(inside) == 0:
        return None
    best = int(inside[along[inside].argmax()])
    sidebands = [along_of(sideband)[best] for sideband in sidebands_of(k)]
    return Peak(
        k=k,
        index=best,
        Omega_c=float(speeds[best]),
        amplitude=float(along[best]),
        crossing=linear_crossing,
        at_end=best in (0, len(speeds) - 1),
        clear=bool(_is_prominent(along, best) and along[best] >= max(sidebands)),
    )


def sidebands_of(k: int) -> list[int]:
    """Engine orders that the casing's two nodal diameters couple to order ``k``."""
    return [k + step for step in SIDEBANDS if k + step > 0]


def peaks_of(runs: xr.Dataset, rom: Rom) -> dict[int, Peak]:
    """Peaks of a sweep by engine order, for those in ``ORDERS`` or of its scene that have one.

    None without spectra.
    """
    asked = scene_of(runs).peaks
    orders = sorted({*ORDERS, *(asked.orders if asked else ())}) if "spectrum" in runs else ()
    return {k: peak for k in orders if (peak := peak_of(runs, rom, k))}


def reported(runs: xr.Dataset, rom: Rom) -> dict[int, Peak]:
    """Peaks of a sweep that figures and tables name, by engine order."""
    return {k: peak for k, peak in peaks_of(runs, rom).items() if peak.reported}


def _is_prominent(along: NDArray[np.float64], index: int) -> bool:
    """Whether the amplitude at ``index`` falls by ``PROMINENCE`` of itself on both sides."""
    from scipy.signal import find_peaks  # a slow import, which many jobs do not need

    prominence = PROMINENCE * along[index]
    return index in find_peaks(np.nan_to_num(along), prominence=prominence)[0]
