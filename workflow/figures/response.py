"""A sweep in the figures' units: speeds over f1(0), lengths over the gap g at xi = 1/16."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rom.model import Rom
from simulate.dataset import load, scene_of
from simulate.law import Law
from simulate.observables import amplitude, leading_gap, leading_wear
from simulate.peaks import Peak, peaks_of
from simulate.scene import Contact
from simulate.status import WITH_RESULT
from simulate.twin import SENSITIVE_FROM
from workflow.figures.curve import frequencies_over_speed

SYMBOLS = {"sigma_Y": r"\sigma_Y"}  # of a law's numbers, where they are not their names


@dataclass(frozen=True)
class Response:
    """One sweep: u_r at xi = 1/16, wear of the chord's leading eighth; None if not recorded."""

    label: str  # what sets the scene apart
    speeds: NDArray[np.float64]  # (speeds,), over f1(0), ascending
    status: NDArray[np.str_]  # (speeds,), how each run ended
    departure: dict[str, NDArray[np.float64]]  # (speeds,) of each observable; empty without twins
    f1: NDArray[np.float64]  # (2, points): speeds, and f1(Omega) there, over f1(0)
    by_order: dict[int, Peak]  # peaks along engine orders
    rounds: int | None  # of the spectrum: bin b is engine order b / rounds
    spectrum: NDArray[np.float64] | None  # (speeds, bins), u_r over gap; nan where a run failed
    wear: NDArray[np.float64] | None  # (speeds, nu), worn depth over gap, rods at 2 pi j / nu
    casing: NDArray[np.float64]  # (361,), inward distortion over gap, every degree

    @property
    def orders(self) -> NDArray[np.float64]:
        """Engine orders (bins,) of the spectrum."""
        return np.arange(self.spectrum.shape[1]) / self.rounds

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
        return amplitude(self.spectrum, self.rounds, k)

    def peak(self, k: int) -> Peak | None:
        """The peak along engine order ``k``; None where no speed near f1 has a result."""
        return self.by_order.get(k)

    @property
    def peaks(self) -> list[Peak]:
        """Peaks to mark."""
        return [peak for peak in self.by_order.values() if peak.told]


def read_response(sweep: str | Path, rom: str | Path) -> Response:
    """Read the sweep of one scene, and f1(Omega) of the reduced model it was run on."""
    return response(load(sweep), Rom.load(rom))


def response(sweep: xr.Dataset, rom: Rom) -> Response:
    """``sweep`` in the figures' units."""
    scene, gap = scene_of(sweep), leading_gap(sweep)
    speeds, frequencies = frequencies_over_speed(rom, 1)
    spectrum = sweep.get("spectrum")
    return Response(
        label=_label(scene.liner.law) + _of_tip(scene.contact),
        speeds=sweep["speed_over_f1"].values,
        status=sweep["status"].values,
        departure=_departure(sweep),
        f1=np.array([speeds, frequencies[:, 0]]),
        by_order={} if spectrum is None else peaks_of(sweep, rom),
        rounds=scene.record.spectrum_rounds,
        spectrum=None if spectrum is None else spectrum.values / gap,
        wear=leading_wear(sweep) / gap if "wear" in sweep else None,
        casing=scene.casing.inward(np.radians(np.arange(361)), gap) / gap,
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
