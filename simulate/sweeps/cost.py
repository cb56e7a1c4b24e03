"""Cost of a sweep before it is run: steps, time and memory.

The laws are fitted to drawn scenes of blades `paper` and `rotor67` on one core, with up to 64
strips (benchmark `told`, tests/README.md): nine in ten take between a third and three times what is
told. What is not known before is how long the tip touches, and what second runs find. The
time left is measured as the sweep goes on.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import ceil, log2
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from geometry.base import WARNING, duration, failed, memory_of_machine
from geometry.tip import JUDGED
from rom.model import Rom
from simulate.contact.gaps import gaps_at, given_gaps
from simulate.contact.places import SHARES, mean_footprint, rods_in_footprint, strip_xi
from simulate.errors.neighbour import Neighbour
from simulate.errors.neighbours import HALF, QUARTER, TWIN
from simulate.marching import prepare
from simulate.marching.setup import MAX_STEPS
from simulate.scene import LEADING, PEAKS, Casing, Liner, Peaks, Record, Scene

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
    """What the cost depends on of a reduced model, and of a scene on it."""

    n: int  # DoFs
    across: int  # rows
    radius: float  # m, mean of the tip
    omega1: float  # rad/s, of its first mode at rest
    footprint: float  # m
    touching: NDArray[np.float64]  # (angles,), strips that touch

    @classmethod
    def of(cls, scene: Scene, rom: Rom | None) -> Self:
        """Those of a scene on a model, or on a usual one."""
        liner = scene.liner
        if rom is None:
            touching = np.zeros(ANGLES)
            touching[: round(USUAL_CONTACT * ANGLES)] = USUAL_CONTACT * liner.m
            return cls(*USUAL, liner.footprint_m or USUAL_FOOTPRINT, touching)
        radius = float(rom.camber[:, 0].mean())
        middle = float(np.median(scene.speeds.omega(rom.f1)))
        gap = float(given_gaps(scene.gaps, rom, LEADING))
        gaps = gaps_at(scene.gaps, rom, strip_xi(rom, liner.m), middle)
        touching = rom.across * _touching(scene.casing, gap, gaps)
        footprint = mean_footprint(liner, rom)
        return cls(rom.n, rom.across, radius, rom.omega1, footprint, touching)


USUAL = 60, 1, 0.5, 1500.0  # the first of them
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
                self.total <= LONG,
                f"{WARNING}that is some {duration(self.total)}: lower the number of speeds "
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
    liner, sizes = scene.liner, Sizes.of(scene, rom)
    Omega = scene.speeds.omega(sizes.omega1 / (2 * np.pi))
    steps = float(scene.stepping.steps_per_round or USUAL_STEPS)
    if rom and not scene.stepping.steps_per_round:
        few = {"liner": liner.model_copy(update={"rods_per_round": min(liner.nu, FEW_RODS)})}
        prepared = partial(prepare, scene.model_copy(update=few), rom)
        steps = _mean_steps(Omega, lambda speed: prepared(speed).steps)
    added = _added(scene.peaks, sizes.omega1, Omega) if speeds is None else 0
    speeds = len(Omega) if speeds is None else speeds
    # half the step that does not agree asks for a quarter
    second_runs = [TWIN] * scene.twins + [HALF, QUARTER] * scene.halves
    each = 1 + sum(run.cost for run in second_runs)
    runs = (speeds + added) * each + _checks(scene.verify == PEAKS, scene.checked_share, speeds)
    blades = scene.stage.count if scene.stage else 1
    all_steps = runs * scene.rounds * steps * blades
    columns = sizes.n + sum(1 + (mode.order > 0) for mode in scene.casing.moves)
    entries = columns * liner.m * (sizes.across + scene.contact.along)
    passed = ceil(liner.nu / steps)
    rods = 1 + passed + max(rods_in_footprint(sizes.footprint, sizes.radius, liner.nu), passed)
    contact = _in_contact(scene.stepping.scheme, rods, entries, sizes.touching)
    contact *= TRAVELLING if scene.casing.travelling else 1.0
    contact *= 1.0 if scene.contact.friction is None else FRICTION
    contact *= liner.law.touches
    return Cost(
        scene=scene,
        speeds=speeds,
        steps=steps,
        second_runs=second_runs,
        added=added,
        runs_at_speeds=speeds * each,
        runs=runs,
        all_steps=all_steps,
        seconds=all_steps * (STEP + MODE_ROW * entries + contact) + RUN * runs * blades,
        memory=START
        + HELD * _held(speeds + added, scene.record, scene.liner, scene.rounds, sizes.n, blades),
    )


def _mean_steps(Omega: NDArray[np.float64], at: Callable[[float], int]) -> float:
    """Mean steps per revolution over the speeds ``Omega``, rad/s.

    From those at the lowest, the middle and the highest: the length of a step hardly depends on the
    speed, nor on the rods, of which arrays of many take their time.
    """
    some = np.unique(np.quantile(Omega, [0.0, 0.5, 1.0], method="nearest"))
    lengths = 1 / (some * [min(at(speed), MAX_STEPS) for speed in some.tolist()])
    return float(np.mean(1 / (Omega * np.interp(Omega, some, lengths))))


def _checks(at_peaks: bool, share: float, speeds: int) -> float:
    """Further runs: second runs at peaks alone, or within a share of all steps, one at least."""
    if at_peaks:
        return min(FOUND, speeds) * (1 + TWIN.cost + HALF.cost + QUARTER.cost)
    return max(share * speeds, CHECK) if share else 0.0


def _added(peaks: Peaks | None, omega1: float, Omega: NDArray[np.float64]) -> int:
    """Speeds that are added around peaks, two of each at each halving of their distance."""
    if not peaks:
        return 0
    apart = np.ptp(Omega) / max(len(Omega) - 1, 1) / (peaks.within_over_f1 * omega1)
    halvings = max(ceil(log2(apart)), 0) if apart > 0 else 0
    added = 2 * halvings * (len(peaks.orders) if peaks.orders else FOUND)
    return added if peaks.orders else min(added, peaks.most)


def _touching(casing: Casing, gap: float, gaps: NDArray[np.float64]) -> NDArray[np.float64]:
    """Number of the strips (angles,) whose ``gaps``, m, the casing takes up: of a blade at rest.

    ``gap``: that of its harmonics, m.
    """
    inward = casing.inward(np.linspace(0, 2 * np.pi, ANGLES), gap)
    return np.asarray((inward > gaps[:, None]).sum(axis=0), np.float64)


def _in_contact(scheme: str, rods: float, entries: float, touching: NDArray[np.float64]) -> float:
    """Time of contact of a step, s: mean over the angles at which so many strips touch.

    ``rods`` under a strip; ``entries`` of the interface rows of all modes.
    """
    once, pair = CONTACT[scheme]
    each = (once + ROW * entries) * (touching > 0) + ROD * rods * touching + pair * touching**2
    return float(each.mean())


def _held(speeds: int, record: Record, liner: Liner, rounds: int, n: int, blades: int) -> float:
    """Bytes of the results of all speeds with their casings, and of a run in progress.

    Of so many ``blades``, whose records over time are held for those that are kept alone.
    """
    samples, rods = record.samples_per_round, liner.m * liner.nu
    kept, spectrum = max(len(record.listed(blades)), 1), record.rounds_of_spectrum * samples
    held = (
        DOUBLE * 2 * liner.nu
        + SINGLE * rods * record.wear
        + SINGLE * (record.spectrum_rounds or 0) * samples / 2
        + DOUBLE * n**2
        + DOUBLE * kept * rounds * samples * (1 + len(record.directions)) * len(record.chord)
        + DOUBLE * kept * (record.states_rounds or 0) * samples * n
        + SINGLE * kept * spectrum * len(record.grids)
        + SINGLE * (blades - 1) * spectrum
        + SINGLE * record.wear_by_round * rounds * SHARES * liner.nu
    )
    judged = len(JUDGED) if record.spectrum_rounds else 1
    places = judged + (1 + len(record.directions)) * len(record.chord)
    u_r = record.rounds_of_u_r(rounds) * samples * places
    marched = DOUBLE * (2 * rods + blades * (u_r + 2 * record.rounds_of_states * samples * n))
    return speeds * held + marched
