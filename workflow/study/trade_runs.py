"""Runs of the study of accuracy and time: their observables, errors and CPU times."""

from dataclasses import replace
from functools import cache
from time import process_time
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rom.model import Rom
from simulate.errors.neighbours import Case
from simulate.errors.observables import (
    Numbers,
    Observables,
    Run as Marched,
    error,
    numbers,
    observables,
)
from simulate.errors.signals import on_rods
from simulate.marching import prepare
from simulate.scene import LEADING, STRIPS, Record, Scene
from workflow.study.trade_plan import Model, Studied

OBSERVABLES = ("amplitude", "Omega_c", "wear", "lobes", "force", "history")
JUDGED = ("amplitude", "wear", "force", "history")  # over which the largest error is taken
FIRST_ROUNDS = 5
SPECTRUM_ROUNDS = 10
SAMPLES = 256  # per round
RECORD = {
    "samples_per_round": SAMPLES,
    "spectrum_rounds": SPECTRUM_ROUNDS,
    "history": {"chord": [LEADING]},
    "contact_force": True,
}
TURNS = 3  # repetitions of a run: least, median and largest CPU time are given
LONG = 1.0  # s; after this CPU time in total a run is not repeated
SPEEDS = np.linspace(0.32, 0.37, 13)  # over f1(0), around the peak of engine order 4
CLOSER = 4  # refinement of the spacing next to the peak

Array = NDArray[np.float64]
type Errors = dict[str, float | None]  # by observable
type Row = dict[str, Any]  # plain values, of a JSON file


class Run(NamedTuple):
    """Result of a run with one setting."""

    status: str
    steps: int  # per round
    cpu_s: list[float]  # least, median, most
    seen: Observables
    numbers: Numbers
    Omega_c: float | None = None  # over f1(0); None without a sweep, nan without a peak


@cache
def rom_of(model: Model) -> Rom:
    """The reduced model read from its file, once."""
    return Rom.load(model.file)


def recording(scene: Scene, rom: Rom, rods: int, strips: int = STRIPS, **integrator: Any) -> Scene:
    """The scene on a reduced model, with other rods and strips, and the outputs of ``RECORD``.

    ``integrator``: settings of another integrator, if given.
    """
    return scene.but(
        blade=rom.provenance.blade,
        liner__rods_per_round=rods,
        liner__strips=strips,
        twin=False,
        peaks=None,
        record=Record(**RECORD),
        **({"integrator": integrator} if integrator else {}),
    )


def run(case: Scene, rom: Rom, studied: Studied, turns: int) -> Run:
    """March a scene of ``recording`` at the speed studied; if asked for, find its peak as well."""
    of = Case(case, rom, prepare(case, rom, rom.omega1 * studied.speed))
    done, seconds = _timed(of, turns)
    Omega_c = peak(case, rom) if studied.swept else None
    shown = observables(done), numbers(case, rom, of.setup, done.outcome)
    return Run(done.outcome.status, of.setup.steps, seconds, *shown, Omega_c)


def run_as_is(scene: Scene, rom: Rom, studied: Studied) -> Run:
    """March the scene with its own steps, and the rods of studies of other choices."""
    return run(recording(scene, rom, studied.tip.own), rom, studied, TURNS)


def _timed(of: Case, turns: int) -> tuple[Marched, list[float]]:
    """A run and CPU times, s, of ``turns`` of it; a short run before compiles the kernel."""
    if turns:
        replace(of, setup=replace(of.setup, steps=SAMPLES)).march()
    seconds = []
    for _ in range(max(turns, 1)):
        start = process_time()
        done = of.march()
        seconds.append(process_time() - start)
        if sum(seconds) > LONG:
            break
    return done, [float(f"{f(seconds):.4g}") for f in (min, np.median, max)]


def peak(case: Scene, rom: Rom) -> float:
    """Omega_c over f1(0): the maximum over SPEEDS, refined by ``CLOSER`` around it.

    nan if the largest amplitude is at an end.
    """

    def amplitudes(speeds: Array) -> Array:
        runs = [Case(case, rom, prepare(case, rom, rom.omega1 * speed)) for speed in speeds]
        return np.array([amplitude(observables(of.march())) for of in runs])

    at = int(amplitudes(SPEEDS).argmax())
    if at in (0, len(SPEEDS) - 1):
        return np.nan
    near = np.linspace(SPEEDS[at - 1], SPEEDS[at + 1], 2 * CLOSER + 1)
    return summit(near, amplitudes(near))


def summit(x: Array, y: Array) -> float:
    """Abscissa of the maximum of the parabola through the largest y and its neighbours.

    nan if the largest y is at an end.
    """
    at = int(np.argmax(y))
    if at in (0, len(y) - 1):
        return np.nan
    rise, fall = np.diff(y[at - 1 : at + 2])
    return float(x[at] + (x[at + 1] - x[at]) * (rise + fall) / (rise - fall) / 2)


def amplitude(seen: Observables) -> float:
    """||Y||, m: the largest amplitude of the spectrum, which has no mean."""
    return float(seen["spectrum"].max())


def errors(run: Run, reference: Run) -> Errors:
    """Relative error of each observable; for lobes the difference of their numbers."""
    one, other, first = run.seen, reference.seen, FIRST_ROUNDS * SAMPLES
    swept = None not in (run.Omega_c, reference.Omega_c)
    return {
        "amplitude": error(amplitude(one), amplitude(other)),
        "Omega_c": error(run.Omega_c, reference.Omega_c) if swept else None,
        "wear": error(on_rods(one["wear"], other["wear"].shape[1]), other["wear"]),
        "lobes": abs(run.numbers["lobes"] - reference.numbers["lobes"]),
        "force": error(run.numbers["force_peak"], reference.numbers["force_peak"]),
        "history": error(one["history"][:first], other["history"][:first]),
    }


def changes(run: Run, reference: Run) -> Errors:
    """Errors rounded to four digits; unknown where either run has no result."""
    if {run.status, reference.status} != {"ok"}:
        return dict.fromkeys(OBSERVABLES)
    found = errors(run, reference).items()
    return {key: value if value is None else float(f"{value:.4g}") for key, value in found}


def worst(of: Errors) -> float:
    """Largest error of the observables in ``JUDGED``; inf if one is missing."""
    values = [of[name] for name in JUDGED]
    return np.inf if None in values else float(max(values))
