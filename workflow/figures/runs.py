"""The runs of a sweep one by one, in the figures' units; how far two of them differ."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from simulate.dataset import load, scene_of
from simulate.observables import leading_gap, leading_wear
from simulate.scene import LEADING, Scene
from simulate.status import WITH_RESULT


@dataclass(frozen=True)
class Run:
    """One speed of a sweep; a field that the scene does not record is None."""

    speed: float  # over f1(0)
    status: str  # how it ended
    nu: int  # rods per round
    step_share: float  # time step over the stability limit of central differences with contact
    samples: int  # per round, of the displacement
    # over gap g: worn depth (nu,) of the chord's leading eighth, rods at 2 pi j / nu, and
    # displacement (rounds * samples,) at xi = 1/16 from the start
    wear: NDArray[np.float64] | None
    u_r: NDArray[np.float64] | None

    @property
    def has_result(self) -> bool:
        """Whether its numbers are results."""
        return self.status in WITH_RESULT

    @property
    def rounds(self) -> int:
        """Rounds of its displacement."""
        return len(self.u_r) // self.samples

    @property
    def time(self) -> NDArray[np.float64]:
        """When each sample is taken, in rounds since the start; the first is after one sample."""
        return np.arange(1, len(self.u_r) + 1) / self.samples


def read_runs(path: str | Path) -> tuple[Run, ...]:
    """All runs of the sweep in ``path``, speeds as in the file."""
    sweep = load(path)
    scene = scene_of(sweep)
    return tuple(run_of(sweep.isel(speed=i), scene) for i in range(sweep.sizes["speed"]))


def run_of(at_speed: xr.Dataset, scene: Scene) -> Run:
    """Run at one speed of a sweep of ``scene``."""
    gap, chord = leading_gap(at_speed), scene.record.chord
    u_r = at_speed["history"].values[chord.index(LEADING)] / gap if LEADING in chord else None
    return Run(
        speed=float(at_speed["speed_over_f1"]),
        status=str(at_speed["status"].values),
        nu=scene.liner.rods_per_round,
        step_share=float(at_speed["step"] / at_speed["step_limit"]),
        samples=scene.record.samples_per_round,
        wear=leading_wear(at_speed) / gap if "wear" in at_speed else None,
        u_r=u_r,
    )


def percent(share: float) -> str:
    """``share`` in percent, one digit after the point or, of what is less than that, one at all."""
    return f"{100 * share:.1f} %" if share >= 1e-3 or share == 0 else f"{100 * share:.0e} %"
