"""Runs of the study of accuracy and time: their observables, errors and CPU times."""

from dataclasses import dataclass, replace
from functools import cache
from time import process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rom.model import Rom
from simulate.contact.places import Places, by_share
from simulate.errors.loads import worn_volume
from simulate.errors.observables import error
from simulate.errors.signals import amplitude, lobe_count, on_rods, spectrum
from simulate.marching.run import Outcome, march
from simulate.marching.setup import Setup, prepare
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


@dataclass(frozen=True)
class Read:
    """Observables of a run."""

    amplitude: float  # m, ||Y|| at xi = 1/16
    wear: Array  # (shares, nu), m, mean depth over each eighth of the chord
    volume: float  # m3, worn
    lobes: int  # on the eighth of the chord with most wear
    force: float  # N, largest on any eighth
    history: Array  # (samples,), m, u_r at xi = 1/16, first rounds
    Omega_c: float | None = None  # over f1(0); None without a sweep, nan without a peak


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
    setup = prepare(case, rom, rom.omega1 * studied.speed)
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
    unit = rom.omega1

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


def last_amplitude(u: Array, samples: int) -> float:
    """||Y|| of u (time,), m, over the last rounds."""
    return float(amplitude(spectrum(u[-SPECTRUM_ROUNDS * samples :]), SPECTRUM_ROUNDS))


def read(outcome: Outcome, places: Places, samples: int, Omega_c: float | None = None) -> Read:
    """Observables of a run over ``places`` that recorded u_r from its start and contact forces."""
    u, worn = outcome.u_r[:, 0], by_share(outcome.wear, outcome.ends)
    return Read(
        amplitude=last_amplitude(u, samples),
        wear=worn,
        volume=float(worn_volume(outcome.wear, places.width, places.radius)),
        lobes=lobe_count(worn[worn.sum(axis=1).argmax()]),
        force=float(np.nanmax(outcome.force_peak)),
        history=u[: FIRST_ROUNDS * samples],
        Omega_c=Omega_c,
    )


def errors(run: Read, reference: Read) -> Errors:
    """Relative error of each observable; for lobes the difference of their numbers."""
    wear = on_rods(run.wear, reference.wear.shape[1])
    swept = run.Omega_c is not None and reference.Omega_c is not None
    return {
        "amplitude": error(run.amplitude, reference.amplitude),
        "Omega_c": error(run.Omega_c, reference.Omega_c) if swept else None,
        "wear": error(wear, reference.wear),
        "lobes": abs(run.lobes - reference.lobes),
        "force": error(run.force, reference.force),
        "history": error(run.history, reference.history),
    }


def rounded(of: Errors) -> Errors:
    """Errors rounded to four digits."""
    return {key: value if value is None else float(f"{value:.4g}") for key, value in of.items()}


def worst(of: Errors) -> float:
    """Largest error of the observables in ``JUDGED``; inf if one is missing."""
    values = [of[name] for name in JUDGED]
    return np.inf if None in values else float(max(values))
