"""Runs of the study of accuracy and time: observables and CPU time of a scene on a model."""

from dataclasses import dataclass, replace
from functools import cache
from time import process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rom.model import Rom
from simulate.run import Outcome, march
from simulate.scene import LEADING, STRIPS, Record, Scene
from simulate.setup import Setup, prepare
from workflow.study.trade_errors import SPECTRUM_ROUNDS, Read, last_amplitude, read
from workflow.study.trade_plan import Model, Studied

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


@dataclass(frozen=True)
class Run:
    """Result of a run with one setting."""

    status: str
    steps: int  # per round
    cpu_s: list[float]  # least, median, most
    read: Read


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
    setup = prepare(case, rom, 2 * np.pi * rom.f1 * studied.speed)
    outcome, seconds = _timed(case, setup, turns)
    Omega_c = peak(case, rom) if studied.swept else None
    return Run(outcome.status, setup.steps, seconds, read(outcome, setup.places, SAMPLES, Omega_c))


def run_as_is(scene: Scene, rom: Rom, studied: Studied) -> Run:
    """March the scene with its own steps, and the rods of studies of other choices."""
    return run(recording(scene, rom, studied.tip.own), rom, studied, TURNS)


def _timed(case: Scene, setup: Setup, turns: int) -> tuple[Outcome, list[float]]:
    """Outcome and CPU times, s, of ``turns`` runs; a short run before compiles the kernel."""
    if turns:
        march(case, replace(setup, steps=case.record.samples_per_round))
    seconds = []
    for _ in range(max(turns, 1)):
        start = process_time()
        outcome = march(case, setup)
        seconds.append(process_time() - start)
        if sum(seconds) > LONG:
            break
    return outcome, [float(f"{f(seconds):.4g}") for f in (min, np.median, max)]


def peak(case: Scene, rom: Rom) -> float:
    """Omega_c over f1(0): the maximum over SPEEDS, refined by ``CLOSER`` around it.

    nan if the largest amplitude is at an end.
    """
    unit = 2 * np.pi * rom.f1

    def amplitudes(speeds: Array) -> Array:
        histories = [march(case, prepare(case, rom, unit * speed)).u_r[:, 0] for speed in speeds]
        return np.array([last_amplitude(u, SAMPLES) for u in histories])

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
