"""Response peaks of a sweep: along engine orders, and of lines on none.

Speeds are over f1(0), amplitudes over the gap at xi = 1/16. Figures, summaries, designs and claims
all use these peaks. Linear crossings are those of ``crossings``.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from math import inf
from operator import attrgetter
from typing import Any, Self

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from geometry.blade import MODES, ORDERS
from geometry.tip import EDGES, JUDGED
from rom.crossings import crossing
from rom.model import Rom
from simulate.errors.observables import Numbers
from simulate.marching import WITH_RESULT
from simulate.scene import LEADING, Scene, side_bands
from simulate.signals import amplitude, leading_gap, maxima
from simulate.sweeps.dataset import scene_of
from simulate.sweeps.result_types import NO_CROSSING, Course, OfBlades, mode_name, order_name

# Speeds over the crossing at which a peak may lie: contact stiffens, a tangential force may soften
STIFFENED, SOFTENED, HIGHEST = 0.97, 0.93, 1.4
NEAR = 0.05  # relative distance of two crossings of which a peak may be of either
PROMINENCE = 0.5  # least prominence of a peak over its height
LEAST = 0.1  # gaps, least amplitude of a reported peak
LEAST_AT_END = 1.0  # gaps, least amplitude of a reported peak at an end of the sweep
NODE = 0.25  # of the amplitude elsewhere: a place with less is near a node


@dataclass(frozen=True)
class Peak:
    """A response that stands out over the speeds along an engine order, and its results.

    Or, of a sweep without a peak, its largest response. Without results where none were asked for,
    or the run there has none; those of ``peak_results``.
    """

    k: float | None  # engine order, or f / Omega of a line on none; None without a peak
    index: int  # of the speed
    Omega_c: float  # critical speed under contact, Eq. (22), over f1(0): a speed of the sweep
    amplitude: float | None = None  # ||Y||, over the gap
    crossing: float | None = None  # linear, over f1(0), from which it rises; None: none explains it
    # of that crossing; several where theirs are near
    modes: Sequence[int] = field(default=(), hash=False)
    place: float = LEADING  # of ``JUDGED``
    at_end: bool = False  # first or last speed with a result: it may still grow beyond
    clear: bool = False  # prominent on both sides along its order, and no side band of another
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
    blades: OfBlades | None = field(default=None, hash=False)  # of a stage
    runs: int = 0  # made for it
    seconds: float = 0.0  # CPU time

    @property
    def over_crossing(self) -> float | None:
        """Omega_c over the linear crossing; None without one."""
        return self.crossing and self.Omega_c / self.crossing

    @property
    def name(self) -> str:
        """Engine order, or f / Omega, and mode."""
        return " ".join(filter(None, [order_name(self.k), mode_name(self.modes)]))

    @property
    def rises_from(self) -> str:
        """How far above its linear crossing it is, in words."""
        share = self.over_crossing
        return f"{share:.3f} times the linear crossing" if share else NO_CROSSING

    @property
    def reported(self) -> bool:
        """Whether figures and tables name it: it is clear, or high at an end of the sweep."""
        least = LEAST_AT_END if self.at_end else LEAST
        return (self.at_end or self.clear) and (self.amplitude or 0.0) >= least

    def plain(self) -> dict[str, Any]:
        """All fields as plain values; of a peak ``over_crossing`` as well."""
        return vars(self) | ({"over_crossing": self.over_crossing} if self.k else {})

    @classmethod
    def of(cls, plain: Mapping[str, Any]) -> Self:
        """The peak of ``plain`` values, as files have them."""
        return cls(**{name: value for name, value in plain.items() if name != "over_crossing"})


@dataclass(frozen=True)
class Responses:
    """Amplitudes of the runs of a scene, over the gap, at the places where they are judged.

    ``told`` is that of u_r: 1/16, on a casing that tapers the edge that moves more.
    """

    rom: Rom
    scene: Scene
    speeds: NDArray[np.float64]  # (speeds,), over f1(0), ascending
    told: NDArray[np.int64]  # (speeds,), of ``JUDGED``, from 0
    along: NDArray[np.float64]  # (speeds, places, orders), EO 1, 2, ...; nan without a spectrum
    beside: NDArray[np.float64]  # (speeds, places), lines on no integer order; 0 without
    beside_order: NDArray[np.float64]  # (speeds, places), f / Omega of these
    # ``modes``, from the first, and ``orders`` of which peaks are sought, if not the usual
    sought: Mapping[Any, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, runs: xr.Dataset, rom: Rom) -> Self:
        """Those of a sweep with spectra; of one without `along` at the place of u_r alone."""
        scene, gap, speeds = scene_of(runs), leading_gap(runs), runs["speed_over_f1"].values
        told = np.zeros(len(speeds), int)
        if "place" in runs:
            told = (runs["place"].values == EDGES[1]).astype(int)
        if "along" in runs:
            along, beside = (runs[name].values.astype(float) / gap for name in ("along", "beside"))
            order = runs["beside_order"].values
            return cls(rom, scene, speeds, told, along, beside, order, runs.attrs)
        held = runs["spectrum"].shape[1] // scene.record.rounds_of_spectrum
        orders = range(1, min(scene.record.highest_order + 1, held))
        of_told = np.transpose([along_order(runs, k) for k in orders])
        return cls(rom, scene, speeds, told, *only_at(told, of_told), sought=runs.attrs)

    def series(self, k: float, place: float) -> NDArray[np.float64]:
        """Amplitude (speeds,) along ``k`` at a place; of a line on no integer order that of all."""
        at = JUDGED.index(place)
        return self.along[:, at, int(k) - 1] if k % 1 == 0 else self.beside[:, at]

    def seen(self) -> list[int]:
        """Engine orders along which the response reaches ``LEAST`` at any speed and place."""
        return (1 + np.flatnonzero(np.nan_to_num(self.along).max(axis=(0, 1)) >= LEAST)).tolist()

    def stand_out(self) -> list[Peak]:
        """The reported peaks, speeds ascending; along an order one from each crossing."""
        asked, harmonics = self.scene.peaks and self.scene.peaks.orders, self.scene.casing.orders
        sought = {
            *map(int, np.atleast_1d(self.sought.get("orders", ORDERS))),
            *harmonics,
            *self.scene.forced,
            *(asked or ()),
        }
        lines = self.beside * (self.beside_order <= max(sought))
        found = self._highest(None, lines, 0 * lines)
        for k in sought & {*self.seen()}:
            bands = [k_n - 1 for k_n in side_bands(k, harmonics) if k_n <= self.along.shape[2]]
            others = self.along[:, :, bands].max(axis=2, initial=0.0)
            found += self._highest(k, self.along[:, :, k - 1], others)
        return sorted(found, key=attrgetter("index", "k"))

    def _highest(
        self, k: int | None, along: NDArray[np.float64], others: NDArray[np.float64]
    ) -> list[Peak]:
        """The highest reported peak from each crossing; elsewhere than u_r where that has a node.

        One that no crossing explains is the largest response at its speed. ``along``, ``others``
        (speeds, places): amplitudes along order ``k``, None of lines on none, and the largest of
        its side bands.
        """
        known, by_crossing = np.flatnonzero(np.isfinite(along[:, 0])), {}
        of_all = np.maximum(self.along.max(axis=(1, 2)), self.beside.max(axis=1))
        for place, xi in enumerate(JUDGED):
            lasting = known
            if k:  # elsewhere nothing is known of the order
                lasting = known[along[known, place] > 0]
            for index in map(int, lasting[_stand_out(along[lasting, place])]):
                height, told = float(along[index, place]), self.told[index]
                at_node = along[index, told] < NODE * height
                if height < LEAST or not (place == told or at_node):
                    continue
                order = k or round(float(self.beside_order[index, place]), 6)
                modes, met = self.explain(order, float(self.speeds[index]))
                peak = Peak(
                    k=order,
                    index=index,
                    Omega_c=float(self.speeds[index]),
                    amplitude=height,
                    crossing=met,
                    modes=modes,
                    place=xi,
                    at_end=index in known[[0, -1]],
                    clear=bool(height >= others[index, place]),
                )
                if peak.reported and (met or height >= of_all[index]):
                    by_crossing.setdefault(modes, []).append(peak)
        return [max(peaks, key=attrgetter("amplitude")) for peaks in by_crossing.values()]

    def explain(self, k: float, Omega_c: float) -> tuple[tuple[int, ...], float | None]:
        """Modes from whose linear crossing with ``k`` a peak may rise, and its speed over f1(0).

        The nearest crossing, and modes that cross near it; none and None where there is no such.
        """
        lowest = SOFTENED if self.scene.contact.along else STIFFENED
        modes = range(1, self.sought.get("modes", MODES) + 1)
        met = {mode: crossing(self.rom, k, mode) for mode in modes}
        far = {
            mode: abs(np.log(Omega_c / speed))
            for mode, speed in met.items()
            if lowest * speed <= Omega_c <= HIGHEST * speed  # nan does not
        }
        if not far:
            return (), None
        nearest = met[min(far, key=lambda mode: far[mode])]
        return tuple(mode for mode in far if abs(met[mode] / nearest - 1) <= NEAR), nearest

    def near_f1(
        self,
        k: int,
        along_of: Callable[[int], NDArray[np.float64]],
        harmonics: Iterable[int] | None = None,
    ) -> Peak | None:
        """Largest response along ``k`` near its crossing with f1; None without a result there.

        ``along_of``: amplitudes (speeds,), over the gap, along an engine order; ``harmonics``:
        couple ``k`` to its side bands, by default those of the casing.
        """
        along, met = along_of(k), crossing(self.rom, k)
        lowest = SOFTENED if self.scene.contact.along else STIFFENED
        near = (self.speeds >= lowest * met) & (self.speeds <= HIGHEST * met)
        inside = np.flatnonzero(near & np.isfinite(along))
        if len(inside) == 0:
            return None
        best, known = int(inside[along[inside].argmax()]), np.flatnonzero(np.isfinite(along))
        bands = side_bands(k, self.scene.casing.orders if harmonics is None else harmonics)
        others = [along_of(band)[best] for band in bands if band <= self.along.shape[2]]
        stands_out = best in known[_stand_out(along[known])]
        return Peak(
            k=k,
            index=best,
            Omega_c=float(self.speeds[best]),
            amplitude=float(along[best]),
            crossing=met,
            modes=(1,),
            at_end=best in known[[0, -1]],
            clear=bool(stands_out and along[best] >= max(others, default=0.0)),
        )


def only_at(
    told: NDArray[np.int64], of_told: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Arrays of ``Responses`` from amplitudes (speeds, orders) at the places ``told`` alone."""
    along = np.repeat(0 * of_told[:, None], len(JUDGED), axis=1)  # nan stays
    along[np.arange(len(told)), told] = of_told
    return along, along[:, :, 0] * 0, along[:, :, 0] * 0


def _stand_out(along: NDArray[np.float64]) -> NDArray[np.int64]:
    """Speeds, from 0, at which ``along`` (speeds,) falls by ``PROMINENCE`` of itself on both sides.

    At an end, on the inner side; of one speed nothing stands out.
    """
    before = len(along) - 1
    mirrored = np.concatenate([along[:0:-1], along, along[-2::-1]])  # at both ends
    tops, prominences = maxima(mirrored)
    tops = tops[prominences >= PROMINENCE * mirrored[tops]] - before
    return tops[(tops >= 0) & (tops <= before)]


def reported(runs: xr.Dataset, rom: Rom) -> list[Peak]:
    """Peaks of a sweep that figures and tables name, speeds ascending; none without spectra."""
    return Responses.of(runs, rom).stand_out() if "spectrum" in runs else []


def peaks_or_largest(runs: xr.Dataset, rom: Rom) -> list[Peak]:
    """The reported peaks; without any where the sweep responds most, else its last run.

    None where nothing moves the blade: without contact and force it is at rest.
    """
    peaks, speeds = reported(runs, rom), runs["speed_over_f1"].values
    if peaks or ("displacement" in runs and not runs["displacement"].any()):
        return peaks
    with_result = np.flatnonzero(runs["status"].isin(WITH_RESULT))
    most = with_result[_response(runs)[with_result].argmax()] if len(with_result) else -1
    index = int(most) % len(speeds)
    place = runs["place"].values[index] if "place" in runs else LEADING
    return [Peak(None, index, float(speeds[index]), place=float(place))]


def _response(runs: xr.Dataset) -> np.ndarray:
    """Response of each run: amplitude, else wear, else work on the rods."""
    if "spectrum" in runs:
        return along_order(runs)
    if "wear" in runs:
        return runs["wear"].values.max(axis=(1, 2))
    return runs["ledger"].sel(energy="casing").values


def along_order(runs: xr.Dataset, k: float | None = None) -> NDArray[np.float64]:
    """Amplitude (speeds,), over the gap, of u_r at xi = 1/16 along engine order ``k``.

    Without ``k`` the largest of all orders. nan where a run has no spectrum.
    """
    rounds = scene_of(runs).record.rounds_of_spectrum
    along = amplitude(runs["spectrum"].values, rounds, k)  # single precision, as files hold it
    return along.astype(float) / leading_gap(runs)


def peak_of(
    runs: xr.Dataset, rom: Rom, k: int, harmonics: Iterable[int] | None = None
) -> Peak | None:
    """``Responses.near_f1`` of a sweep, whatever lasts."""
    return Responses.of(runs, rom).near_f1(k, partial(along_order, runs), harmonics)


def rise(speeds: NDArray[np.float64], amplitudes: NDArray[np.float64]) -> float:
    """Relative rise from the middle of three speeds to the top of the resonance through them.

    Of a linear resonance 1/A^2 is quadratic over the speed near its top: its least value between
    the outer speeds is the top. Where the response falls from one motion to another there is none:
    it then rises by no more than on the other side. Inf where one of them is not known.
    """
    if not np.isfinite(amplitudes).all():
        return inf
    low, _, high = over = np.maximum(amplitudes / amplitudes[1], 1e-3)
    x = (speeds - speeds[1]) / np.ptp(speeds)
    a, b, _ = np.polyfit(x, over**-2, 2)
    top = np.clip(-b / (2 * a), x[0], x[2]) if a > 0 else 0.0
    least = 1 + b * top + a * top**2
    found = 1 - max(low, high) if least <= 0 else least**-0.5 - 1
    return float(max(found, low - 1, high - 1))
