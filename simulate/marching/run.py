"""Run of one scene at one speed: all revolutions, with the recorded outputs and the status.

A run starts at rest, or from the end of another (``ends``). Several blades march together, and the
outcome is that of the worst, with those of all.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulate.contact.compiled import for_types_of
from simulate.contact.places import by_share, force_weights
from simulate.marching.common_casing import RIGID, Common, common_casing
from simulate.marching.course import (
    FORCES,
    Course,
    Outcome,
    Turned,
    of_all,
    room,
    row_of,
    worn_off,
)
from simulate.marching.disk import (
    Disk,
    Turned as OfDisk,
    does_not_slide,
    march_disk,
    of_all_schemes,
    of_blade,
    of_each_scheme,
    own_casing,
    same_casing,
    slides,
    stacked,
)
from simulate.marching.ends import (
    AnyEnd,
    EndOfStage,
    FinalState,
    begin,
    begin_casing,
    end_of_stage,
    rows_at,
)
from simulate.marching.kernel import ESCAPED, RUNNING, Recorded, State, at_start, march_round
from simulate.marching.modal import TURNS, padded_rows
from simulate.marching.moving_casing import CasingMotion
from simulate.marching.setup import UNDER, Setup, compiling
from simulate.marching.status import SEVERITY
from simulate.marching.trend import looks
from simulate.scene import STEADY, TOO_SHORT, Record, Scene


@dataclass(frozen=True)
class March:
    """A march that is set up: the state of its blades, room for records, and the kernel."""

    setups: list[Setup]  # of each blade
    state: State  # of a stage with a leading axis
    kept: list[NDArray[np.float64]]  # as of ``room``
    casing: NDArray[np.float64]  # (samples, c), coordinates of a casing that moves
    common: Common  # the casing of all blades of a stage
    kernel: Callable[..., Any]
    arguments: Callable[..., tuple[Any, ...]]  # of the kernel, in a revolution
    turned: OfDisk | None  # of a stage

    def turn(self, done: int, before: int) -> list[Turned]:
        """March revolution ``done``, from 0, after ``before`` of another run: of each blade."""
        rounds = done + before
        for j, setup in enumerate(self.setups):
            if setup.forced:
                row = rows_at(rounds, setup.steps)[0]
                setup.forced.turn(self.of_blade(j)[0].motion, row, setup.columns)
        found = self.kernel(*self.arguments(done, before))
        if self.turned is None:
            return [found]
        return [*zip(*(of.tolist() for of in self.turned[:4]), strict=True)]

    def of_blade(self, j: int) -> tuple[State, list[NDArray[np.float64]]]:
        """State and records of blade ``j``: views."""
        if self.turned is None:
            return self.state, self.kept
        return of_blade(self.state, j), [array[:, j] for array in self.kept]

    def begin(self, start: AnyEnd) -> None:
        """Begin from the end of a run of as many blades, or over its liner."""
        of_stage = isinstance(start, EndOfStage)
        for j, setup in enumerate(self.setups):
            state, _ = self.of_blade(j)
            begin(state, start.blades[j] if of_stage else start, setup)
        if of_stage:
            begin_casing(self.common, start, self.setups[0].steps)

    def in_casing(self, steps: int) -> tuple[float, float]:
        """Kinetic and elastic energy of the casing of all, J, after so many ``steps``."""
        if self.common.motion is None:
            return 0.0, 0.0
        setup = self.setups[0]
        return setup.moving.energies(setup.h, self.common.motion, steps % TURNS, 0)


def _start(setup: Setup, record: Record, rounds: int, until: str | None) -> March:
    """Room for the outputs, and the kernel with its arguments: at rest over an unworn liner."""
    always = until or record.history  # else all outputs are read where the spectrum is
    stage, setups, columns = setup.stage, setup.blades, setup.moving.order.size
    state, strips = at_start(setup.blade, setup.strips), setup.strips
    blades = (len(setups),) if stage else ()
    outputs, width = setup.outputs, state.motion.x.shape[1]
    kept = room(record, rounds, len(outputs), width, blades)
    outputs = np.pad(outputs, ((0, 0), (0, width - outputs.shape[1])))  # of the blade
    casing = np.empty((record.samples_per_round, columns))
    Phi_out = padded_rows(outputs)
    share, secant = force_weights(setup.places.ends)[: kept[FORCES].shape[-1]], setup.places.secant
    weights = share * np.stack([secant, np.ones_like(secant)])[:, None]
    turned, common, disk = None, RIGID, ()
    if stage:
        eps_p = state.eps_p
        state = stacked([at_start(of.blade, of.strips) for of in setups])._replace(eps_p=eps_p)
        theta = 2 * np.pi * np.arange(len(setups)) / len(setups)
        common = common_casing(setup.moving, theta, stage.lent, setup.h, setup.Omega)
        turned = OfDisk.room(len(setups))
        disk = (
            Disk(
                schemes=stacked(stage.schemes),
                which=stage.which,
                slides=does_not_slide if setup.blade.sliding is None else slides,
                rows=of_each_scheme if setup.forced else of_all_schemes,
                casing=own_casing if stage.nearer.any() else same_casing,
                g0=np.stack([of.strips.g0 for of in setups]),
                first=np.stack([of.strips.first for of in setups]),
                leg=stage.leg,
                common=common,
                under=tuple(np.stack([getattr(of.strips, name) for of in setups]) for name in UNDER)
                if stage.nearer.any()
                else (),
            ),
        )
        if setup.forced:
            own_rows = np.stack([scheme.Phi for scheme in stage.schemes])
            disk = (disk[0]._replace(schemes=disk[0].schemes._replace(Phi=own_rows)),)

    def arguments(done: int, before: int = 0) -> tuple[Any, ...]:
        """Of the kernel in revolution ``done``, from 0, after ``before`` of another run."""
        *rows, pushed = [array[row_of(done, len(array) - 1, rounds, until)] for array in kept]
        read = always or done >= rounds - record.rounds_of_spectrum
        Phi = Phi_out if read else Phi_out[: len(setup.edges)]
        first = setup.omega.size
        recorded = Recorded(
            *rows, Phi=Phi, weights=weights, casing=casing, first=first, pushed=pushed
        )
        of_setup = setup.ramp, setup.bound, before + done, setup.steps
        if turned:
            return *disk, strips, state, recorded, *of_setup, turned
        return setup.blade, strips, state, recorded, *of_setup

    for j, of in enumerate(setups):
        if of.forced:
            motion = (of_blade(state, j) if stage else state).motion
            of.forced.start(motion, of.blade.Phi, of.columns, of.omega, of.zeta)
    with compiling(setup.law):
        kernel = for_types_of(march_disk if stage else march_round, *arguments(0))
    return March(setups, state, kept, casing, common, kernel, arguments, turned)


def make_kernel(scene: Scene, setup: Setup) -> float:
    """Compile the kernel for the scheme and law, or read it from its file; return wall time, s."""
    start = perf_counter()
    _start(setup, scene.record, scene.rounds, scene.until)
    return perf_counter() - start


def march(scene: Scene, setup: Setup, start: AnyEnd | None = None) -> Outcome:
    """Compute all revolutions; stop when the liner is worn through or u_r exceeds ``setup.bound``.

    ``start``: end of another run, from which this one goes on, or its liner; without it a
    blade at rest starts over an unworn liner.
    """
    of = _start(setup, scene.record, scene.rounds, scene.until)
    first, steps, samples = (
        start.rounds if start else 0,
        setup.steps,
        scene.record.samples_per_round,
    )
    if start:
        of.begin(start)
    courses = [
        Course.begun(scene, blade, *of.of_blade(j), first, setup.stage is None)
        for j, blade in enumerate(of.setups)
    ]
    least, casing_before = scene.record.rounds_of_spectrum, sum(of.in_casing(first * steps))
    of_casing = CasingMotion.room(setup.moving, least)
    standing = max(scene.casing.changes_until - first, 0)  # first revolution that counts, from 0
    judged = looks(standing, least, scene.rounds) if scene.until else {scene.rounds}
    both_steady = [STEADY] * 2 if scene.until else None  # at two looks in turn
    done, whole, tau, words, worn, by_round = 0, True, np.nan, [TOO_SHORT], 0.0, []
    while done < scene.rounds and whole and words[-2:] != both_steady:
        turned = of.turn(done, first)
        if of_casing:
            of_casing.add(of.casing[: turned[0][1] * samples // steps])
            if of_casing.largest > setup.bound:
                turned = [
                    (touched, step, ESCAPED if end == RUNNING else end, node)
                    for touched, step, end, node in turned
                ]
        whole = all(end == RUNNING for _, _, end, _ in turned)
        worn = worn_off(setup, courses[0].state) if whole else worn
        if scene.record.wear_by_round:
            depth = setup.strips.thickness * courses[0].state.eps_p
            by_round.append(by_share(depth, setup.places.ends).astype(np.float32))
        for course, of_round in zip(courses, turned, strict=True):
            course.add(of_round, whole, worn)
        done += 1
        if done in judged or not whole:
            slowest = setup.moving.time_constant(setup.Omega)
            tau = max([slowest, *(course.responds() for course in courses)]) if whole else np.nan
            found = {course.look(standing, tau) for course in courses}
            words.append(STEADY if found == {STEADY} else TOO_SHORT)
    of_liner = {
        "casing": of_casing,
        "wear": setup.strips.thickness * courses[0].state.eps_p,
        "wear_by_round": np.array(by_round),
    }
    wore = sum(course.wore for course in courses) or 1.0
    blades = [
        course.outcome(tau, whole, wear_share=course.wore / wore, **of_liner) for course in courses
    ]
    if setup.stage is None:
        return blades[0]
    in_casing = of.in_casing((first + done - 1) * steps + courses[0].step)
    finals = [blade.final for blade in blades if isinstance(blade.final, FinalState)]
    worst = _worst(blades, setup.stage.longer)
    recorded = {worst, *scene.record.listed(len(blades))}
    return replace(
        blades[worst],
        worst=worst,
        wear_share=1.0,
        trend=next((of.trend for of in [blades[worst], *blades] if of.trend != STEADY), STEADY),
        blades=[
            blade if j in recorded else blade.without_records(least * samples)
            for j, blade in enumerate(blades)
        ],
        of_all=of_all(blades, of.common, casing_before, in_casing),
        final=end_of_stage(finals, of.common, steps) if finals else None,
    )


def _worst(blades: list[Outcome], longer: NDArray[np.float64]) -> int:
    """The blade of the worst status; of several that of the largest displacement, the longest.

    ``longer`` (N,), m: their lengths.
    """

    def rank(j: int) -> tuple[float, ...]:
        """Order of blade ``j``."""
        blade = blades[j]
        return SEVERITY.index(blade.status), np.nan_to_num(blade.each.largest[0]), longer[j], -j

    return max(range(len(blades)), key=rank)
