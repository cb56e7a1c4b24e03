"""Cost of a sweep before it is run: steps, time and memory.

The laws are fitted to drawn scenes on one core, with reduced models of 40 to 120 DoFs and up to 64
strips (``./run python -m tests.benchmarks.told``): nine in ten take between a third and three times
what is told. What is not known before is how long the tip touches, and what second runs find. The
time left is measured as the sweep goes on.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil, log2
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from geometry.base import WARNING, duration, failed, memory_of_machine
from geometry.tip import JUDGED
from rom.model import Rom
from simulate.contact.gaps import gaps_at, given_gaps
from simulate.contact.places import mean_footprint, rods_in_footprint, strip_xi
from simulate.errors.neighbour import Neighbour
from simulate.errors.neighbours import HALF, QUARTER, TWIN
from simulate.marching import prepare
from simulate.marching.setup import MAX_STEPS
from simulate.scene import LEADING, PEAKS, Liner, Record, Scene

STEP, MODE_ROW = 1e-7, 2.5e-10  # s a step; and for each mode of a row
# of a step in contact, s: for itself and for each pair of strips that touch, by scheme
CONTACT = {"piecewise-exact": (1.4e-6, 1.1e-8), "central-difference": (1e-7, 1.5e-9)}
ROW, ROD = 5e-10, 1e-8  # s: for each mode of a row, and for each rod under a strip that touches
TRAVELLING, FRICTION = 2.4, 1.8  # times that, where the casing travels, and with friction
SWEEP = 1.0  # s of a sweep: its files, its numbers
RUN = 0.01  # s a run: its set-up and its numbers
START, HELD = 0.23e9, 3.0  # bytes of a process with its code; times the results that it holds
LONG, MUCH = 3600.0, 0.5  # s, and share of the machine's memory, from which it is warned
SINGLE, DOUBLE = 4, 8  # bytes
FEW_RODS = 4096  # as few as serve for a limit
FOUND = 3  # peaks, where they are not named
CHECK = 3.5  # runs: the check of one


class Sizes(NamedTuple):
    """What the cost depends on of a reduced model."""

    n: int  # DoFs
    across: int  # rows
    radius: float  # m, mean of the tip
    omega1: float  # rad/s, of its first mode at rest

    @classmethod
    def of(cls, rom: Rom) -> Self:
        """Those of a model."""
        return cls(rom.n, rom.across, float(rom.camber[:, 0].mean()), rom.omega1)


USUAL = Sizes(n=60, across=1, radius=0.5, omega1=1500.0)
USUAL_FOOTPRINT, USUAL_STEPS = 5e-3, 1e5  # m; of central differences in a revolution
USUAL_CONTACT = 0.35  # of the time, and of the strips
ANGLES = 720  # at which the casing is compared with the gaps


@dataclass(frozen=True)
class Cost:
    """Cost of a sweep, or of a part of it."""

    scene: Scene
    speeds: int
    steps: float  # per revolution, mean over the speeds
    second_runs: list[Neighbour]  # of each run
    added: int  # speeds around peaks
    runs_at_speeds: float  # with their second runs
    runs: float  # all
    all_steps: float  # of all runs
    seconds: float  # of them, on one core
    memory: float  # bytes, of the process that holds all results

    @property
    def total(self) -> float:
        """Time of a sweep of its own, s, on one core."""
        return SWEEP + self.seconds

    def lines(self, memory: float | None = None) -> list[str]:
        """Cost, in a line; a warning where that is much.

        ``memory``: of the machine, bytes; asked from it if not given.
        """
        names = " and ".join(run.name for run in self.second_runs)
        second_runs = f", each with {names}" if names else ""
        rounds = f"{'at most ' if self.scene.until else ''}{self.scene.rounds} revolutions"
        more = f" and some {self.added} more" if self.added else ""
        said = (
            f"{self.speeds} speeds{more} of {rounds} of {self.steps:.6g} steps{second_runs}: "
            f"{self.all_steps:.2g} steps, some {duration(self.total)} on one core, "
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


def cost(scene: Scene, rom: Rom | None, speeds: int | None = None) -> Cost:
    """Cost of a scene at all of its speeds, or at so many of them; companions are not counted.

    Found in milliseconds, whatever the scene asks for. ``rom``: None where there is none yet; the
    cost is that on a usual one.
    """
    sizes = Sizes.of(rom) if rom else USUAL
    Omega = scene.speeds.omega(sizes.omega1 / (2 * np.pi))
    steps = float(_steps(scene, rom, Omega).mean())
    added = _added(scene, sizes, Omega) if speeds is None else 0
    speeds = len(Omega) if speeds is None else speeds
    second_runs = [*_second_runs(scene)]
    each = 1 + sum(run.cost for run in second_runs)
    runs = (speeds + added) * each + _checks(scene, speeds)
    all_steps = runs * scene.rounds * steps
    return Cost(
        scene=scene,
        speeds=speeds,
        steps=steps,
        second_runs=second_runs,
        added=added,
        runs_at_speeds=speeds * each,
        runs=runs,
        all_steps=all_steps,
        seconds=all_steps * _of_step(scene, rom, sizes, steps) + RUN * runs,
        memory=START
        + HELD * _held(speeds + added, scene.record, scene.liner, scene.rounds, sizes.n),
    )


def _steps(scene: Scene, rom: Rom | None, Omega: NDArray[np.float64]) -> NDArray[np.float64]:
    """Steps per revolution at each speed ``Omega``, rad/s.

    Those of the limit, from the steps at the lowest, the middle and the highest speed: their length
    hardly depends on the speed, nor on the rods, of which arrays of many take their time.
    """
    if scene.stepping.steps_per_round:
        return np.full(len(Omega), float(scene.stepping.steps_per_round))
    if rom is None:
        return np.full(len(Omega), USUAL_STEPS)
    few = scene.but(liner__rods_per_round=min(scene.liner.nu, FEW_RODS))
    at = np.unique(np.quantile(Omega, [0.0, 0.5, 1.0], method="nearest"))
    steps = [min(prepare(few, rom, speed).steps, MAX_STEPS) for speed in at.tolist()]
    lengths = 1 / (at * steps)
    return 1 / (Omega * np.interp(Omega, at, lengths))


def _second_runs(scene: Scene) -> Iterator[Neighbour]:
    """Second runs of each speed. Half the step that does not agree asks for a quarter."""
    if scene.twins:
        yield TWIN
    if scene.halves:
        yield from (HALF, QUARTER)


def _checks(scene: Scene, speeds: int) -> float:
    """Further runs: second runs at peaks alone, or within a share of all steps, one at least."""
    every = 1 + TWIN.cost + HALF.cost + QUARTER.cost
    if scene.verify == PEAKS:
        return min(FOUND, speeds) * every
    return max(scene.checked_share * speeds, CHECK) if scene.checked_share else 0.0


def _added(scene: Scene, sizes: Sizes, Omega: NDArray[np.float64]) -> int:
    """Speeds that are added around peaks, two of each at each halving of their distance."""
    if not (peaks := scene.peaks):
        return 0
    apart = np.ptp(Omega) / max(len(Omega) - 1, 1) / (peaks.within_over_f1 * sizes.omega1)
    halvings = max(ceil(log2(apart)), 0) if apart > 0 else 0
    added = 2 * halvings * (len(peaks.orders) if peaks.orders else FOUND)
    return added if peaks.orders else min(added, peaks.most)


def _of_step(scene: Scene, rom: Rom | None, sizes: Sizes, steps: float) -> float:
    """Time of a step on one core, s: of the modes, and of the contact in a part of the steps."""
    liner = scene.liner
    entries = sizes.n * liner.m * (sizes.across + scene.contact.along)
    free = STEP + MODE_ROW * entries
    if not liner.law.touches:
        return free
    footprint = mean_footprint(liner, rom) if rom else liner.footprint_m or USUAL_FOOTPRINT
    passed = ceil(liner.nu / steps)
    rods = 1 + passed + max(rods_in_footprint(footprint, sizes.radius, liner.nu), passed)
    touching, (once, pair) = _touching(scene, rom) * sizes.across, CONTACT[scene.stepping.scheme]
    each = (once + ROW * entries) * (touching > 0) + ROD * rods * touching + pair * touching**2
    more = TRAVELLING if scene.casing.travelling else 1.0
    more *= 1.0 if scene.contact.friction is None else FRICTION
    return free + more * float(each.mean())


def _touching(scene: Scene, rom: Rom | None) -> NDArray[np.float64]:
    """Number of the strips (angles,) whose gap the whole casing takes up, of a blade at rest."""
    m = scene.liner.m
    if rom is None:
        return USUAL_CONTACT * m * (np.linspace(0, 1, ANGLES) < USUAL_CONTACT)
    Omega, theta = np.median(scene.speeds.omega(rom.f1)), np.linspace(0, 2 * np.pi, ANGLES)
    inward = scene.casing.inward(theta, float(given_gaps(scene.gaps, rom, LEADING)))
    gaps = gaps_at(scene.gaps, rom, strip_xi(rom, m), float(Omega))
    return (inward > gaps[:, None]).sum(axis=0).astype(float)


def _held(speeds: int, record: Record, liner: Liner, rounds: int, n: int) -> float:
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
