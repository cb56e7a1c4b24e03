"""``accuracy``: step and density that meet a relative error, and what each run errs by.

A pilot on the hardest speeds chooses step and density from what companions say there
(``simulate.companion``), and looks again at what it chose; then each run of the sweep has a
companion; where that says more than was asked, a closer one of twice the step, then shorter steps;
and it is `sensitive` where these do not help.
"""

import json
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from math import ceil, isfinite, sqrt
from pathlib import Path
from typing import Any, Self

import numpy as np
import xarray as xr

from rom.model import Rom
from simulate.companion import (
    Within,
    beside,
    closer,
    multiple,
    rods_apart,
    unlike_steps,
    with_settings,
)
from simulate.run import SceneError, check_scene, edge_slope
from simulate.scene import Scene

DRAFT_STEPS, LEAST_STEPS = 2048, 512  # per round
DRAFT_LENGTH = 1.5  # of a footprint, rods
SEEN = 0.1  # of the gap: what the tip's edge falls by over a rod of a draft
DRAFTED, HARDEST = 8, 2  # speeds, of at least three times as many
STEP_SHARE = 0.9  # of the error, the rest is the density's: rods cost less than steps
GROWTH = 4  # from one try to the next: errors go as they should only where they are small
AIM = 0.95  # of what is asked: other speeds may be as hard
TRIES, AGAIN, MOST_FINER = 5, 2, 2  # a pilot's, a run's, and how much finer these
SETTLES = 0.25  # least power of the step that an error goes with; 1 where steps are small
MOST_STEPS, MOST_RODS = 2**20, 2**21  # per round


@dataclass(frozen=True)
class Choice:
    """What a pilot has chosen, and why."""

    accuracy: float
    steps_per_round: int
    rods_per_round: int
    basis_error: float  # relative, of the reduced model itself, from its check
    speeds: list[float]  # rad/s, of the pilot
    expected: float  # relative error there, from longer steps and wider rods
    # largest error there, by observable, after the choice; None where runs end differently
    observed: dict[str, float | None]
    runs: dict[float, Within] = field(default_factory=dict, repr=False)  # by speed

    def plain(self) -> dict[str, Any]:
        """All but the runs, for files."""
        return {name: value for name, value in vars(self).items() if name != "runs"}

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read what ``plain`` gives, as JSON."""
        return cls(**json.loads(Path(path).read_text()))

    def scene(self, scene: Scene) -> Scene:
        """The scene with the settings that were chosen."""
        return with_settings(scene, self.steps_per_round, self.rods_per_round)


def basis_error(check: str | Path) -> float:
    """Largest relative error of a reduced model, frequencies and tip compliances, in its check."""
    with xr.open_dataset(check, engine="h5netcdf") as found:
        frequencies = abs(found["reduced"] / found["full"] - 1).max()
        compliance = abs(found["compliance_error"]).max()
        return float(max(frequencies, compliance))


def require_basis(accuracy: float, error: float) -> None:
    """Refuse an accuracy that the reduced model itself does not have.

    Raises
    ------
    SceneError
        With its error and the remedy.
    """
    if error > accuracy:
        raise SceneError(
            f"accuracy: {accuracy:g}: the reduced model errs by {error:.3g}; allowed from that, or "
            "raise basis.natural_modes and basis.fixed_interface_modes in the blade's file"
        )


def choose(scene: Scene, rom: Rom, basis_error: float) -> Choice:
    """Choose step and density for ``scene.accuracy`` on its hardest speeds.

    Raises
    ------
    SceneError
        When the scene does not fit the reduced model, or that model errs by more than is asked.
    """
    require_basis(scene.accuracy, basis_error)
    steps = multiple(scene, DRAFT_STEPS)
    rods = unlike_steps(_draft_rods(scene, rom), steps)
    check_scene(with_settings(scene, steps, rods), rom)
    drafts = _hardest(scene, rom, steps, rods)
    of_step = _error(draft.worst for draft in drafts)
    of_rods = _error([rods_apart(scene, rom, drafts[-1])])
    runs = {draft.setup.Omega: draft for draft in drafts}
    for _ in range(TRIES):
        finer, denser = _finer(scene, steps, of_step), _denser(scene, rods, of_rods)
        denser = unlike_steps(denser, finer)
        growth = finer / steps
        of_step, of_rods = of_step / growth, of_rods * (rods / denser) ** 2
        steps, rods, expected = finer, denser, of_step + of_rods
        before, runs = runs, {Omega: beside(scene, rom, Omega, steps, rods) for Omega in runs}
        found = _settling(before, runs, growth)
        if found <= scene.accuracy or steps >= MOST_STEPS:
            break
        share = of_step / expected if expected > 0 else 1.0
        of_step, of_rods = found * share, found * (1 - share)
    observed = {name: _observed(runs.values(), name) for name in scene.record.observables}
    speeds = list(runs)
    return Choice(scene.accuracy, steps, rods, basis_error, speeds, expected, observed, runs)


def march_within(scene: Scene, rom: Rom, Omega: float, choice: Choice) -> Within:
    """March at ``Omega`` (rad/s), at shorter steps where needed; `sensitive` where not met."""
    run = choice.runs.get(Omega)
    run = run or beside(scene, rom, Omega, choice.steps_per_round, choice.rods_per_round)
    if run.worst > choice.accuracy:
        run = closer(scene, rom, run)
    for _ in range(AGAIN):
        if run.worst <= choice.accuracy:
            return run
        finer = min(run.worst / choice.accuracy, MOST_FINER) / AIM
        steps = multiple(scene, finer * run.setup.steps)
        run = beside(scene, rom, Omega, steps, choice.rods_per_round)
    if run.outcome.status == "ok" and not run.worst <= choice.accuracy:
        return replace(run, outcome=replace(run.outcome, status="sensitive"))
    return run


def _hardest(scene: Scene, rom: Rom, steps: int, rods: int) -> list[Within]:
    """Drafts at those of the scene's speeds where they err most by their step."""
    speeds = scene.speeds.omega(rom.f1)
    most = min(DRAFTED, max(len(speeds) // 3, HARDEST))
    drafted = speeds[np.unique(np.linspace(0, len(speeds) - 1, most).round().astype(int))]
    drafts = [beside(scene, rom, Omega, steps, rods, wider=1) for Omega in drafted]
    return sorted(drafts, key=lambda draft: draft.worst)[-HARDEST:]


def _settling(before: dict[float, Within], now: dict[float, Within], growth: float) -> float:
    """Largest error where ``growth`` times the steps made it less: nothing settles chaos."""
    least = growth**SETTLES if growth > 1 else 0.0
    return _error([run.worst for k, run in now.items() if run.worst * least <= before[k].worst])


def _finer(scene: Scene, steps: int, error: float) -> int:
    """Steps per round at which an error that goes with the step is its share of what is asked."""
    finer = min(error / (AIM * STEP_SHARE * scene.accuracy), GROWTH)
    return multiple(scene, min(max(finer * steps, LEAST_STEPS), MOST_STEPS))


def _denser(scene: Scene, rods: int, error: float) -> int:
    """Rods per round at which an error that goes with their square is the rest of it."""
    denser = min(sqrt(error / (AIM * (1 - STEP_SHARE) * scene.accuracy)), GROWTH)
    return ceil(min(max(denser, 1.0) * rods, MOST_RODS))


def _draft_rods(scene: Scene, rom: Rom) -> int:
    """Rods of a draft: enough for the footprint, and to see the edge of a tilted tip."""
    around = 2 * np.pi * rom.radius.max()
    gap = scene.clearance.gaps(len(rom.points), rom.span).min()
    edge = around * edge_slope(scene) / (SEEN * gap) if gap > 0 else 0.0
    return ceil(min(max(DRAFT_LENGTH * around / scene.liner.footprint_m, edge), MOST_RODS))


def _observed(runs: Iterable[Within], name: str) -> float | None:
    largest = max(run.errors[name] for run in runs)
    return largest if isfinite(largest) else None


def _error(errors: Iterable[float]) -> float:
    """The largest, 1 where runs end differently; 0 of none."""
    return max((min(error, 1.0) for error in errors), default=0.0)
