"""Marches of the study of accuracy and time: one setting on one scene, read and timed."""

from dataclasses import dataclass, replace
from time import process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rom.model import Rom
from simulate.run import Outcome, Setup, march, prepare
from simulate.scene import LEADING, STRIPS, Scene
from workflow.study.trade_errors import SPECTRUM_ROUNDS, Read, last_amplitude, read, summit
from workflow.study.trade_models import Model

SAMPLES = 256  # per round
TURNS = 3  # CPU time is told as the least, the middle and the largest of these
LONG = 1.0  # s; fewer turns where they take longer: a long march averages by itself
SPEEDS = np.linspace(0.32, 0.37, 13)  # over f1(0), around the peak of engine order 4
CLOSER = 4


@dataclass(frozen=True)
class Setting:
    """What is marched: a model, a scheme with its step, rods and strips."""

    model: Model
    scheme: str
    step: float  # steps per round, or fraction of the limit of central differences
    rods: int
    strips: int
    mass_scaling_hz: float | None = None

    @property
    def integrator(self) -> dict[str, Any]:
        """As a scene has it."""
        exact = self.scheme == "piecewise-exact"
        key, step = (
            ("steps_per_round", int(self.step)) if exact else ("fraction_of_limit", self.step)
        )
        return {"scheme": self.scheme, key: step, "mass_scaling_hz": self.mass_scaling_hz}


def exact(model: Model, steps: int, rods: int, strips: int = STRIPS) -> Setting:
    """Piecewise-exact."""
    return Setting(model, "piecewise-exact", steps, rods, strips)


@dataclass(frozen=True)
class Run:
    """What one setting gives."""

    status: str
    steps: int  # per round
    cpu_s: list[float]  # least, median, most
    read: Read


def recording(scene: Scene) -> Scene:
    """The scene with the record that the study reads."""
    record = {
        "samples_per_round": SAMPLES,
        "spectrum_rounds": SPECTRUM_ROUNDS,
        "history": {"chord": [LEADING]},
        "contact_force": True,
    }
    return scene.changed(twin=False, peaks=None, record=record)


def of_setting(scene: Scene, rom: Rom, setting: Setting) -> Scene:
    """The scene as ``setting`` has it, on its reduced model."""
    return recording(scene).changed(
        blade=rom.provenance.blade,
        integrator=setting.integrator,
        liner__rods_per_round=setting.rods,
        liner__strips=setting.strips,
    )


def run(scene: Scene, rom: Rom, speed: float, setting: Setting, turns: int, swept: bool) -> Run:
    """March a setting at ``speed`` over f1(0), and where ``swept`` around the peak too."""
    return run_case(of_setting(scene, rom, setting), rom, speed, turns, swept)


def run_case(case: Scene, rom: Rom, speed: float, turns: int, swept: bool) -> Run:
    """March a scene that records what is read."""
    setup = prepare(case, rom, 2 * np.pi * rom.f1 * speed)
    outcome, seconds = _timed(case, setup, turns)
    found = read(outcome, SAMPLES)
    if swept:
        found = replace(found, Omega_c=peak(case, rom))
    return Run(outcome.status, setup.steps, seconds, found)


def _timed(case: Scene, setup: Setup, turns: int) -> tuple[Outcome, list[float]]:
    """Outcome and CPU time, s, of marches after the kernel is compiled: short rounds do that."""
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


def peak(case: Scene, rom: Rom) -> float | None:
    """Omega_c over f1(0): the summit over SPEEDS, looked at again ``CLOSER`` times nearer to it."""
    unit = 2 * np.pi * rom.f1

    def amplitudes(speeds: NDArray[np.float64]) -> NDArray[np.float64]:
        found = [march(case, prepare(case, rom, unit * speed)).u_r[:, 0] for speed in speeds]
        return np.array([last_amplitude(u, SAMPLES) for u in found])

    at = int(amplitudes(SPEEDS).argmax())
    if at in (0, len(SPEEDS) - 1):
        return None
    near = np.linspace(SPEEDS[at - 1], SPEEDS[at + 1], 2 * CLOSER + 1)
    return summit(near, amplitudes(near))
