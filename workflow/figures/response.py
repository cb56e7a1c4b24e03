"""A sweep in the figures' units: speeds over f1(0), lengths over the gap g at xi = 1/16."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Self

import numpy as np
import xarray as xr
from matplotlib.ticker import EngFormatter
from numpy.typing import NDArray

from geometry.blade import ORDERS
from rom.model import Rom
from simulate.marching import SENSITIVE_FROM, WITH_RESULT
from simulate.scene import LEADING, Scene
from simulate.signals import leading_gap, leading_wear
from simulate.sweeps.dataset import load, scene_of
from simulate.sweeps.peak import Peak, Responses, peak_of, reported
from workflow.figures import style, units
from workflow.markdown import rounded

SYMBOLS = {"sigma_Y": r"\sigma_Y"}  # of parameters whose symbol differs from their name


@dataclass(frozen=True)
class Response:
    """One sweep, and its reduced model, which is needed for peaks alone."""

    sweep: xr.Dataset
    rom: Rom | None = None

    @classmethod
    def read(cls, sweep: str | Path, rom: str | Path | None = None) -> Self:
        """Read the sweep of one scene, and a reduced model."""
        return cls(load(sweep, leave=["strained"]), Rom.load(rom) if rom else None)

    @cached_property
    def scene(self) -> Scene:
        """The scene of the sweep."""
        return scene_of(self.sweep)

    @property
    def speeds(self) -> NDArray[np.float64]:
        """Speeds (speeds,) over f1(0), in the order of the file: ascending in a whole sweep."""
        return self.sweep["speed_over_f1"].values

    @property
    def status(self) -> NDArray[np.str_]:
        """Status (speeds,) of each run."""
        return self.sweep["status"].values

    @property
    def has_result(self) -> NDArray[np.bool_]:
        """Which runs (speeds,) have a result: `ok`, `sensitive`, or `no-contact`, at rest."""
        return np.isin(self.status, WITH_RESULT)

    @property
    def trend(self) -> NDArray[np.str_]:
        """Whether each run (speeds,) is steady; empty where a sweep was made by hand."""
        return self.sweep.get("trend", xr.zeros_like(self.sweep["speed"], str)).values

    @cached_property
    def wear(self) -> NDArray[np.float64]:
        """Worn depth (speeds, nu) of the chord's leading eighth over gap, rods at 2 pi j / nu."""
        return leading_wear(self.sweep) / leading_gap(self.sweep)

    @property
    def u_r(self) -> NDArray[np.float64]:
        """Displacement (speeds, revolutions * samples) at xi = 1/16 over gap, from the start."""
        place = self.scene.record.chord.index(LEADING)
        return self.sweep["history"].values[:, place] / leading_gap(self.sweep)

    @property
    def place(self) -> str:
        """Chord fraction of the displacements, of either edge on a casing that tapers."""
        return rf"{style.PLACE}{' or 15/16' if 'place' in self.sweep else ''}"

    @property
    def spectrum(self) -> NDArray[np.float64]:
        """Amplitude (speeds, bins) of u_r at xi = 1/16 over gap; nan where a run failed."""
        return self.sweep["spectrum"].values / leading_gap(self.sweep)

    @cached_property
    def peaks(self) -> list[Peak]:
        """Peaks that figures mark, speeds ascending."""
        return reported(self.sweep, self.rom)

    @property
    def orders(self) -> list[int]:
        """Engine orders of which peaks are sought, those of the casing and of its side bands.

        As far as the spectrum holds them.
        """
        sought = self.sweep.attrs.get("orders", ORDERS)  # of one, files have a number
        orders = {*map(int, np.atleast_1d(sought)), *self.scene.excites}
        end = (
            self.sweep["spectrum"].shape[1] // self.scene.record.rounds_of_spectrum
            if "spectrum" in self.sweep
            else np.inf
        )
        return sorted(k for k in orders if k < end)

    def of_f1(self, k: int) -> Peak | None:
        """Largest response along an engine order near its crossing with f1, reported or not."""
        return peak_of(self.sweep, self.rom, k)

    def along(self, peak: Peak) -> NDArray[np.float64]:
        """Amplitude (speeds,) over gap along the order of a peak, at its place."""
        return Responses.of(self.sweep, self.rom).series(peak.k, peak.place)

    @property
    def observables(self) -> list[str]:
        """Observables that were compared with a twin or a coarser companion run."""
        return [str(name) for name in self.sweep.get("observable", xr.DataArray([])).values]

    def sensitive(self, observable: str) -> NDArray[np.bool_]:
        """Which runs (speeds,) are sensitive in this observable: it cannot be predicted.

        From the differences of the twins; without twins, from the errors of runs that missed their
        accuracy.
        """
        if observable not in self.observables:
            return np.zeros(len(self.speeds), bool)
        kind = "departure" if "departure" in self.sweep else "error"
        difference = self.sweep[kind].sel(observable=observable).values
        return (self.status == "sensitive") & (difference > SENSITIVE_FROM)

    @property
    def units(self) -> dict[str, tuple[units.Unit, units.Unit]]:
        """By quantity the unit shown first, and that beside it.

        Norms are first where the scene gives its speeds in them, as the paper does; a scene that
        gives them in rad/s is shown in rpm and micrometres.
        """
        return units.both(
            norms=self.scene.speeds.unit == "over_f1",
            f1_Hz=self.rom.f1,
            gap_m=leading_gap(self.sweep),
        )

    @property
    def names(self) -> str:
        """Names of scene and blade."""
        name = self.sweep.attrs.get("name")
        return f"scene {name}, blade {self.scene.blade}" if name else f"blade {self.scene.blade}"

    @property
    def title(self) -> str:
        """Names of scene and blade, and the liner."""
        return f"{self.names}: {liner_and_tip(self.scene)}"


def _symbol(name: str) -> str:
    """Symbol of a parameter in a label; a name of one's own is text, whatever is in it."""
    if name in SYMBOLS or (len(name) == 1 and name.isalpha()):
        return f"${SYMBOLS.get(name, name)}$"
    return name.replace("$", r"\$")


def liner_and_tip(scene: Scene) -> str:
    """The liner's law with its parameters, moduli in Pa, and the tip, for labels."""
    law, contact = scene.liner.law, scene.contact
    moves = ",\ncasing moves" if scene.casing.moves else ""
    if scene.stage:
        moves += f",\n{scene.stage.count} blades: the worst"
    unit = getattr(law, "unit_Pa", None)
    listed = [
        f"{_symbol(name)} = {EngFormatter('Pa')(rounded(unit * x, 3)) if unit else f'{x:g}'}"
        for name, x in law.model_dump(exclude={"kind", "unit_MPa", "unit_Pa"}).items()
        if isinstance(x, int | float)  # no curve, nor what a law of one's own may have
    ]
    label = (", ".join([law.called, *listed]) if listed else f"liner: {law.called}") + moves
    if contact.profile is None:
        return label
    force = "with" if contact.tangential else "without"
    return f"{label},\ntip tilted by {contact.profile.tilt:g}, {force} tangential force"
