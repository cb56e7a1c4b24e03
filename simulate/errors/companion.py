"""Error of a run, estimated from coarser companion runs (Roache 1994).

In contact, the error of piecewise-exact is of order two in the step and in the widths of rods and
strips; ``rom.coarser`` gives that of the reduced model (all measured: ``./run snakemake trade``).
So a companion with twice the step, half the rods, half the strips and the coarser model has four
times the error: it differs from the run by three times the run's error; a safety factor of 1.25
covers errors whose order is a little lower.

A companion of four times the step costs half of that, but is often too coarse for any order. How
many times the error its difference is changes little from speed to speed: it is measured against
the companion of twice the step at a few speeds.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil, inf, isnan
from statistics import geometric_mean
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rom.coarser import coarser
from rom.model import Rom
from simulate.errors.neighbour import Neighbour
from simulate.errors.observables import Run, differences
from simulate.marching.run import Outcome, march
from simulate.marching.setup import Setup, prepare
from simulate.marching.status import TO_THE_END
from simulate.scene import Scene

STEP_RATIO, QUICK_STEP_RATIO = 2, 4  # steps of the two companions over that of the run
WIDTH_RATIO = 2  # widths of their rods and strips over those of the run
SAFETY = 1.25  # of an estimated error
TIMES = (STEP_RATIO**2 - 1) / SAFETY  # difference from a companion of twice the step, in errors
LEAST_SAMPLES = 64  # per round, as in ``Record``


@dataclass(frozen=True)
class Fineness:
    """Steps, rods and strips of a run."""

    steps: int  # per round
    rods: int  # per round
    strips: int

    def with_longer_step(self, ratio: int = STEP_RATIO) -> "Fineness":
        """Those of a companion with a step ``ratio`` times longer and half the rods."""
        return replace(self, steps=self.steps // ratio, rods=(self.rods // WIDTH_RATIO) | 1)

    def with_fewer_strips(self) -> "Fineness":
        """Those of a companion with half the strips."""
        return replace(self, strips=max(self.strips // WIDTH_RATIO, 1))


class Parts(NamedTuple):
    """Relative error of a run, largest of all observables, by its cause."""

    step: float  # with the rods, which go with the step
    strips: float
    model: float  # patches and natural modes


@dataclass(frozen=True)
class Models:
    """A reduced model, and the coarser one on which companions are marched."""

    own: Rom
    coarse: Rom
    T: NDArray[np.float64]  # (n, n of coarse): reduced displacements of own from those of coarse

    @classmethod
    def of(cls, rom: Rom) -> "Models":
        """The model ``rom`` with the coarser one made from it.

        Raises
        ------
        rom.model.RomError
            When no coarser model can be made from it.
        """
        return cls(rom, *coarser(rom))


@dataclass(frozen=True)
class RunWithError:
    """A run, and its estimated relative error in each observable."""

    setup: Setup
    outcome: Outcome
    errors: dict[str, float]

    @property
    def largest_error(self) -> float:
        """Largest error of all observables; inf where run and companion end differently."""
        return max(self.errors.values())

    @property
    def fineness(self) -> Fineness:
        """Steps, rods and strips that it was marched with."""
        strips = self.setup.strips
        return Fineness(self.setup.steps, strips.d.size, strips.g0.size)


def with_settings(scene: Scene, fineness: Fineness) -> Scene:
    """The scene, marched piecewise-exact with the steps, rods and strips of ``fineness``.

    With fewer samples if the steps are no multiple of all of them.
    """
    samples = scene.record.samples_per_round
    return scene.but(
        accuracy=None,
        integrator={"scheme": "piecewise-exact", "steps_per_round": fineness.steps},
        liner__rods_per_round=fineness.rods,
        liner__strips=fineness.strips,
        record__samples_per_round=samples // (QUICK_STEP_RATIO if fineness.steps % samples else 1),
    )


def march_with_error(
    scene: Scene,
    models: Models,
    Omega: float,
    fineness: Fineness,
    times: dict[str, float] | None = None,
) -> RunWithError:
    """March at ``Omega`` (rad/s); errors from a companion coarser in step, rods, strips, model.

    With ``times`` from a companion of four times the step, whose difference is so many errors, by
    observable; without, of twice the step.
    """
    setup, run = _march(scene, models.own, Omega, fineness)
    marched = RunWithError(setup, run.outcome, {})
    if times is None:
        return refine_estimate(scene, models, marched)
    found = _differences(scene, models, marched, QUICK_STEP_RATIO)
    return replace(marched, errors={name: d / times[name] for name, d in found.items()})


def refine_estimate(scene: Scene, models: Models, run: RunWithError) -> RunWithError:
    """The run with errors from a companion of twice the step."""
    found = _differences(scene, models, run, STEP_RATIO)
    return replace(run, errors={name: d / TIMES for name, d in found.items()})


def quick_times(scene: Scene, models: Models, runs: Iterable[RunWithError]) -> dict[str, float]:
    """Difference from a companion of four times the step, in errors of the run, by observable.

    The geometric mean over the ``runs``; at least that from a companion of twice the step.
    """
    ratios: dict[str, list[float]] = {name: [] for name in scene.record.observables}
    for run in runs:
        for name, d in _differences(scene, models, run, QUICK_STEP_RATIO).items():
            if 0 < d < inf and 0 < run.errors[name] < inf:
                ratios[name].append(d / run.errors[name])
    return {name: max(geometric_mean(r), TIMES) if r else TIMES for name, r in ratios.items()}


def _differences(
    scene: Scene, models: Models, run: RunWithError, step_ratio: int
) -> dict[str, float]:
    """Differences of a run from its companion with a step ``step_ratio`` times longer."""
    companion = run.fineness.with_longer_step(step_ratio).with_fewer_strips()
    other = _march_coarse(scene, models, run.setup.Omega, companion)
    return _departures(Run(scene.record, run.outcome), other)


def companion(scene: Scene, rom: Rom, steps: int) -> Neighbour:
    """The companion of a run of so many ``steps`` per round, on the coarser model.

    Its numbers differ by ``TIMES`` their error.

    Raises
    ------
    rom.model.RomError
        When no coarser model can be made.
    """
    models, liner = Models.of(rom), scene.liner
    fineness = Fineness(steps, liner.rods_per_round, liner.m).with_longer_step()
    return Neighbour(
        "companion",
        scene=lambda of: with_settings(of, fineness.with_fewer_strips()),
        rom=lambda _: models.coarse,
    )


def error_by_part(scene: Scene, models: Models, run: RunWithError) -> Parts:
    """Error of a run due to its step, to its strips and to its model.

    From runs that are coarser in its step, then in its strips, then in its model, too.
    """
    Omega, longer = run.setup.Omega, run.fineness.with_longer_step()
    wider = longer.with_fewer_strips()
    runs = (
        Run(scene.record, run.outcome),
        _march(scene, models.own, Omega, longer)[1],
        _march(scene, models.own, Omega, wider)[1],
        _march_coarse(scene, models, Omega, wider),
    )
    errors = (max(_departures(*pair).values()) / TIMES for pair in pairwise(runs))
    return Parts(*(min(error, 1.0) for error in errors))  # inf: runs that end differently


def multiple_of_samples(scene: Scene, steps: float) -> int:
    """Least steps per round from ``steps`` on that the samples of run and companion divide."""
    samples = scene.record.samples_per_round
    thinned = samples % QUICK_STEP_RATIO == 0 and samples // QUICK_STEP_RATIO >= LEAST_SAMPLES
    unit = samples if thinned else QUICK_STEP_RATIO * samples
    return ceil(steps / unit) * unit


def _departures(run: Run, other: Run) -> dict[str, float]:
    """Differences of two runs by observable; 0 where both end early with the same status.

    Those that are `inaccurate` are compared: their error is estimated here.
    """
    found = differences(run, other, TO_THE_END)
    return {name: 0.0 if isnan(value) else value for name, value in found.items()}


def _march(scene: Scene, rom: Rom, Omega: float, fineness: Fineness) -> tuple[Setup, Run]:
    case = with_settings(scene, fineness)
    setup = prepare(case, rom, Omega)
    return setup, Run(case.record, march(case, setup))


def _march_coarse(scene: Scene, models: Models, Omega: float, fineness: Fineness) -> Run:
    """March on the coarser model; the states are those of the run's own model."""
    _, run = _march(scene, models.coarse, Omega, fineness)
    outcome = replace(run.outcome, states=run.outcome.states @ models.T.T)
    return run._replace(outcome=outcome)
