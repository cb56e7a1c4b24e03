"""Error of a run, estimated from a coarser companion run (Roache 1994).

In contact, the error of piecewise-exact is of order two in the step and in the widths of rods and
strips; ``rom.coarser`` gives that of the reduced model (all measured: ``./run snakemake trade``).
So a companion with four times the step, half the rods, half the strips and the coarser model has at
least four times the error: it differs from the run by three times the run's error or more. On stiff
liners the error of wear falls with less than the second power of the step: no more is taken of it.
"""

from dataclasses import dataclass, replace
from functools import cache
from itertools import count
from math import ceil, sqrt

import numpy as np
from numpy.typing import NDArray

from rom.coarser import coarser
from rom.model import Rom
from simulate.compare import Run, departures
from simulate.run import Outcome, march
from simulate.scene import Scene
from simulate.setup import Setup, prepare

STEP_RATIO = 4  # step of the companion over that of the run
WIDTH_RATIO = 2  # width of its rods and strips over those of the run
LEAST_SAMPLES = 64  # per round, as in ``Record``
CANDIDATES = 10  # numbers of rods that are tried
LARGEST_Q = 8  # of the ratios p/q that rods per step avoid


@dataclass(frozen=True)
class Fineness:
    """Steps, rods and strips of a run."""

    steps: int  # per round
    rods: int  # per round
    strips: int


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
    """The scene, marched piecewise-exact with the steps, rods and strips of ``fineness``."""
    return scene.but(
        accuracy=None,
        integrator={"scheme": "piecewise-exact", "steps_per_round": fineness.steps},
        liner__rods_per_round=fineness.rods,
        liner__strips=fineness.strips,
    )


def march_with_error(
    scene: Scene, models: Models, Omega: float, fineness: Fineness
) -> RunWithError:
    """March at ``Omega`` (rad/s); errors from a companion coarser in step, rods, strips, model."""
    steps, rods, strips = fineness.steps, fineness.rods, fineness.strips
    longer = Fineness(steps // STEP_RATIO, _odd(rods // WIDTH_RATIO), _half_the_strips(strips))
    setup, run = _march(scene, models.own, Omega, fineness)
    return _with_error(setup, run, _march_coarse(scene, models, Omega, longer), STEP_RATIO)


def march_with_step_error(
    scene: Scene, models: Models, Omega: float, fineness: Fineness
) -> RunWithError:
    """March at ``Omega`` (rad/s); errors from a companion coarser in its step alone."""
    setup, run = _march(scene, models.own, Omega, fineness)
    longer = replace(fineness, steps=fineness.steps // STEP_RATIO)
    _, other = _march(scene, models.own, Omega, longer)
    return _with_error(setup, run, other, STEP_RATIO)


def refine_estimate(scene: Scene, models: Models, run: RunWithError) -> RunWithError:
    """The run with errors from a companion of twice the step and 1/sqrt(2) of rods and strips.

    It is marched on the run's own reduced model: patches and modes do not enter this estimate.
    """
    f = run.fineness
    longer = Fineness(f.steps // 2, _odd(round(f.rods / sqrt(2))), round(f.strips / sqrt(2)))
    _, other = _march(scene, models.own, run.setup.Omega, longer)
    return _with_error(run.setup, Run(scene.record, run.outcome), other, 2)


def error_of_rods(scene: Scene, models: Models, run: RunWithError) -> float:
    """Largest relative error of a run due to its rods alone."""
    wider = replace(run.fineness, rods=_odd(run.fineness.rods // WIDTH_RATIO))
    return _coarsening_error(scene, run, _march(scene, models.own, run.setup.Omega, wider)[1])


def error_of_strips(scene: Scene, models: Models, run: RunWithError) -> float:
    """Largest relative error of a run due to its strips alone."""
    fewer = replace(run.fineness, strips=_half_the_strips(run.fineness.strips))
    return _coarsening_error(scene, run, _march(scene, models.own, run.setup.Omega, fewer)[1])


def error_of_model(scene: Scene, models: Models, run: RunWithError) -> float:
    """Largest relative error of a run due to the patches and modes of its reduced model alone."""
    return _coarsening_error(
        scene, run, _march_coarse(scene, models, run.setup.Omega, run.fineness)
    )


def multiple_of_samples(scene: Scene, steps: float) -> int:
    """Least steps per round from ``steps`` on that the samples of run and companion divide."""
    samples = scene.record.samples_per_round
    thinned = samples % STEP_RATIO == 0 and samples // STEP_RATIO >= LEAST_SAMPLES
    unit = samples if thinned else STEP_RATIO * samples
    return ceil(steps / unit) * unit


def incommensurate_rods(least: int, steps: int) -> int:
    """Rods per round, from ``least`` to a fifth more, incommensurate with the ``steps`` per round.

    Where a step passes nearly p/q rods, every q-th step meets a rod at the same place, and errors
    converge neither with the step nor with the rods. Of ``CANDIDATES`` primes the one whose rods
    per step are farthest from such ratios.
    """
    tried = np.linspace(least, 1.2 * least, CANDIDATES)
    return max(
        (_prime(ceil(rods)) for rods in tried), key=lambda rods: incommensurability(rods / steps)
    )


def _coarsening_error(scene: Scene, run: RunWithError, other: Run) -> float:
    """Largest error of a run from one coarser at the same step, which has four times the error."""
    return _with_error(
        run.setup, Run(scene.record, run.outcome), other, WIDTH_RATIO**2
    ).largest_error


def _with_error(setup: Setup, run: Run, other: Run, times: float) -> RunWithError:
    """The run with its errors; ``other`` has ``times`` the errors of ``run``."""
    differences = departures(_with_result(run), _with_result(other))
    errors = {name: _zero_if_nan(value) / (times - 1) for name, value in differences.items()}
    return RunWithError(setup, run.outcome, errors)


def _with_result(run: Run) -> Run:
    """The run, compared as if `ok` where it is `inaccurate`: its error is estimated here."""
    lossy = run.outcome.status == "inaccurate"
    return Run(run.record, replace(run.outcome, status="ok")) if lossy else run


def _zero_if_nan(value: float) -> float:
    """0 for nan: two runs that end early with the same status have no results to compare."""
    return 0.0 if np.isnan(value) else value


def _march(scene: Scene, rom: Rom, Omega: float, fineness: Fineness) -> tuple[Setup, Run]:
    """March, with a quarter of the samples if the steps are no multiple of all of them."""
    case = with_settings(scene, fineness)
    if fineness.steps % case.record.samples_per_round:
        samples = case.record.samples_per_round // STEP_RATIO
        case = case.but(record__samples_per_round=samples)
    setup = prepare(case, rom, Omega)
    return setup, Run(case.record, march(case, setup))


def _march_coarse(scene: Scene, models: Models, Omega: float, fineness: Fineness) -> Run:
    """March on the coarser model; the states are those of the run's own model."""
    _, run = _march(scene, models.coarse, Omega, fineness)
    return replace(run, outcome=replace(run.outcome, states=run.outcome.states @ models.T.T))


def incommensurability(advance: float) -> float:
    """Least |q x - p| over q <= LARGEST_Q for the rods x that a step and its companion's pass.

    ``advance``: rods per step. 0 where x is such a fraction p/q.
    """
    q = np.arange(1, LARGEST_Q + 1)
    x = np.outer([1, STEP_RATIO / WIDTH_RATIO], q) * advance
    return float((q * abs(x - x.round())).min())


@cache
def _prime(least: int) -> int:
    """Smallest prime from ``least`` on: rods and steps per round then have no common divisor."""
    return next(n for n in count(max(least, 3)) if all(n % k for k in range(2, int(sqrt(n)) + 1)))


def _odd(rods: int) -> int:
    return rods | 1


def _half_the_strips(strips: int) -> int:
    return max(strips // WIDTH_RATIO, 1)
