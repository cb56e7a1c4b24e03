"""``accuracy``: step and density that meet a relative error, and what each run errs by.

Piecewise-exact errs in contact with the step, and rods with their width squared (both measured:
``./run snakemake trade``). So a companion of four times the step and half the rods has four times
the error, and is off by three errors of the run that it stands beside. A pilot on the hardest
speeds chooses step and density from such changes, and looks again at what it chose; then each run
of the sweep has a companion; where that says more than was asked, a closer one of twice the step,
then shorter steps; and it is `sensitive` where these do not help. Source: Roache 1994.
"""

import json
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from itertools import count
from math import ceil, sqrt
from pathlib import Path
from typing import Any, Self

import numpy as np
import xarray as xr

from rom.model import Rom
from simulate.apart import Run, departures
from simulate.run import Outcome, SceneError, Setup, check_scene, edge_slope, march, prepare
from simulate.scene import Scene

LONGER = 4  # steps of a companion
WIDER = 2  # rods of a companion
DRAFT_STEPS, LEAST_STEPS = 2048, 512  # per round
DRAFT_LENGTH = 1.5  # of a footprint, rods
SEEN = 0.1  # of the gap: what the tip's edge falls by over a rod of a draft
DRAFTED, HARDEST = 8, 2  # speeds, of at least three times as many
GROWTH = 4  # from one try to the next: errors go as they should only where they are small
AIM = 0.95  # of what is asked: other speeds may be as hard
STEP_SHARE = 0.9  # of the error, the rest is the density's: rods cost less than steps
LEAST_SAMPLES = 64  # per round, as of every record
TRIES, AGAIN, MOST_FINER = 5, 2, 2  # a pilot's, a run's, and how much finer these
CANDIDATES, LARGEST_Q = 10, 8
SETTLES = 0.25  # least power of the step that an error goes with; 1 where steps are small
MOST_STEPS, MOST_RODS = 2**20, 2**21  # per round


@dataclass(frozen=True)
class Within:
    """A run, and its relative error in each observable."""

    setup: Setup
    outcome: Outcome
    errors: dict[str, float]

    @property
    def worst(self) -> float:
        """Largest error; inf where run and companion end differently."""
        return max(self.errors.values())


@dataclass(frozen=True)
class Choice:
    """What a pilot has chosen, and why."""

    accuracy: float
    steps_per_round: int
    rods_per_round: int
    basis_error: float  # relative, of the reduced model itself, from its check
    speeds: list[float]  # rad/s, of the pilot
    expected: float  # relative error there, from longer steps and wider rods
    observed: dict[str, float]  # largest error there, by observable, after the choice
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


def with_settings(scene: Scene, steps: int, rods: int) -> Scene:
    """The scene, marched piecewise-exact with ``steps`` and ``rods`` per round."""
    return scene.changed(
        accuracy=None,
        integrator={"scheme": "piecewise-exact", "steps_per_round": steps},
        liner__rods_per_round=rods,
    )


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
    steps = _multiple(scene, DRAFT_STEPS)
    rods = _rods(_draft_rods(scene, rom), steps)
    check_scene(with_settings(scene, steps, rods), rom)
    drafts = _hardest(scene, rom, steps, rods)
    of_step = _error(draft.worst for draft in drafts)
    of_rods = _error([_rods_apart(scene, rom, drafts[-1])])
    runs = {draft.setup.Omega: draft for draft in drafts}
    for _ in range(TRIES):
        finer, denser = _finer(scene, steps, of_step), _denser(scene, rods, of_rods)
        denser = _rods(denser, finer)
        growth = finer / steps
        of_step, of_rods = of_step / growth, of_rods * (rods / denser) ** 2
        steps, rods, expected = finer, denser, of_step + of_rods
        before, runs = runs, {Omega: _beside(scene, rom, Omega, steps, rods) for Omega in runs}
        found = _settling(before, runs, growth)
        if found <= scene.accuracy or steps >= MOST_STEPS:
            break
        share = of_step / expected if expected > 0 else 1.0
        of_step, of_rods = found * share, found * (1 - share)
    observed = {
        name: max(run.errors[name] for run in runs.values()) for name in scene.record.observables
    }
    speeds = list(runs)
    return Choice(scene.accuracy, steps, rods, basis_error, speeds, expected, observed, runs)


def march_within(scene: Scene, rom: Rom, Omega: float, choice: Choice) -> Within:
    """March at ``Omega`` (rad/s), at shorter steps where needed; `sensitive` where not met."""
    run = choice.runs.get(Omega)
    run = run or _beside(scene, rom, Omega, choice.steps_per_round, choice.rods_per_round)
    if run.worst > choice.accuracy:
        run = _closer(scene, rom, run)
    for _ in range(AGAIN):
        if run.worst <= choice.accuracy:
            return run
        finer = min(run.worst / choice.accuracy, MOST_FINER) / AIM
        steps = _multiple(scene, finer * run.setup.steps)
        run = _beside(scene, rom, Omega, steps, choice.rods_per_round)
    if run.outcome.status == "ok" and not run.worst <= choice.accuracy:
        return replace(run, outcome=replace(run.outcome, status="sensitive"))
    return run


def _hardest(scene: Scene, rom: Rom, steps: int, rods: int) -> list[Within]:
    """Drafts at those of the scene's speeds where they err most by their step."""
    speeds = scene.speeds.omega(rom.f1)
    most = min(DRAFTED, max(len(speeds) // 3, HARDEST))
    drafted = speeds[np.unique(np.linspace(0, len(speeds) - 1, most).round().astype(int))]
    drafts = [_beside(scene, rom, Omega, steps, rods, wider=1) for Omega in drafted]
    return sorted(drafts, key=lambda draft: draft.worst)[-HARDEST:]


def _settling(before: dict[float, Within], now: dict[float, Within], growth: float) -> float:
    """Largest error where ``growth`` times the steps made it less: nothing settles chaos."""
    least = growth**SETTLES if growth > 1 else 0.0
    return _error([run.worst for k, run in now.items() if run.worst * least <= before[k].worst])


def _beside(
    scene: Scene, rom: Rom, Omega: float, steps: int, rods: int, wider: int = WIDER
) -> Within:
    """A run, and its errors by a companion."""
    setup, run = _march(scene, rom, Omega, steps, rods)
    _, other = _march(scene, rom, Omega, steps // LONGER, _odd(rods // wider))
    return _within(setup, run, other, LONGER)


def _closer(scene: Scene, rom: Rom, run: Within) -> Within:
    """The run, and its errors by a companion of twice the step; its rods err by the rest."""
    steps, rods = run.setup.steps // 2, run.setup.strips.d.size
    _, other = _march(scene, rom, run.setup.Omega, steps, rods)
    return _within(run.setup, Run(scene.record, run.outcome), other, 1 + STEP_SHARE)


def _rods_apart(scene: Scene, rom: Rom, draft: Within) -> float:
    """Error of a draft by its rods alone."""
    steps, rods = draft.setup.steps, draft.setup.strips.d.size
    _, other = _march(scene, rom, draft.setup.Omega, steps, _odd(rods // WIDER))
    run = Run(scene.record, draft.outcome)
    return _within(draft.setup, run, other, WIDER**2).worst


def _within(setup: Setup, run: Run, other: Run, times: float) -> Within:
    """``other`` has ``times`` the errors of ``run``."""
    found = departures(_judged(run), _judged(other))
    errors = {name: _no_nan(value) / (times - 1) for name, value in found.items()}
    return Within(setup, run.outcome, errors)


def _judged(run: Run) -> Run:
    """The run whose numbers count, though its steps have lost much: its errors will tell."""
    lossy = run.outcome.status == "inaccurate"
    return Run(run.record, replace(run.outcome, status="ok")) if lossy else run


def _no_nan(value: float) -> float:
    """Runs that both end early, for the same reason, have no result that could err."""
    return 0.0 if np.isnan(value) else value


def _march(scene: Scene, rom: Rom, Omega: float, steps: int, rods: int) -> tuple[Setup, Run]:
    """A run with as many samples as its steps can fill, but no more than are asked for."""
    case = with_settings(scene, steps, rods)
    if steps % case.record.samples_per_round:
        samples = case.record.samples_per_round // LONGER
        case = case.changed(record__samples_per_round=samples)
    setup = prepare(case, rom, Omega)
    return setup, Run(case.record, march(case, setup))


def _multiple(scene: Scene, steps: float) -> int:
    """``steps`` per round or a few more, that it and its companion can sample."""
    samples = scene.record.samples_per_round
    thinned = samples % LONGER == 0 and samples // LONGER >= LEAST_SAMPLES
    unit = samples if thinned else LONGER * samples
    return ceil(steps / unit) * unit


def _finer(scene: Scene, steps: int, error: float) -> int:
    """Steps per round at which an error that goes with the step is its share of what is asked."""
    finer = min(error / (AIM * STEP_SHARE * scene.accuracy), GROWTH)
    return _multiple(scene, min(max(finer * steps, LEAST_STEPS), MOST_STEPS))


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


def _rods(least: int, steps: int) -> int:
    """A number of rods, up to a fifth above ``least``, that steps do not meet alike.

    Where a step passes near p/q of a rod, every q-th meets it alike, and errors go neither with
    the step nor with the rods. Of some primes the one whose ratio is worst to approximate.
    """
    tried = np.linspace(least, 1.2 * least, CANDIDATES)
    return max((_prime(ceil(rods)) for rods in tried), key=lambda rods: _unlike(rods / steps))


def _unlike(advance: float) -> float:
    """How badly p/q approximates the rods that a step and its companion's pass: 0 not at all."""
    q = np.arange(1, LARGEST_Q + 1)
    x = np.outer([1, LONGER / WIDER], q) * advance
    return float((q * abs(x - x.round())).min())


def _prime(least: int) -> int:
    """The first prime from ``least``: no step of a power of two meets all rods alike."""
    return next(n for n in count(max(least, 3)) if all(n % k for k in range(2, int(sqrt(n)) + 1)))


def _odd(rods: int) -> int:
    return rods | 1


def _error(errors: Iterable[float]) -> float:
    """The largest, 1 where runs end differently; 0 of none."""
    return max((min(error, 1.0) for error in errors), default=0.0)
