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
from math import ceil, inf
from statistics import geometric_mean
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rom.model import Rom
from simulate.errors.neighbour import Neighbour
from simulate.errors.observables import differences
from simulate.errors.run import Case, Run
from simulate.marching import TO_THE_END, Outcome, Setup, prepare
from simulate.scene import Scene

STEP_RATIO, QUICK_STEP_RATIO = 2, 4  # steps of the two companions over that of the run
WIDTH_RATIO = 2  # widths of their rods and strips over those of the run
SAFETY = 1.25  # of an estimated error
TIMES = (STEP_RATIO**2 - 1) / SAFETY  # difference from a companion of twice the step, in errors
# difference from a run with half the step and widths, in errors; of two runs no order is seen
FINER_TIMES = (1 - 1 / STEP_RATIO**2) / 1.5
LEAST_SAMPLES = 64  # per revolution, as in ``Record``

type Coarser = tuple[Rom, NDArray[np.float64]]  # as ``rom.coarser`` makes it of a model


def _differences(one: Run, other: Run) -> dict[str, float]:
    """Relative differences of two runs, those among them that are `inaccurate`.

    Their error is estimated here. It is 0 where both end early with the same status.
    """
    return differences(one, other, compared=TO_THE_END, neither=0.0)


@dataclass(frozen=True)
class Fineness:
    """Steps, rods and strips of a run."""

    steps_per_round: int
    rods_per_round: int
    strips: int

    @classmethod
    def of(cls, setup: Setup) -> "Fineness":
        """Those that a run was set up with."""
        return cls(setup.steps, setup.strips.d.size, setup.strips.g0.size)

    def with_longer_step(self, ratio: int = STEP_RATIO) -> "Fineness":
        """Those of a companion with a step ``ratio`` times longer and half the rods."""
        return replace(
            self,
            steps_per_round=self.steps_per_round // ratio,
            rods_per_round=(self.rods_per_round // WIDTH_RATIO) | 1,
        )

    def with_fewer_strips(self) -> "Fineness":
        """Those of a companion with half the strips."""
        return replace(self, strips=max(self.strips // WIDTH_RATIO, 1))

    def finer(self) -> "Fineness":
        """Those of a run with twice the steps, rods and strips."""
        return Fineness(
            STEP_RATIO * self.steps_per_round,
            WIDTH_RATIO * self.rods_per_round | 1,
            WIDTH_RATIO * self.strips,
        )

    def scene(self, scene: Scene) -> Scene:
        """The scene, computed piecewise-exact with these steps, rods and strips.

        With fewer samples if the steps are no multiple of all of them.
        """
        samples = scene.record.samples_per_round
        fewer = QUICK_STEP_RATIO if self.steps_per_round % samples else 1
        return scene.but(
            accuracy=None,
            verify={"share": 0.0, "predictable": scene.twins},
            integrator={"scheme": "piecewise-exact", "steps_per_round": self.steps_per_round},
            liner__rods_per_round=self.rods_per_round,
            liner__strips=self.strips,
            record__samples_per_round=samples // fewer,
        )


def companion(setup: Setup, coarse: Rom, step_ratio: int = STEP_RATIO) -> Neighbour:
    """The companion of a run on a ``coarse`` model, with a step ``step_ratio`` times longer.

    Of twice the step its numbers differ by ``TIMES`` their error.
    """
    fineness = Fineness.of(setup).with_longer_step(step_ratio).with_fewer_strips()
    return Neighbour("companion", scene=fineness.scene, rom=lambda _: coarse)


class Parts(NamedTuple):
    """Relative error of a run, largest of all observables, by its cause."""

    step: float  # with the rods, which go with the step
    strips: float
    model: float  # patches and natural modes


def with_errors(run: Run, coarser: Coarser, times: dict[str, float] | None = None) -> Run:
    """The run with errors from a companion coarser in step, rods, strips and model.

    With ``times`` from a companion of four times the step, whose difference is so many errors, by
    observable; without, of twice the step.
    """
    changes = from_companion(run, coarser, QUICK_STEP_RATIO if times else STEP_RATIO)
    times = times or dict.fromkeys(changes, TIMES)
    return replace(run, errors={name: d / times[name] for name, d in changes.items()})


def from_companion(run: Run, coarser: Coarser, step_ratio: int) -> dict[str, float]:
    """Differences from the companion with a step ``step_ratio`` times longer."""
    return _differences(run, _companion(run, coarser, step_ratio))


def _companion(run: Run, coarser: Coarser, step_ratio: int = STEP_RATIO) -> Run:
    """March the companion; its states are those of the run's own model."""
    coarse, T = coarser
    other = run.neighbour(companion(run.setup, coarse, step_ratio)).march()

    def of_run(outcome: Outcome) -> Outcome:
        """The outcome with states of the run's own model."""
        return replace(outcome, states=outcome.states @ T.T, blades=[*map(of_run, outcome.blades)])

    return replace(other, outcome=of_run(other.outcome))


def error_by_part(run: Run, coarser: Coarser) -> Parts:
    """Error due to the step, to the strips and to the model.

    From runs that are coarser in the step, then in the strips, then in the model, too.
    """
    longer = Fineness.of(run.setup).with_longer_step()
    of_scene = (
        run.neighbour(Neighbour("coarser", scene=fineness.scene)).march()
        for fineness in (longer, longer.with_fewer_strips())
    )
    runs = (run, *of_scene, _companion(run, coarser))
    errors = (max(_differences(*pair).values()) / TIMES for pair in pairwise(runs))
    return Parts(*(min(error, 1.0) for error in errors))  # inf: runs that end differently


def march_with_errors(
    scene: Scene,
    rom: Rom,
    coarser: Coarser,
    Omega: float,
    fineness: Fineness,
    times: dict[str, float] | None = None,
) -> Run:
    """March at ``Omega`` (rad/s), and estimate its errors, as ``with_errors``."""
    scene = fineness.scene(scene)
    return with_errors(Case(scene, rom, prepare(scene, rom, Omega)).march(), coarser, times)


def quick_times(runs: Iterable[Run], coarser: Coarser) -> dict[str, float]:
    """Difference from a companion of four times the step, in errors of the run, by observable.

    The geometric mean over the ``runs``; at least that from a companion of twice the step.
    """
    of_runs = [(run.errors, from_companion(run, coarser, QUICK_STEP_RATIO)) for run in runs]

    def times(name: str) -> float:
        """Geometric mean of the ratios of one observable, ``TIMES`` at least."""
        pairs = ((d[name], errors[name]) for errors, d in of_runs)
        ratios = [d / error for d, error in pairs if 0 < d < inf and 0 < error < inf]
        return max(geometric_mean(ratios), TIMES) if ratios else TIMES

    return {name: times(name) for name in of_runs[0][0]}


def multiple_of_samples(scene: Scene, steps: float) -> int:
    """Least multiple of the samples of run and companion from ``steps`` per revolution on."""
    samples = scene.record.samples_per_round
    thinned = samples % QUICK_STEP_RATIO == 0 and samples // QUICK_STEP_RATIO >= LEAST_SAMPLES
    unit = samples if thinned else QUICK_STEP_RATIO * samples
    return ceil(steps / unit) * unit
