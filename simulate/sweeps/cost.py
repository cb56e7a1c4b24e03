"""What a sweep will cost, before it is marched: steps, time and memory.

The time of a step is that measured on one core for reduced models of 40 to 90 DoFs and 8 to 64
strips (``./run pytest -n 0 tests/benchmarks``, ``./run snakemake trade``): a part that goes with
the modes times the strips, and one that goes with the rods under the tip. On another machine, and
with less contact than usual, it is off by a factor of two or three; what is left is measured as the
sweep goes on.
"""

import os
from collections.abc import Iterable
from dataclasses import dataclass
from math import ceil

import numpy as np

from geometry.project import WARNING, duration
from rom.model import Rom
from simulate.contact.strips import rods_in_footprint
from simulate.errors.neighbours import HALF, TWIN
from simulate.marching.setup import MAX_STEPS, prepare
from simulate.scene import Scene

STEP, MODE_STRIP, ROD_STRIP = 1e-7, 3.5e-10, 4e-9  # s a step; and for each mode, rod of a strip
LONG, MUCH = 3600.0, 0.5  # s, and share of the machine's memory, from which it is warned
SINGLE, DOUBLE = 4, 8  # bytes
# Keys of a scene for second runs. The quarter of the step that may follow half the step is not
# counted.
SECOND_RUNS = {"twin": TWIN, "halving": HALF}


@dataclass(frozen=True)
class Cost:
    """Cost of a sweep, or of a part of it."""

    speeds: int
    rounds: int
    steps: float  # per round, mean over the speeds
    beside: tuple[str, ...]  # each run: keys of ``SECOND_RUNS``
    seconds: float  # on one core
    memory: float  # bytes, of all that is held at its end

    @property
    def all_steps(self) -> float:
        """Steps of all runs."""
        return self.speeds * self.rounds * self.steps * _with(self.beside)

    def lines(self, memory: float | None = None) -> list[str]:
        """What it costs, in a line; a warning where that is much.

        ``memory``: of the machine, bytes; asked from it if not given.
        """
        names = " and ".join(SECOND_RUNS[key].name for key in self.beside)
        beside = f", each with {names}" if names else ""
        said = [
            f"{self.speeds} speeds of {self.rounds} rounds of {self.steps:.6g} steps{beside}: "
            f"{self.all_steps:.2g} steps, some {duration(self.seconds)} on one core, "
            f"{self.memory / 1e9:.2g} GB of memory"
        ]
        fits = self.memory <= MUCH * (memory or machine_memory())
        if self.seconds > LONG:
            said.append(
                f"{WARNING}that is some {duration(self.seconds)}: lower the number of speeds "
                "(`peaks` adds those that matter), rounds, or integrator.steps_per_round"
            )
        if not fits:
            said.append(
                f"{WARNING}that is more than {MUCH:.0%} of this machine's memory: lower the number "
                "of speeds, liner.rods_per_round, record.samples_per_round or the rounds recorded"
            )
        return said


def machine_memory() -> float:
    """Memory of this machine, bytes."""
    return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))


def cost(scene: Scene, rom: Rom, speeds: int | None = None) -> Cost:
    """Cost of a scene at all of its speeds, or at so many of them; companions are not counted.

    The steps are those at its middle speed: found in milliseconds, whatever the scene asks for.
    """
    Omega = scene.speeds.omega(rom.f1)
    speeds = len(Omega) if speeds is None else speeds
    steps = steps_per_round(scene, rom, float(np.median(Omega)))
    beside = tuple(key for key in SECOND_RUNS if getattr(scene, key))
    runs = speeds * _with(beside)
    return Cost(
        speeds=speeds,
        rounds=scene.rounds,
        steps=steps,
        beside=beside,
        seconds=runs * scene.rounds * steps * seconds_per_step(scene, rom, steps),
        memory=speeds * _of_result(scene, rom) + _of_march(scene, rom),
    )


def _with(beside: Iterable[str]) -> float:
    """Cost of a run with those beside it, over that of the run."""
    return 1 + sum(SECOND_RUNS[key].cost for key in beside)


def steps_per_round(scene: Scene, rom: Rom, Omega: float) -> float:
    """Steps per round: the scene's, or those that the stability limit asks for at ``Omega``."""
    if scene.integrator.steps_per_round:
        return scene.integrator.steps_per_round
    few = scene.but(liner__rods_per_round=_few_rods(scene))  # the limit does not depend on them
    return min(prepare(few, rom, Omega).steps, MAX_STEPS)


def _few_rods(scene: Scene) -> int:
    """As few rods as serve for a limit: arrays of many take their time."""
    return min(scene.liner.rods_per_round, 4096)


def seconds_per_step(scene: Scene, rom: Rom, steps: float) -> float:
    """Time of a step on one core, s."""
    liner, m = scene.liner, scene.liner.m
    rods = 0.0
    if liner.law.touches:
        radius, nu = float(rom.camber[:, 0].mean()), liner.rods_per_round
        passed = ceil(nu / steps)
        rods = 1 + passed + max(rods_in_footprint(liner.footprint_m, radius, nu), passed)
    return STEP + MODE_STRIP * rom.n * m + ROD_STRIP * m * rods


def _of_result(scene: Scene, rom: Rom) -> float:
    """Bytes of the result of one run, and of its casing, which all runs hold until the end."""
    record, liner, rounds = scene.record, scene.liner, scene.rounds
    held = DOUBLE * 2 * liner.rods_per_round
    held += SINGLE * liner.m * liner.rods_per_round * record.wear
    held += SINGLE * (record.spectrum_rounds or 0) * record.samples_per_round / 2
    held += DOUBLE * rounds * record.samples_per_round * len(record.chord)
    held += DOUBLE * (record.states_rounds or 0) * record.samples_per_round * rom.n
    return held + DOUBLE * rom.n**2


def _of_march(scene: Scene, rom: Rom) -> float:
    """Bytes of one run while it is marched: rods, displacements over time."""
    record, liner = scene.record, scene.liner
    rounds = scene.rounds if record.history or record.motion else record.spectrum_rounds or 0
    u_r = rounds * record.samples_per_round * (1 + len(record.chord))
    states = (
        (record.states_rounds or (1 if record.motion else 0)) * record.samples_per_round * rom.n
    )
    return DOUBLE * (2 * liner.m * liner.rods_per_round + u_r + 2 * states)
