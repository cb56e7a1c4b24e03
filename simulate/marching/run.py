"""Run of one scene at one speed: all revolutions, with the recorded outputs and the status.

A run starts at rest, or from the end of another: the blade's motion, the rods under its tip, the
wear. At the same speed it goes on to the last bit as one that never stopped. At another speed the
blade keeps its displacement u = Phi q and velocity Phi q', on the modes of K(Omega) there.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import nan
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.tip import EDGES
from simulate.contact.compiled import for_types_of
from simulate.contact.ledger import (
    CASING,
    DAMPING,
    FRICTION,
    HEAT,
    ON_CASING,
    PLASTIC,
    RELEASED,
    WORK,
    Ledger,
)
from simulate.contact.places import SHARES, force_weights, volume_of
from simulate.contact.strips import offset
from simulate.marching.kernel import (
    ESCAPED,
    RUNNING,
    WORN_THROUGH,
    Recorded,
    State,
    at_start,
    march_round,
)
from simulate.marching.modal import TURNS, padded_rows
from simulate.marching.moving_casing import CasingMotion
from simulate.marching.setup import SCHEMES, Setup, compiling
from simulate.marching.states import MostStrained, every
from simulate.marching.status import WITH_RESULT, Facts, judge, why_no_contact
from simulate.marching.trend import Rounds, looks, time_constant
from simulate.scene import STEADY, TOO_SHORT, Record, Scene

UNDER = ("at", "passed", "stored", "ramp", "low", "high")  # of ``rods.STRIP``
SOLVER = ("F", "moment", "reaction")  # of ``interface_force.AT_STRIP``


@dataclass(frozen=True)
class FinalState:
    """End of a run; modes and rows are padded as those of the kernel."""

    Omega: float  # rad/s
    h: float  # s
    rounds: int  # since the casing began to distort
    omega: NDArray[np.float64]  # (n,), rad/s
    Phi: NDArray[np.float64]  # (n, n)
    x: NDArray[np.float64]  # (2, modes), modal displacements
    y: NDArray[np.float64]  # (2, modes), second phase-plane coordinates
    u: NDArray[np.float64]  # (2, rows), m, interface displacements
    moved: NDArray[np.float64]  # (rows,), m, displacement by the force of the last step
    eps_p: NDArray[np.float64]  # (strips, nu), plastic strains
    part: NDArray[np.float64]  # (strips, window), of each rod that the tip covers
    stored: NDArray[np.float64]  # (strips, window), J/m3, its elastic energy
    under: NDArray[np.float64]  # (UNDER, strips)
    solver: NDArray[np.float64]  # (SOLVER, strips)


@dataclass(frozen=True)
class Worn:
    """Liner at the end of a run, for a blade at rest."""

    eps_p: NDArray[np.float64]  # (strips, nu), plastic strains
    rounds: int = 0  # since the casing began to distort: it does so anew


@dataclass(frozen=True)
class Outcome:
    """Result of one run."""

    status: str  # of ``judge``
    rounds: float  # revolutions computed
    xi: float  # nan where ok; else the chord fraction of the strip that was worn through, or at
    # which u_r was largest when the run ended
    theta: float  # rad, angle of that place in the casing at the end, in [0, 2 pi); nan where ok
    facts: Facts
    # (kept revolutions * samples, places), m, of u_r - s u_z at ``edge`` and at the places of the
    # history: all revolutions for a history or motion, else the last
    u_r: NDArray[np.float64]
    states: NDArray[np.float64]  # (kept revolutions * samples, n), m: reduced displacements, last
    # revolutions
    ends: NDArray[np.float64]  # (m + 1,), chord fractions: ends of the strips
    wear: NDArray[np.float64]  # (m, nu), m, worn depth l eps_p
    # forces on each eighth of the chord (SHARES), N; nan, as u_r, in revolutions not computed
    force_peak: NDArray[np.float64]  # (revolutions, shares)
    force_mean: NDArray[np.float64]  # (revolutions, shares), over the steps of the revolution
    force_tangential_mean: NDArray[np.float64]  # (revolutions, shares), against the rotation
    casing_work: NDArray[np.float64]  # (revolutions computed,), J, of the casing on the rods
    contact_share: float  # steps with contact over all steps
    each: Rounds  # numbers of every revolution, of ``edge``
    # (times, 2 gauges): strain along gauges, 1, then stress, Pa, of the vibration, at every other
    # sample of the revolutions of the spectrum, else of the last; nan in those not computed
    gauges: NDArray[np.float64]
    # revolutions, of the mode that responds in the last one, or of a slower one of the casing; inf
    # without damping, nan where the run ended early
    time_constant: float = nan
    trend: str = TOO_SHORT  # whether the motion is steady
    final: FinalState | None = None  # start of the next run, where it is asked for
    reason: str = ""  # of a run without contact: why the tip did not touch
    # xi of the edge whose motion is told: 1/16, or 15/16 where that moves more on a casing that
    # tapers; half the range of u_t at both in the last revolution (2,), m, where it is known
    edge: float = EDGES[0]
    # (samples, places), m, as ``u_r`` in the revolutions of the spectrum, at ``JUDGED``
    judged: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 0)))
    u_t: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    # for a motion: reduced displacements (6, instants, n), m, of ``MostStrained``, and the numbers
    # of these revolutions (6,), 0 where one is another one
    strained: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 0, 0)))
    strained_rounds: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, int))
    casing: CasingMotion | None = None  # motion of a casing that is not rigid

    @property
    def ledger(self) -> Ledger:
        """Energies of the run."""
        return self.facts.ledger


def _room(record: Record, rounds: int, places: int, modes: int) -> list[NDArray[np.float64]]:
    """Room for records of the kernel: u_r at places, forces on eighths, modal displacements.

    In each the first row is of every revolution that is not kept, those after it of the last
    revolutions; nan where not computed. Gauges read modal displacements revolution by revolution.
    """
    samples, of_states = record.samples_per_round, record.rounds_of_states
    shapes = (
        (record.rounds_of_u_r(rounds), samples, places),
        (rounds, 3, SHARES if record.contact_force else 0),
        (of_states, samples if of_states or record.gauges else 0, modes),
    )
    return [np.full((1 + kept, *shape), np.nan) for kept, *shape in shapes]


def _start(
    setup: Setup, record: Record, rounds: int, until: str | None
) -> tuple[list[NDArray[np.float64]], Callable, Callable[..., tuple[Any, ...]]]:
    """Room for the outputs, the kernel, and its arguments: a blade at rest over an unworn liner."""
    always = until or record.history  # else all outputs are read where the spectrum is
    strips, state = setup.strips, at_start(setup.blade, setup.strips)
    outputs = np.vstack([setup.Phi_out, setup.Phi_timing])
    kept = _room(record, rounds, len(outputs), state.motion.x.shape[1])
    columns = setup.moving.order.size
    outputs = np.pad(outputs, ((0, 0), (0, columns)))  # of the blade
    casing = np.empty((record.samples_per_round, columns))
    Phi_out = padded_rows(outputs)
    share, secant = force_weights(setup.places.ends)[: kept[1].shape[2]], setup.places.secant
    weights = share * np.stack([secant, np.ones_like(secant)])[:, None]

    def arguments(done: int, before: int = 0) -> tuple[Any, ...]:
        """Of the kernel in revolution ``done``, from 0, after ``before`` of another run."""
        rows = [array[_row(done, len(array) - 1, rounds, until)] for array in kept]
        read = always or done >= rounds - record.rounds_of_spectrum
        Phi = Phi_out if read else Phi_out[: len(setup.edges)]
        first = setup.omega.size
        recorded = Recorded(*rows, Phi=Phi, weights=weights, casing=casing, first=first)
        of_setup = setup.ramp, setup.bound, before + done, setup.steps
        return setup.blade, strips, state, recorded, *of_setup

    with compiling(setup.law):
        kernel = for_types_of(march_round, *arguments(0))
    return kept, kernel, arguments


def make_kernel(scene: Scene, setup: Setup) -> float:
    """Compile the kernel for the scheme and law, or read it from its file; return wall time, s."""
    start = perf_counter()
    _start(setup, scene.record, scene.rounds, scene.until)
    return perf_counter() - start


def march(scene: Scene, setup: Setup, start: FinalState | Worn | None = None) -> Outcome:
    """Compute all revolutions; stop when the liner is worn through or u_r exceeds ``setup.bound``.

    ``start``: end of another run, from which this one goes on, or its liner; without it a
    blade at rest starts over an unworn liner.
    """
    kept, kernel, arguments = _start(setup, scene.record, scene.rounds, scene.until)
    _, strips, state, *_ = arguments(0)
    first, steps, zeta = start.rounds if start else 0, setup.steps, setup.damping_ratio
    if start:
        begin(state, start, setup)
    before = _stored(setup, state, first * steps)
    of_casing = CasingMotion.room(setup.moving, scene.record.rounds_of_spectrum)
    contacts, done, end, worked = 0, 0, RUNNING, [0.0]
    worn, tau, words, moves = _worn(setup, state), nan, [TOO_SHORT], 0
    at_edges = [Rounds.unknown(scene.rounds, worn) for _ in setup.edges]
    standing = max(scene.casing.changes_until - first, 0)  # first revolution that counts, from 0
    least = scene.record.rounds_of_spectrum
    judged = looks(standing, least, scene.rounds) if scene.until else {scene.rounds}
    both_steady = [STEADY] * 2 if scene.until else None  # at two looks in turn
    thin = 2 - scene.record.samples_per_round % 2  # twice as many readings cost a run 2 % more
    of_round = scene.record.samples_per_round // thin, len(setup.Phi_gauges)
    gauges, most = np.full((least, *of_round), np.nan), None
    if (mode := scene.record.motion) is not None:
        samples_per_round = scene.record.samples_per_round
        pictures = every(mode, samples_per_round, setup.omega, setup.Omega)
        most = MostStrained.room(setup.omega, pictures, samples_per_round)
    while done < scene.rounds and end == RUNNING and words[-2:] != both_steady:
        of_kernel = arguments(done, first)
        touched, step, end, node = kernel(*of_kernel)
        contacts += touched
        worked.append(float(state.energies[CASING]))
        if of_casing:
            of_casing.add(of_kernel[3].casing[: step * scene.record.samples_per_round // steps])
            end = ESCAPED if end == RUNNING and of_casing.largest > setup.bound else end
        if end == RUNNING:
            samples, worn = of_kernel[3].samples, _worn(setup, state)
            for edge, each in enumerate(at_edges):
                each.add(done, samples[:, edge], worn)
            if scene.record.gauges and (row := _row(done, least, scene.rounds, scene.until)):
                modal = of_kernel[3].states[thin - 1 :: thin, : len(setup.Phi)]
                gauges[row - 1] = modal @ setup.Phi_gauges.T
            if most:
                most.add(done + 1, of_kernel[3].states)
        done += 1
        if done in judged or end != RUNNING:
            whole = end == RUNNING
            moves = int(np.argmax([each.most for each in at_edges]))
            of_edge = samples[:, moves] if whole else None
            tau = (
                nan
                if of_edge is None
                else max(
                    time_constant(of_edge, setup.omega, setup.Omega, zeta),
                    setup.moving.time_constant(setup.Omega),
                )
            )
            words.append(at_edges[moves].trend(standing, tau))
    marched = (done - 1) * steps + step
    taken = np.full((scene.rounds, 1), steps)
    taken[done - 1] = step
    total = first * steps + marched
    ledger = _ledger(state.energies, before, _stored(setup, state, total))
    facts = Facts(
        end,
        ledger,
        unsolved=int(state.solver.unsolved[0]),
        at_rest=strips.touches and contacts == 0 and not ledger.stored_before,
        least_sliding=float(state.slowest[0]),
    )
    status = judge(facts)
    to_the_end, wanted = status in WITH_RESULT, scene.record.end or scene.speeds.in_turn
    place = (np.nan, np.nan) if to_the_end else _place(setup, state, end, node, step, total)
    forces = kept[1][1:]
    u_r, states, gauges = (
        _in_order(array, done, scene.until) for array in (kept[0][1:], kept[2][1:], gauges)
    )
    judged = len(setup.Phi_out) - len(scene.record.chord)
    shown, u_r = [moves, *range(judged, len(setup.Phi_out))], u_r.reshape(-1, u_r.shape[2])
    of_spectrum = least * scene.record.samples_per_round
    timing = samples[:, len(setup.Phi_out) :] if end == RUNNING else np.empty((1, 0))
    return Outcome(
        status=status,
        rounds=marched / steps,
        xi=place[0],
        theta=place[1],
        facts=facts,
        u_r=u_r[:, shown],
        judged=u_r[-of_spectrum:, :judged],
        states=states.reshape(-1, states.shape[2])[:, : len(setup.Phi)] @ setup.Phi.T,
        **(_once(most, setup) if most else {}),
        casing=of_casing,
        ends=setup.places.ends,
        wear=strips.thickness * state.eps_p,
        force_peak=forces[:, 0],
        force_mean=forces[:, 1] / taken,
        force_tangential_mean=forces[:, 2] / taken,
        casing_work=np.diff(worked),
        contact_share=contacts / marched,
        each=at_edges[moves],
        edge=setup.edges[moves],
        u_t=np.ptp(timing, axis=0) / 2,
        gauges=np.concatenate(gauges),
        time_constant=tau,
        trend=words[-1],
        final=final_state(state, setup, first + done) if wanted and end == RUNNING else None,
        reason=why_no_contact(scene, setup, state.eps_p, first + done)
        if status == "no-contact"
        else "",
    )


def _once(most: MostStrained, setup: Setup) -> dict[str, NDArray[Any]]:
    """The revolutions that strain the blade most, each once."""
    numbers = most.numbers.ravel()
    first = np.isin(np.arange(numbers.size), np.unique(numbers, return_index=True)[1])
    numbers = np.where(first, numbers, 0)
    q = np.where(numbers[:, None, None] > 0, most.q.reshape(numbers.size, *most.q.shape[2:]), nan)
    return {"strained": q @ setup.Phi.T, "strained_rounds": numbers}


def _row(done: int, kept: int, rounds: int, until: str | None) -> int:
    """Row of ``_room`` for revolution ``done``, from 0, of ``rounds``, the last of which are kept.

    Those that are not kept share the first row, which is overwritten. Where the last revolution is
    not known beforehand all take turns in the rows that are kept.
    """
    if until and kept:
        return 1 + done % kept
    return max(0, done - rounds + kept + 1)


def _in_order(kept: NDArray[np.float64], done: int, until: str | None) -> NDArray[np.float64]:
    """Revolutions ``kept`` (kept, ...) of which ``done`` were computed, the last one last.

    Where the last is not known beforehand without those that were not computed.
    """
    if not until or not len(kept):
        return kept
    return np.roll(kept, -done, axis=0) if len(kept) < done else kept[:done]


def _worn(setup: Setup, state: State) -> float:
    """Volume worn off the liner, m3."""
    depth, places = setup.strips.thickness * state.eps_p.mean(axis=1), setup.places
    return float(volume_of(depth, places.width, places.radius))


def _stored(setup: Setup, state: State, steps: int) -> tuple[float, ...]:
    """Energies, J, after so many ``steps``: of the blade, of the rods under its tip, of the casing.

    The last in two parts, kinetic and elastic.
    """
    strips, energy = setup.strips, SCHEMES[setup.scheme].energy
    motion, now = state.motion, steps % TURNS
    blade = energy(setup.omega, setup.damping_ratio, setup.h, motion, now)
    rods = float(state.covered.strips.stored @ strips.area * strips.thickness)
    return blade, rods, *setup.moving.energies(setup.h, motion, now, setup.omega.size)


def _place(
    setup: Setup, state: State, end: int, node: int, step: int, steps: int
) -> tuple[float, float]:
    """Chord fraction at which a run ended, and its angle in the casing, in [0, 2 pi) rad.

    That of strip ``node`` (from 0) where the liner is worn through; else that of the strip with the
    largest radial displacement. ``step``: the last of its revolution; ``steps``: all.
    """
    if end != WORN_THROUGH:
        u_r = state.motion.u[steps % TURNS, : len(setup.Phi_b)]
        node = int(np.abs(u_r).argmax())  # argmax takes nan as the largest
    strips = setup.strips
    middle = strips.first[node] - offset(strips, 0, 0.0)
    middle += (step + 1 - strips.placed) * strips.advance  # at the end of the step
    return float(setup.places.xi[node]), 2 * np.pi * (middle / strips.d.size % 1)


def _ledger(
    energies: NDArray[np.float64], before: tuple[float, ...], after: tuple[float, ...]
) -> Ledger:
    """The ledger; ``before`` and ``after``: energies as of ``_stored`` at start and end, J."""
    on_casing, casing_before = float(energies[ON_CASING]), before[2] + before[3]
    of_casing = on_casing + casing_before - after[2] - after[3]  # damped there
    return Ledger(
        casing=float(energies[CASING]),
        work=float(energies[WORK]) - on_casing,
        blade=after[0],
        damping=float(energies[DAMPING]) - of_casing,
        elastic=after[1],
        plastic=float(energies[PLASTIC]),
        released=float(energies[RELEASED]),
        blade_before=before[0],
        elastic_before=before[1],
        friction=float(energies[FRICTION]),
        heat=float(energies[HEAT]),
        on_casing=on_casing,
        casing_kinetic=after[2],
        casing_elastic=after[3],
        casing_damping=of_casing,
        casing_before=casing_before,
    )


def rows_at(rounds: int, steps: int) -> list[int]:
    """Rows, of TURNS in a ring, of the last step and the one before after so many revolutions."""
    row = rounds * steps % TURNS
    return [row, (row - 1) % TURNS]


def final_state(state: State, setup: Setup, rounds: int) -> FinalState:
    """End of a run after ``rounds``, since the casing began to distort."""
    motion, covered, rows = state.motion, state.covered, rows_at(rounds, setup.steps)
    return FinalState(
        Omega=setup.Omega,
        h=setup.h,
        rounds=rounds,
        omega=setup.omega,
        Phi=setup.Phi,
        x=motion.x[rows],
        y=motion.y[rows],
        u=motion.u[rows],
        moved=motion.moved.copy(),
        eps_p=state.eps_p.copy(),
        part=covered.rods["part"].copy(),
        stored=covered.rods["stored"].copy(),
        under=np.array([covered.strips[name] for name in UNDER], float),
        solver=np.array([state.solver.strips[name] for name in SOLVER]),
    )


def begin(state: State, start: FinalState | Worn, setup: Setup) -> None:
    """Put the end of a run into a ``state`` at rest."""
    state.eps_p[:] = start.eps_p
    if isinstance(start, Worn):
        return
    motion, rows = state.motion, rows_at(start.rounds, setup.steps)
    if start.Omega == setup.Omega:
        motion.x[rows], motion.y[rows], motion.u[rows] = start.x, start.y, start.u
    else:
        n, zeta, integrator = setup.omega.size, setup.damping_ratio, SCHEMES[setup.scheme]
        x, y = start.x[:, :n], start.y[:, :n]
        q, v = integrator.motion_of(start.omega, zeta, start.h, x, y)
        q, v = (np.linalg.solve(setup.Phi, start.Phi @ part) for part in (q, v))
        x, y = integrator.turns_of(setup.omega, zeta, setup.h, q, v)
        # of the casing, in the frame of the middle of its last step, as many to a revolution there
        motion.x[rows], motion.y[rows] = start.x, start.y
        motion.x[rows, :n], motion.y[rows, :n] = x, y
        motion.u[rows] = motion.x[rows] @ setup.blade.Phi.T
    motion.moved[:] = start.moved
    state.covered.rods["part"], state.covered.rods["stored"] = start.part, start.stored
    for name, values in zip(UNDER, start.under, strict=True):
        state.covered.strips[name] = values
    for name, values in zip(SOLVER, start.solver, strict=True):
        state.solver.strips[name] = values
