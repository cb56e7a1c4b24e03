"""Cost of a sweep before it is run: steps, time and memory.

The time of a step is that measured on one core for reduced models of 40 to 90 DoFs and 8 to 64
strips (``./run pytest -n 0 tests/benchmarks``, ``./run snakemake trade``): a part that goes with
the modes times the strips, and one that goes with the rods under the tip. On another machine, and
with less contact than usual, it is off by a factor of two or three; the time left is measured as
the sweep goes on.
"""

from dataclasses import dataclass
from math import ceil

import numpy as np

from geometry.base import WARNING, duration, failed, memory_of_machine
from geometry.tip import JUDGED
from rom.model import Rom
from simulate.contact.places import mean_footprint, rods_in_footprint
from simulate.errors.neighbour import Neighbour
from simulate.errors.neighbours import HALF, TWIN
from simulate.marching import prepare
from simulate.marching.setup import MAX_STEPS
from simulate.scene import Liner, Record, Scene

STEP, MODE_STRIP, ROD_STRIP = 1e-7, 3.5e-10, 4e-9  # s a step; and for each mode, rod of a strip
RUN = 0.01  # s a run: its set-up and its numbers
LONG, MUCH = 3600.0, 0.5  # s, and share of the machine's memory, from which it is warned
SINGLE, DOUBLE = 4, 8  # bytes
FEW_RODS = 4096  # as few as serve for a limit


@dataclass(frozen=True)
class Cost:
    """Cost of a sweep, or of a part of it."""

    scene: Scene
    speeds: int
    steps: float  # per revolution, mean over the speeds
    second_runs: list[Neighbour]  # of each run
    all_steps: float  # of all runs
    seconds: float  # on one core
    memory: float  # bytes, of all that is held at its end

    def lines(self, memory: float | None = None) -> list[str]:
        """Cost, in a line; a warning where that is much.

        ``memory``: of the machine, bytes; asked from it if not given.
        """
        names = " and ".join(run.name for run in self.second_runs)
        second_runs = f", each with {names}" if names else ""
        rounds = f"{'at most ' if self.scene.until else ''}{self.scene.rounds} revolutions"
        peaks = self.scene.peaks  # with orders it is not known how many speeds they add
        more = f" and at most {peaks.most} more" if peaks and not peaks.orders else ""
        said = (
            f"{self.speeds} speeds{more} of {rounds} of {self.steps:.6g} steps{second_runs}: "
            f"{self.all_steps:.2g} steps, some {duration(self.seconds)} on one core, "
            f"{self.memory / 1e9:.2g} GB of memory"
        )
        memory = memory or memory_of_machine()
        much = failed(
            (
                self.seconds <= LONG,
                f"{WARNING}that is some {duration(self.seconds)}: lower the number of speeds "
                "(`peaks` adds those that matter), rounds, or integrator.steps_per_round",
            ),
            (
                self.memory <= MUCH * memory,
                f"{WARNING}that is more than {MUCH:.0%} of this machine's memory: lower the number "
                "of speeds, liner.rods_per_round, record.samples_per_round or the "
                "recorded revolutions",
            ),
        )
        return [said, *much]


def cost(scene: Scene, rom: Rom, speeds: int | None = None) -> Cost:
    """Cost of a scene at all of its speeds, or at so many of them; companions are not counted.

    The steps are those at its middle speed: found in milliseconds, whatever the scene asks for.
    """
    Omega = scene.speeds.omega(rom.f1)
    speeds = len(Omega) if speeds is None else speeds
    steps = scene.stepping.steps_per_round
    if not steps:  # the limit, which does not depend on the rods: arrays of many take their time
        few = scene.but(liner__rods_per_round=min(scene.liner.nu, FEW_RODS))
        steps = min(prepare(few, rom, float(np.median(Omega))).steps, MAX_STEPS)
    # neither checks nor shorter steps than half are counted, which may follow half the step
    second_runs = [TWIN] * scene.twins + [HALF] * scene.halves
    runs = speeds * (1 + sum(run.cost for run in second_runs))
    all_steps = runs * scene.rounds * steps
    return Cost(
        scene=scene,
        speeds=speeds,
        steps=steps,
        second_runs=second_runs,
        all_steps=all_steps,
        seconds=all_steps * _of_step(scene.liner, rom, steps) + RUN * runs,
        memory=_memory(speeds, scene.record, scene.liner, scene.rounds, rom.n),
    )


def _of_step(liner: Liner, rom: Rom, steps: float) -> float:
    """Time of a step on one core, s."""
    rods, rows = 0.0, liner.m * rom.across
    if liner.law.touches:
        radius, nu = float(rom.camber[:, 0].mean()), liner.nu
        passed = ceil(nu / steps)
        rods = 1 + passed + max(rods_in_footprint(mean_footprint(liner, rom), radius, nu), passed)
    return STEP + MODE_STRIP * rom.n * rows + ROD_STRIP * rows * rods


def _memory(speeds: int, record: Record, liner: Liner, rounds: int, n: int) -> float:
    """Bytes of the results of all speeds with their casings, and of a run in progress."""
    samples, rods = record.samples_per_round, liner.m * liner.nu
    held = (
        DOUBLE * 2 * liner.nu
        + SINGLE * rods * record.wear
        + SINGLE * (record.spectrum_rounds or 0) * samples / 2
        + DOUBLE * rounds * samples * len(record.chord)
        + DOUBLE * ((record.states_rounds or 0) * samples * n + n**2)
        + SINGLE * record.rounds_of_spectrum * samples * len(record.grids)
    )
    judged = len(JUDGED) if record.spectrum_rounds else 1
    u_r = record.rounds_of_u_r(rounds) * samples * (judged + len(record.chord))
    marched = DOUBLE * (2 * rods + u_r + 2 * record.rounds_of_states * samples * n)
    return speeds * held + marched
