"""A run and its companion, which has known times its error: what the run errs by.

Piecewise-exact errs in contact with the step, rods with their width squared, strips with theirs
squared, and the reduced model as ``rom.coarser`` says (all measured: ``./run snakemake trade``). So
a companion of four times the step, half the rods, half the strips and the coarser model has four
times the error, and is off by three errors of the run that it stands beside. Source: Roache 1994.
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

LONGER = 4  # steps of a companion
WIDER = 2  # rods and strips of a companion
LEAST_SAMPLES = 64  # per round, as of every record
CANDIDATES, LARGEST_Q = 10, 8  # numbers of rods, and ratios p/q that they avoid


@dataclass(frozen=True)
class Fineness:
    """What of the numerics is chosen for an accuracy."""

    steps: int  # per round
    rods: int  # per round
    strips: int


@dataclass(frozen=True)
class Models:
    """A reduced model, and the coarser one of companions."""

    own: Rom
    coarse: Rom
    T: NDArray[np.float64]  # (n, n of coarse): the own reduced displacements from its

    @classmethod
    def of(cls, rom: Rom) -> "Models":
        """The model with its coarser one.

        Raises
        ------
        rom.model.RomError
            When there is none.
        """
        return cls(rom, *coarser(rom))


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

    @property
    def fineness(self) -> Fineness:
        """How it was marched."""
        strips = self.setup.strips
        return Fineness(self.setup.steps, strips.d.size, strips.g0.size)


def with_settings(scene: Scene, fineness: Fineness) -> Scene:
    """The scene, marched piecewise-exact so."""
    return scene.but(
        accuracy=None,
        integrator={"scheme": "piecewise-exact", "steps_per_round": fineness.steps},
        liner__rods_per_round=fineness.rods,
        liner__strips=fineness.strips,
    )


def beside(scene: Scene, models: Models, Omega: float, fineness: Fineness) -> Within:
    """A run, and its errors by a companion."""
    steps, rods, strips = fineness.steps, fineness.rods, fineness.strips
    longer = Fineness(steps // LONGER, _odd(rods // WIDER), _fewer(strips))
    setup, run = _march(scene, models.own, Omega, fineness)
    return _within(setup, run, _march_coarse(scene, models, Omega, longer), LONGER)


def draft(scene: Scene, models: Models, Omega: float, fineness: Fineness) -> Within:
    """A run, and its errors by its step alone."""
    setup, run = _march(scene, models.own, Omega, fineness)
    longer = replace(fineness, steps=fineness.steps // LONGER)
    _, other = _march(scene, models.own, Omega, longer)
    return _within(setup, run, other, LONGER)


def closer(scene: Scene, models: Models, run: Within) -> Within:
    """The run, and its errors by a companion of twice the step and 1/sqrt(2) of the rods.

    What the interface errs by goes with the error of the longer companion: half of it.
    """
    f = run.fineness
    longer = Fineness(f.steps // 2, _odd(round(f.rods / sqrt(2))), round(f.strips / sqrt(2)))
    _, other = _march(scene, models.own, run.setup.Omega, longer)
    return _within(run.setup, Run(scene.record, run.outcome), other, 2)


def rods_apart(scene: Scene, models: Models, run: Within) -> float:
    """Error of a draft by its rods alone."""
    wider = replace(run.fineness, rods=_odd(run.fineness.rods // WIDER))
    return _apart(scene, run, _march(scene, models.own, run.setup.Omega, wider)[1])


def strips_apart(scene: Scene, models: Models, run: Within) -> float:
    """Error of a draft by its strips alone."""
    fewer = replace(run.fineness, strips=_fewer(run.fineness.strips))
    return _apart(scene, run, _march(scene, models.own, run.setup.Omega, fewer)[1])


def model_apart(scene: Scene, models: Models, run: Within) -> float:
    """Error of a draft by the patches and modes of its reduced model alone."""
    return _apart(scene, run, _march_coarse(scene, models, run.setup.Omega, run.fineness))


def multiple(scene: Scene, steps: float) -> int:
    """``steps`` per round or a few more, that it and its companion can sample."""
    samples = scene.record.samples_per_round
    thinned = samples % LONGER == 0 and samples // LONGER >= LEAST_SAMPLES
    unit = samples if thinned else LONGER * samples
    return ceil(steps / unit) * unit


def unlike_steps(least: int, steps: int) -> int:
    """A number of rods, up to a fifth above ``least``, that steps do not meet alike.

    Where a step passes near p/q of a rod, every q-th meets it alike, and errors go neither with
    the step nor with the rods. Of some primes the one whose ratio is worst to approximate.
    """
    tried = np.linspace(least, 1.2 * least, CANDIDATES)
    return max((_prime(ceil(rods)) for rods in tried), key=lambda rods: unlike(rods / steps))


def _apart(scene: Scene, run: Within, other: Run) -> float:
    """Error of a run by a coarser one of the same step, which has four times as much."""
    return _within(run.setup, Run(scene.record, run.outcome), other, WIDER**2).worst


def _within(setup: Setup, run: Run, other: Run, times: float) -> Within:
    """``other`` has ``times`` the errors of ``run``."""
    departed = departures(_judged(run), _judged(other))
    errors = {name: _no_nan(value) / (times - 1) for name, value in departed.items()}
    return Within(setup, run.outcome, errors)


def _judged(run: Run) -> Run:
    """The run whose numbers count, though its steps have lost much: its errors will tell."""
    lossy = run.outcome.status == "inaccurate"
    return Run(run.record, replace(run.outcome, status="ok")) if lossy else run


def _no_nan(value: float) -> float:
    """Runs that both end early, for the same reason, have no result that could err."""
    return 0.0 if np.isnan(value) else value


def _march(scene: Scene, rom: Rom, Omega: float, fineness: Fineness) -> tuple[Setup, Run]:
    """A run with as many samples as its steps can fill, but no more than are asked for."""
    case = with_settings(scene, fineness)
    if fineness.steps % case.record.samples_per_round:
        samples = case.record.samples_per_round // LONGER
        case = case.but(record__samples_per_round=samples)
    setup = prepare(case, rom, Omega)
    return setup, Run(case.record, march(case, setup))


def _march_coarse(scene: Scene, models: Models, Omega: float, fineness: Fineness) -> Run:
    """A run on the coarser model, its states those of the own one."""
    _, run = _march(scene, models.coarse, Omega, fineness)
    return replace(run, outcome=replace(run.outcome, states=run.outcome.states @ models.T.T))


def unlike(advance: float) -> float:
    """How badly p/q approximates the rods that a step and its companion's pass: 0 not at all."""
    q = np.arange(1, LARGEST_Q + 1)
    x = np.outer([1, LONGER / WIDER], q) * advance
    return float((q * abs(x - x.round())).min())


@cache
def _prime(least: int) -> int:
    """The first prime from ``least``: no step of a power of two meets all rods alike."""
    return next(n for n in count(max(least, 3)) if all(n % k for k in range(2, int(sqrt(n)) + 1)))


def _odd(rods: int) -> int:
    return rods | 1


def _fewer(strips: int) -> int:
    return max(strips // WIDER, 1)
