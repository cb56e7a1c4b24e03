"""A sweep in the figures' units: speeds over f1(0), lengths over the gap g at xi = 1/16."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.signal import find_peaks

from rom.model import Rom
from simulate.dataset import load, scene_of
from simulate.law import Law
from simulate.observables import (
    Peak,
    leading_gap,
    leading_wear,
    order_amplitude,
    peak_along_order,
)
from simulate.scene import Contact
from simulate.status import WITH_RESULT
from simulate.twin import SENSITIVE_FROM
from workflow.figures.curve import Curve

ORDERS = range(3, 11)  # engine orders searched for peaks; beyond, a sweep hardly resolves them
NEIGHBOURS = (-2, 2)  # orders that a peak's own order outdoes
SYMBOLS = {"sigma_Y": r"\sigma_Y"}  # of a law's numbers, where they are not their names
CLEAR_HEIGHT = 0.1  # gaps; smaller peaks are left unmarked
END_HEIGHT = 1.0  # gaps; a rise that the sweep ends on is marked from here
# Speeds over the crossing at which a peak may lie: contact stiffens, a tangential force may soften
STIFFENED, SOFTENED, HIGHEST = 0.97, 0.93, 1.4
CLEAR_PROMINENCE = 0.5  # of the height; what falls off less on either side is no peak


@dataclass(frozen=True)
class Response:
    """One sweep: u_r at xi = 1/16, wear of the chord's leading eighth; None if not recorded."""

    label: str  # what sets the scene apart
    speeds: NDArray[np.float64]  # (speeds,), over f1(0), ascending
    status: NDArray[np.str_]  # (speeds,), how each run ended
    departure: dict[str, NDArray[np.float64]]  # (speeds,) of each observable; empty without twins
    curve: Curve
    orders: NDArray[np.float64] | None  # (bins,), engine order
    spectrum: NDArray[np.float64] | None  # (speeds, bins), u_r over gap; nan where a run failed
    wear: NDArray[np.float64] | None  # (speeds, nu), worn depth over gap, rods at 2 pi j / nu
    casing: NDArray[np.float64]  # (361,), inward distortion over gap, every degree
    lowest: float  # of the crossing: where a peak may lie

    @property
    def has_result(self) -> NDArray[np.bool_]:
        """Which runs (speeds,) have a result; a sensitive one is one of many."""
        return np.isin(self.status, WITH_RESULT)

    def sensitive(self, observable: str) -> NDArray[np.bool_]:
        """At which speeds (speeds,) the result cannot be predicted in this observable."""
        departure = self.departure.get(observable, np.zeros(len(self.speeds)))
        return self.has_result & (departure > SENSITIVE_FROM)

    def sensitive_at(self, index: int) -> list[str]:
        """Observables that cannot be predicted at the speed with this index."""
        return [name for name in self.departure if self.sensitive(name)[index]]

    def along(self, k: int) -> NDArray[np.float64]:
        """Amplitude (speeds,) along engine order ``k``, over gap; nan where a run failed."""
        return order_amplitude(self.spectrum, self.orders, k)

    def peak(self, k: int) -> Peak | None:
        """Largest response along engine order ``k`` near f1, in this class's units."""
        if self.spectrum is None:
            return None
        window = self.lowest, HIGHEST
        return peak_along_order(self.speeds, self.along(k), k, self.curve.crossing(k), window)

    def at_end(self, peak: Peak) -> bool:
        """Whether the response still grows at the first or last speed: no peak was seen."""
        return peak.index in (0, len(self.speeds) - 1)

    def is_clear(self, peak: Peak) -> bool:
        """Whether the peak stands out along its order, on both sides, and is no sideband.

        The casing's two diameters couple k with k - 2 and k + 2: the strongest is the peak.
        """
        along = np.nan_to_num(self.along(peak.k))
        height, prominence = CLEAR_HEIGHT, CLEAR_PROMINENCE * peak.amplitude
        if peak.index not in find_peaks(along, height=height, prominence=prominence)[0]:
            return False
        beside = [self.along(peak.k + step)[peak.index] for step in NEIGHBOURS]
        return peak.amplitude >= max(beside)

    def peaks(self) -> list[Peak]:
        """Peaks to mark: clear ones, and those the sweep ends on."""
        found = [peak for k in ORDERS if (peak := self.peak(k)) is not None]
        return [p for p in found if self.is_clear(p) or self._cut(p)]

    def _cut(self, peak: Peak) -> bool:
        return self.at_end(peak) and peak.amplitude >= END_HEIGHT


def read_response(sweep: str | Path, rom: str | Path) -> Response:
    """Read the sweep of one scene, and f1(Omega) of the reduced model it was run on."""
    return response(load(sweep), Rom.load(rom))


def response(sweep: xr.Dataset, rom: Rom) -> Response:
    """``sweep`` in the figures' units."""
    scene, gap = scene_of(sweep), leading_gap(sweep)
    spectrum, orders = sweep.get("spectrum"), None
    if spectrum is not None:
        orders = np.arange(spectrum.sizes["bin"]) / scene.record.spectrum_rounds
    return Response(
        label=_label(scene.liner.law) + _of_tip(scene.contact),
        speeds=sweep["speed_over_f1"].values,
        status=sweep["status"].values,
        departure=_departure(sweep),
        curve=Curve.of(rom),
        orders=orders,
        spectrum=None if spectrum is None else spectrum.values / gap,
        wear=leading_wear(sweep) / gap if "wear" in sweep else None,
        casing=scene.casing.inward(np.radians(np.arange(361)), gap) / gap,
        lowest=SOFTENED if scene.contact.tangential else STIFFENED,
    )


def _label(law: Law) -> str:
    """The liner's law with its numbers, in their own unit."""
    numbers = law.model_dump(exclude={"kind", "unit_Pa"})
    listed = [f"${SYMBOLS.get(name, name)}$ = {value:g}" for name, value in numbers.items()]
    return ", ".join([law.kind, *listed]) if listed else f"liner: {law.kind}"


def _of_tip(contact: Contact) -> str:
    """What of the tip sets the scene apart."""
    if contact.profile is None:
        return ""
    force = "with" if contact.tangential else "without"
    return f",\ntip tilted by {contact.profile.tilt:g}, {force} tangential force"


def _departure(sweep: xr.Dataset) -> dict[str, NDArray[np.float64]]:
    """Departures of the twins; without these, the errors of runs that missed their accuracy."""
    if "departure" in sweep:
        found = sweep["departure"]
    elif "error" in sweep:
        found = sweep["error"].where(sweep["status"] == "sensitive", 0.0)
    else:
        return {}
    return {str(name): found.sel(observable=name).values for name in sweep["observable"].values}
