"""A run and its companion, which has known times its error: what the run errs by.

Piecewise-exact errs in contact with the step, and rods with their width squared (both measured:
``./run snakemake trade``). So a companion of four times the step and half the rods has four times
the error, and is off by three errors of the run that it stands beside. Source: Roache 1994.
"""

from dataclasses import dataclass, replace
from itertools import count
from math import ceil, sqrt

import numpy as np

from rom.model import Rom
from simulate.apart import Run, departures
from simulate.run import Outcome, Setup, march, prepare
from simulate.scene import Scene

LONGER = 4  # steps of a companion
WIDER = 2  # rods of a companion
LEAST_SAMPLES = 64  # per round, as of every record
CANDIDATES, LARGEST_Q = 10, 8  # numbers of rods, and ratios p/q that they avoid


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


def with_settings(scene: Scene, steps: int, rods: int) -> Scene:
    """The scene, marched piecewise-exact with ``steps`` and ``rods`` per round."""
    return scene.changed(
        accuracy=None,
        integrator={"scheme": "piecewise-exact", "steps_per_round": steps},
        liner__rods_per_round=rods,
    )


def beside(
    scene: Scene, rom: Rom, Omega: float, steps: int, rods: int, wider: int = WIDER
) -> Within:
    """A run, and its errors by a companion."""
    setup, run = _march(scene, rom, Omega, steps, rods)
    _, other = _march(scene, rom, Omega, steps // LONGER, _odd(rods // wider))
    return _within(setup, run, other, LONGER)


def closer(scene: Scene, rom: Rom, run: Within) -> Within:
    """The run, and its errors by a companion of twice the step and 1/sqrt(2) of the rods."""
    steps, rods = run.setup.steps // 2, run.setup.strips.d.size
    _, other = _march(scene, rom, run.setup.Omega, steps, _odd(round(rods / sqrt(2))))
    return _within(run.setup, Run(scene.record, run.outcome), other, 2)


def rods_apart(scene: Scene, rom: Rom, draft: Within) -> float:
    """Error of a draft by its rods alone."""
    steps, rods = draft.setup.steps, draft.setup.strips.d.size
    _, other = _march(scene, rom, draft.setup.Omega, steps, _odd(rods // WIDER))
    run = Run(scene.record, draft.outcome)
    return _within(draft.setup, run, other, WIDER**2).worst


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


def unlike(advance: float) -> float:
    """How badly p/q approximates the rods that a step and its companion's pass: 0 not at all."""
    q = np.arange(1, LARGEST_Q + 1)
    x = np.outer([1, LONGER / WIDER], q) * advance
    return float((q * abs(x - x.round())).min())


def _prime(least: int) -> int:
    """The first prime from ``least``: no step of a power of two meets all rods alike."""
    return next(n for n in count(max(least, 3)) if all(n % k for k in range(2, int(sqrt(n)) + 1)))


def _odd(rods: int) -> int:
    return rods | 1
