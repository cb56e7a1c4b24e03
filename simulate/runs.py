"""Sweeps and single runs from Python: a sweep with its reduced model, one run, the peaks."""

from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path
from typing import Self

import xarray as xr

from geometry.base import RPM, printable
from rom.model import Rom
from simulate.errors.checked import checked
from simulate.marching import Outcome, check_scene
from simulate.scene import Scene
from simulate.sweeps import dataset, over_speeds, peak
from simulate.sweeps.sweep import sweep as swept
from simulate.sweeps.unusual import doubts, warn_of


@dataclass(frozen=True)
class Runs:
    """A sweep with its reduced model; variables of the dataset are attributes: ``runs.wear``.

    >>> runs = sweep(scene, rom)
    >>> runs.save("out.nc")
    >>> Runs.load("out.nc", rom).wear.dims
    ('speed_over_f1', 'strip', 'theta')
    """

    dataset: xr.Dataset
    rom: Rom

    def __getattr__(self, name: str) -> xr.DataArray:
        """A variable or coordinate of the dataset."""
        if name.startswith("_") or name not in self.dataset.variables:
            variables = ", ".join(map(str, self.dataset.variables))
            raise AttributeError(f"{name}: no variable of the sweep; it has {variables}")
        return self.dataset[name]

    def __repr__(self) -> str:
        """Blade, speeds, how the runs ended, and the peaks, a line each."""
        speeds, ends = RPM * self.speed.values, dataset.statuses(self.dataset)
        return "\n".join(
            [
                f"Runs of blade {printable(self.dataset.attrs['blade'])}: {len(speeds)} speeds, "
                f"{speeds.min():.0f} to {speeds.max():.0f} rpm",
                ", ".join(f"{status}: {count}" for status, count in ends.items()),
                dataset.checks(self.dataset),
                *(
                    f"{found.name}: peak at {speeds[found.index]:.0f} rpm, "
                    f"{found.rises_from}, {found.amplitude:.3g} gaps"
                    for found in peak.reported(self.dataset, self.rom)
                ),
            ]
        )

    @property
    def scene(self) -> Scene:
        """The scene that was run."""
        return dataset.scene_of(self.dataset)

    def peaks(self) -> dict[float, peak.Peak]:
        """Response peaks by engine order, as ``peaks``.

        >>> runs = sweep(scene, rom)
        >>> runs.peaks()[4].Omega_c  # over f1(0)
        0.32
        """
        return peaks(self)

    def save(self, path: str | Path) -> None:
        """Write NetCDF; it holds the scene, and a casing given as a function as a table."""
        dataset.save(self.dataset, path)

    @classmethod
    def load(cls, path: str | Path, rom: Rom) -> Self:
        """Read a sweep that was run on ``rom``.

        Raises
        ------
        geometry.base.provenance.ProvenanceError
            When it was run on another reduced model.
        """
        runs = dataset.load(path)
        dataset.require_rom(runs, rom)
        return cls(runs, rom)


def sweep(scene: Scene, rom: Rom, start: Runs | None = None) -> Runs:
    """Run the scene at its speeds, and at more speeds around the peaks it asks for.

    ``start``: the sweep of the scene that its `start` names, from which its runs go on.

    >>> runs = sweep(scene.but(speeds={"over_f1": [0.2, 0.3]}), rom)
    >>> runs.status.values.tolist()
    ['ok', 'ok']

    Raises
    ------
    simulate.marching.setup.SceneError
        When the scene does not fit the reduced model or the step is above its limit.
    """
    return Runs(swept(scene, rom, start=start and start.dataset), rom)


def march(scene: Scene, rom: Rom, Omega: float) -> Outcome:
    """Run the scene at one speed, rad/s.

    >>> outcome = march(scene, rom, 500.0)
    >>> outcome.status, outcome.wear.shape  # strips, rods
    ('ok', (8, 512))

    Raises
    ------
    simulate.marching.setup.SceneError
        As ``sweep``.
    """
    check_scene(scene, rom)
    warn_of(doubts(scene, rom).values())
    alone = [over_speeds.march_one(over_speeds.set_up(scene, rom, Omega))]
    return checked(alone, scene.checked_share)[0][0].outcome


def peaks(runs: Runs) -> dict[float, peak.Peak]:
    """Response peaks of a sweep by engine order: those that figures and tables name.

    A steady line on no integer order is there under f / Omega. Along an order that several modes
    meet this is the highest peak; ``simulate.sweeps.peak.reported`` lists all.

    >>> for k, peak in peaks(sweep(scene, rom)).items():
    ...     print(k, f"{peak.Omega_c:.2f}, {peak.over_crossing:.2f} times the linear crossing")
    4 0.32, 1.03 times the linear crossing
    """
    found = sorted(peak.reported(runs.dataset, runs.rom), key=attrgetter("amplitude"))
    return {of.k: of for of in found if of.k}
