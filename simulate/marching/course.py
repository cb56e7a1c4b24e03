"""Outcome of a run, and the course of each blade from revolution to revolution, of which it is."""

from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from math import nan
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from geometry.tip import EDGES
from simulate.contact.ledger import (
    CASING,
    DAMPING,
    FRICTION,
    HEAT,
    ON_CASING,
    PLASTIC,
    RELEASED,
    SUMS,
    WORK,
    WORN,
    Ledger,
)
from simulate.contact.places import SHARES, volume_of
from simulate.contact.strips import offset
from simulate.marching.common_casing import Common
from simulate.marching.ends import EndOfStage, FinalState, final_state
from simulate.marching.forced import Forced, Moving
from simulate.marching.kernel import RUNNING, WORN_THROUGH, State
from simulate.marching.modal import TURNS
from simulate.marching.moving_casing import CasingMotion
from simulate.marching.setup import SCHEMES, Setup
from simulate.marching.states import MostStrained, every
from simulate.marching.status import WITH_RESULT, Facts, judge, why_no_contact
from simulate.marching.trend import Rounds, time_constant
from simulate.scene import TOO_SHORT, Record, Scene

U_R, FORCES, STATES, PUSHED = range(4)  # records of the kernel
type Turned = tuple[int, int, int, int]  # of a revolution: contacts, last step, end, strip


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
    final: FinalState | EndOfStage | None = None  # start of the next run, where it is asked for
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
    # of a history: (samples, directions, places), m, displacements; (samples, places), N, force on
    # the eighth of the chord around each place
    moved: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 0, 0)))
    pushed: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 0)))
    # (revolutions, shares, nu), m, worn depth of each eighth of the chord after each
    wear_by_round: NDArray[np.float32] = field(default_factory=lambda: np.empty(0, np.float32))
    recorded: bool = True  # with its records over time
    wear_share: float = 1.0  # of the volume that all blades wore in the run
    # of a stage, whose worst blade the above is: its number, the outcomes of all (of those that are
    # not recorded without their records), and the energies of all with the casing's
    worst: int = 0
    blades: Sequence["Outcome"] = ()
    of_all: Ledger | None = None

    @property
    def ledger(self) -> Ledger:
        """Energies of the run."""
        return self.of_all or self.facts.ledger

    @property
    def each_blade(self) -> Sequence["Outcome"]:
        """Outcomes of all blades; of one without a stage itself."""
        return self.blades or (self,)

    def without_records(self, samples: int) -> "Outcome":
        """The outcome without what is recorded over time, but for the last ``samples`` of u_r."""
        none = np.empty((0, 0))
        return replace(
            self,
            u_r=self.u_r[-samples:, :1].astype(np.float32),
            states=none,
            judged=none,
            gauges=none,
            strained=np.empty((0, 0, 0)),
            strained_rounds=np.empty(0, int),
            moved=np.empty((0, 0, 0)),
            pushed=none,
            recorded=False,
        )


@dataclass
class Course:
    """One blade from revolution to revolution: what is kept of it, and how it goes on."""

    scene: Scene
    setup: Setup  # of the blade
    state: State  # its own, over the liner of all
    kept: list[NDArray[np.float64]]  # its records, as of ``room``
    first: int  # revolutions before the start
    before: tuple[float, ...]  # energies at the start, as of ``_stored``
    started: Moving  # free motion at the start
    at_edges: list[Rounds]
    gauges: NDArray[np.float64]
    most: MostStrained | None
    alone: bool = True  # on its casing
    worked: list[float] = field(default_factory=lambda: [0.0])
    contacts: int = 0
    done: int = 0  # revolutions
    step: int = 0  # the last of the last one
    end: int = RUNNING
    node: int = 0
    trend: str = TOO_SHORT

    @property
    def moves(self) -> int:
        """Edge that moves more."""
        return int(np.argmax([each.most for each in self.at_edges]))

    @classmethod
    def begun(
        cls,
        scene: Scene,
        setup: Setup,
        state: State,
        kept: list[NDArray[np.float64]],
        first: int,
        alone: bool,
    ) -> Self:
        """Before the first revolution, from ``state``, after ``first`` ones of another run."""
        record, samples = scene.record, scene.record.samples_per_round
        shape = record.rounds_of_spectrum, samples // thinned(record), len(setup.Phi_gauges)
        most, worn = None, worn_off(setup, state)
        if record.motion is not None:
            pictures = every(record.motion, samples, setup.omega, setup.Omega)
            most = MostStrained.room(setup.omega, pictures, samples)
        return cls(
            scene=scene,
            setup=setup,
            state=state,
            kept=kept,
            first=first,
            before=_stored(setup, state, first * setup.steps),
            started=_free(setup, state, first * setup.steps),
            at_edges=[Rounds.unknown(scene.rounds, worn) for _ in setup.edges],
            gauges=np.full(shape, nan),
            most=most,
            alone=alone,
        )

    def add(self, turned: Turned, whole: bool, worn: float) -> None:
        """Add a revolution, as of the kernel; ``worn``: volume off the liner after it, m3.

        ``whole``: whether none of the blades ended in it.
        """
        record, scene, done = self.scene.record, self.scene, self.done
        touched, self.step, self.end, self.node = turned
        self.contacts += touched
        self.worked.append(float(self.state.energies[CASING]))
        self.done += 1
        if self.setup.forced:
            self._add_forced(self.setup.forced)
        if not whole:
            return
        for edge, each in enumerate(self.at_edges):
            each.add(done, self._last(U_R)[:, edge], worn)
        least = record.rounds_of_spectrum
        if record.gauges and (row := row_of(done, least, scene.rounds, scene.until)):
            thin = thinned(record)
            modal = self._last(STATES)[thin - 1 :: thin, : len(self.setup.Phi)]
            self.gauges[row - 1] = modal @ self.setup.Phi_gauges.T
        if self.most:
            self.most.add(done + 1, self._last(STATES))

    def _add_forced(self, forced: Forced) -> None:
        """Add the steady response to the records of the last revolution, which are without it."""
        samples, outputs = self.scene.record.samples_per_round, self.setup.outputs
        q, _ = forced.response(np.arange(1, samples + 1) / samples)
        self._last(U_R)[:, : len(outputs)] += (q @ outputs.T)[:, : self._last(U_R).shape[1]]
        if self._last(STATES).size:
            self._last(STATES)[:, : q.shape[1]] += q

    def _last(self, of: int) -> NDArray[np.float64]:
        """Records of the last revolution, U_R or STATES."""
        array, scene = self.kept[of], self.scene
        return array[row_of(self.done - 1, len(array) - 1, scene.rounds, scene.until)]

    @property
    def wore(self) -> float:
        """Volume, m3, that the blade itself wore off the liner."""
        return float(self.state.energies[WORN])

    def responds(self) -> float:
        """Time constant, revolutions, of the mode that responds in the last revolution."""
        setup, of_edge = self.setup, self._last(U_R)[:, self.moves]
        return time_constant(of_edge, setup.omega, setup.Omega, setup.zeta)

    def look(self, standing: int, tau: float) -> str:
        """Whether it is steady, from the revolutions after ``standing``; ``tau``: revolutions."""
        self.trend = self.at_edges[self.moves].trend(standing, tau)
        return self.trend

    def _over_time(self, u_r: NDArray[np.float64]) -> dict[str, Any]:
        """Displacements in directions and forces of the history; ``u_r``: outputs at samples."""
        record, setup = self.scene.record, self.setup
        first, values = len(setup.Phi_out) + len(setup.Phi_timing), {}
        if record.directions:
            shape = len(u_r), len(record.directions), len(record.chord)
            values["moved"] = u_r[:, first:].reshape(shape)
        if (pushed := _in_order(self.kept[PUSHED][1:], self.done, self.scene.until)).size:
            at = [min(int(xi * SHARES), SHARES - 1) for xi in record.chord]
            steps = np.diff(pushed[..., at], axis=1, prepend=0.0)
            every = setup.steps // record.samples_per_round
            values["pushed"] = steps.reshape(-1, len(at)) / every
        return values

    def _of_modes(self, total: int) -> tuple[float, float, float]:
        """Work of forces, what damping below 0 gave, what more damping took than booked, J.

        After ``total`` steps.
        """
        setup, start = self.setup, self.first * self.setup.steps
        if setup.blade.summed is None:
            return 0.0, 0.0, 0.0
        n, sums = setup.omega.size, self.state.energies[SUMS:]
        ends = self.started, _free(setup, self.state, total)
        of_start, of_end = (_energies(setup.omega, *moving) for moving in ends)
        taken, by_force, more = sums[:n] - (of_end - of_start), 0.0, np.zeros(n)
        if setup.forced:
            rounds = start / setup.steps, total / setup.steps
            by_force, more = setup.forced.work(sums[n:], ends, rounds, setup.omega, setup.zeta)
        fed = np.abs((taken + more)[np.full(n, setup.zeta) < 0]).sum()
        return by_force, float(fed), float(more.sum())

    def outcome(self, tau: float, whole: bool, **of_liner: Any) -> Outcome:
        """Outcome of the blade, at the end; ``of_liner``: what is known of casing and liner."""
        scene, setup, state, record = self.scene, self.setup, self.state, self.scene.record
        steps, strips, until = setup.steps, setup.strips, scene.until
        marched = (self.done - 1) * steps + self.step
        total, after = self.first * steps + marched, self.first + self.done
        taken = np.full((scene.rounds, 1), steps)
        taken[self.done - 1] = self.step
        by_force, fed, damped = self._of_modes(total)
        ledger = _ledger(
            state.energies, self.before, _stored(setup, state, total), alone=self.alone
        )
        ledger = replace(ledger, force=by_force, fed=fed, damping=ledger.damping + damped)
        facts = Facts(
            self.end,
            ledger,
            unsolved=int(state.solver.unsolved[0]),
            untouched=strips.touches
            and self.contacts == 0
            and (setup.forced is not None or not ledger.stored_before),
            least_sliding=float(state.slowest[0]),
        )
        status = judge(facts)
        wanted = record.end or scene.speeds.in_turn
        place = (np.nan, np.nan)
        if status not in WITH_RESULT:
            place = _place(setup, state, self.end, self.node, self.step, total)
        forces = self.kept[FORCES][1:]
        u_r, states, gauges = (
            _in_order(array, self.done, until)
            for array in (self.kept[U_R][1:], self.kept[STATES][1:], self.gauges)
        )
        judged = len(setup.Phi_out) - len(record.chord)
        shown = [self.moves, *range(judged, len(setup.Phi_out))]
        u_r = u_r.reshape(-1, u_r.shape[2])
        of_spectrum = record.rounds_of_spectrum * record.samples_per_round
        timing = self._last(U_R)[:, len(setup.Phi_out) :][:, : len(setup.Phi_timing)]
        return Outcome(
            status=status,
            rounds=marched / steps,
            xi=place[0],
            theta=place[1],
            facts=facts,
            u_r=u_r[:, shown],
            judged=u_r[-of_spectrum:, :judged].copy(),  # a view would hold all that was marched
            states=states.reshape(-1, states.shape[2])[:, : len(setup.Phi)] @ setup.Phi.T,
            **(_once(self.most, setup) if self.most else {}),
            **of_liner,
            **self._over_time(u_r),
            ends=setup.places.ends,
            force_peak=forces[:, 0],
            force_mean=forces[:, 1] / taken,
            force_tangential_mean=forces[:, 2] / taken,
            casing_work=np.diff(self.worked),
            contact_share=self.contacts / marched,
            each=self.at_edges[self.moves],
            edge=setup.edges[self.moves],
            u_t=np.ptp(timing if whole else timing[:1, :0], axis=0) / 2,
            gauges=np.concatenate(gauges),
            time_constant=tau,
            trend=self.trend,
            final=final_state(state, setup, after) if wanted and whole else None,
            reason=why_no_contact(scene, setup, state.eps_p, after)
            if status == "no-contact"
            else "",
        )


def thinned(record: Record) -> int:
    """Samples from one reading of gauges to the next."""
    return 2 - record.samples_per_round % 2  # twice as many readings cost a run 2 % more


def room(
    record: Record, rounds: int, places: int, modes: int, blades: tuple[int, ...]
) -> list[NDArray[np.float64]]:
    """Room for records of the kernel: u_r at places, forces on eighths, modal displacements.

    With an axis of so many ``blades`` after that of revolutions, if any.

    In each the first row is of every revolution that is not kept, those after it of the last
    revolutions; nan where not computed. Gauges read modal displacements revolution by revolution.
    """
    samples, of_states = record.samples_per_round, record.rounds_of_states
    pushed = SHARES if record.history and record.history.force else 0
    shapes = (
        (record.rounds_of_u_r(rounds), samples, places),
        (rounds, 3, SHARES if record.forces else 0),
        (of_states, samples if of_states or record.gauges else 0, modes),
        (rounds if pushed else 0, samples, pushed),
    )
    return [np.full((1 + kept, *blades, *shape), np.nan) for kept, *shape in shapes]


def _once(most: MostStrained, setup: Setup) -> dict[str, NDArray[Any]]:
    """The revolutions that strain the blade most, each once."""
    numbers = most.numbers.ravel()
    first = np.isin(np.arange(numbers.size), np.unique(numbers, return_index=True)[1])
    numbers = np.where(first, numbers, 0)
    q = np.where(numbers[:, None, None] > 0, most.q.reshape(numbers.size, *most.q.shape[2:]), nan)
    return {"strained": q @ setup.Phi.T, "strained_rounds": numbers}


def row_of(done: int, kept: int, rounds: int, until: str | None) -> int:
    """Row of ``room`` for revolution ``done``, from 0, of ``rounds``, the last of which are kept.

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


def worn_off(setup: Setup, state: State) -> float:
    """Volume worn off the liner, m3."""
    depth, places = setup.strips.thickness * state.eps_p.mean(axis=1), setup.places
    return float(volume_of(depth, places.width, places.radius))


def _stored(setup: Setup, state: State, steps: int) -> tuple[float, ...]:
    """Energies, J, after so many ``steps``: of the blade, of the rods under its tip, of the casing.

    The last in two parts, kinetic and elastic.
    """
    strips, energy = setup.strips, SCHEMES[setup.scheme].energy
    motion, now = state.motion, steps % TURNS
    if setup.forced:
        moving = zip(
            _free(setup, state, steps), setup.forced.response(steps / setup.steps), strict=True
        )
        blade = float(_energies(setup.omega, *(free + steady for free, steady in moving)).sum())
    else:
        blade = energy(setup.omega, setup.zeta, setup.h, motion, now)
    rods = float(state.covered.strips.stored @ strips.area * strips.thickness)
    return blade, rods, *setup.moving.energies(setup.h, motion, now, setup.omega.size)


def _free(setup: Setup, state: State, steps: int) -> Moving:
    """Modal displacements and velocities (n,) after so many ``steps``, without those of forces."""
    rows = [steps % TURNS, (steps - 1) % TURNS]
    x, y = (of[rows, : setup.omega.size] for of in state.motion[:2])
    return SCHEMES[setup.scheme].motion_of(setup.omega, setup.zeta, setup.h, x, y)


def _energies(
    omega: NDArray[np.float64], q: NDArray[np.float64], v: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Energies (n,) of the modes, J."""
    return (v**2 + (omega * q) ** 2) / 2


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
    energies: NDArray[np.float64],
    before: tuple[float, ...],
    after: tuple[float, ...],
    alone: bool,
) -> Ledger:
    """The ledger; ``before`` and ``after``: energies as of ``_stored`` at start and end, J.

    Of a blade that is not ``alone`` on its casing without what that stores and damps.
    """
    on_casing, casing_before = float(energies[ON_CASING]), before[2] + before[3]
    of_casing = (on_casing + casing_before - after[2] - after[3]) * alone  # damped there
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


def of_all(
    blades: Sequence[Outcome], common: Common, before: float, after: tuple[float, float]
) -> Ledger:
    """Energies of all ``blades`` with those of their casing, J.

    ``before``: energy of the casing at the start; ``after``: kinetic and elastic at the end.
    """
    ledgers = [blade.facts.ledger for blade in blades]
    sums = {of.name: sum(getattr(ledger, of.name) for ledger in ledgers) for of in fields(Ledger)}
    damped = float(common.energies[DAMPING])
    return Ledger(
        **sums
        | {
            "on_casing": sum(after) - before + damped,
            "casing_kinetic": after[0],
            "casing_elastic": after[1],
            "casing_damping": damped,
            "casing_before": before,
        }
    )
