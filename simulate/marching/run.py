"""March of one scene at one speed: all rounds, with the recorded outputs and the status."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulate.contact.compiled import for_types_of
from simulate.contact.ledger import CASING, DAMPING, FRICTION, HEAT, PLASTIC, RELEASED, WORK, Ledger
from simulate.contact.places import SHARES, force_weights
from simulate.contact.ramp import ramp_of
from simulate.contact.strips import offset
from simulate.marching import central_difference, piecewise_exact
from simulate.marching.friction import sliding
from simulate.marching.kernel import RUNNING, WORN_THROUGH, Recorded, State, at_start, march_round
from simulate.marching.modal import TURNS, Scheme, padded_rows, rows_of
from simulate.marching.no_contact import why_no_contact
from simulate.marching.setup import Setup, compiling, strip_stiffness
from simulate.marching.start import Left, Worn, begin, left_by
from simulate.marching.status import WITH_RESULT, Facts, judge
from simulate.scene import Record, Scene

SCHEMES = {"central-difference": central_difference, "piecewise-exact": piecewise_exact}


@dataclass(frozen=True)
class Outcome:
    """Result of one march."""

    status: str  # of ``judge``
    rounds: float  # rounds marched
    xi: float  # nan where ok; else the chord fraction of the strip that was worn through, or at
    # which u_r was largest when the run ended
    theta: float  # rad, angle of that place in the casing at the end, in [0, 2 pi); nan where ok
    facts: Facts
    u_r: NDArray[np.float64]  # (kept rounds * samples, places), m, at xi = 1/16 and at the places
    # of the history: all rounds for a history or motion, else the last
    states: NDArray[np.float64]  # (kept rounds * samples, n), m: reduced displacements, last rounds
    ends: NDArray[np.float64]  # (m + 1,), chord fractions: ends of the strips
    wear: NDArray[np.float64]  # (m, nu), m, worn depth l eps_p
    # forces on each eighth of the chord (SHARES), N; nan, as u_r, in rounds that were not marched
    force_peak: NDArray[np.float64]  # (rounds, shares)
    force_mean: NDArray[np.float64]  # (rounds, shares), over the steps marched of the round
    force_tangential_mean: NDArray[np.float64]  # (rounds, shares), against the rotation
    casing_work: NDArray[np.float64]  # (rounds marched,), J, of the casing on the rods
    contact_share: float  # steps with contact over all steps
    left: Left | None = None  # what the next march goes on from, where it is asked for
    reason: str = ""  # of a run without contact: why the tip did not touch

    @property
    def ledger(self) -> Ledger:
        """Energies of the run."""
        return self.facts.ledger


class _Kept:
    """The last rounds of an array that the kernel fills anew in every round; nan if not marched."""

    def __init__(self, shape: tuple[int, ...], rounds: int, of: int) -> None:
        self.now = np.zeros(shape)
        self.rounds = np.full((rounds, *shape), np.nan)
        self._first = of - rounds

    def keep(self, done: int) -> None:
        """Copy the values of round ``done`` (from 0) if it is one of the last."""
        if done >= self._first:
            self.rounds[done - self._first] = self.now

    def rows(self) -> NDArray[np.float64]:
        """Samples of all kept rounds, (rounds * samples, columns)."""
        return self.rounds.reshape(-1, self.now.shape[1])


def _buffers(record: Record, rounds: int, places: int, n: int) -> tuple[_Kept, _Kept, _Kept]:
    """Arrays that the kernel fills: u_r at places, forces on eighths, modal displacements."""
    samples, of_states = record.samples_per_round, record.rounds_of_states
    return (
        _Kept((samples, places), record.rounds_of_u_r(rounds), rounds),
        _Kept((3, SHARES if record.contact_force else 0), rounds, rounds),
        _Kept((samples if of_states else 0, n), of_states, rounds),
    )


class _Start(NamedTuple):
    """State, buffers and kernel of a march before its first round."""

    state: State
    scheme: Scheme
    kept: tuple[_Kept, _Kept, _Kept]  # u_r, forces, states
    march_on: Callable  # marches round ``done`` of ``steps`` steps


def _start(scene: Scene, setup: Setup) -> _Start:
    """Blade at rest over an unworn liner, buffers of the outputs, and the kernel."""
    strips, zeta = setup.strips, scene.damping_ratio
    rows = rows_of(setup.Phi_b, setup.Phi_t)
    scheme = SCHEMES[scene.integrator.scheme].coefficients(setup.omega, rows, zeta, setup.h)
    if (mu := scene.contact.friction) is not None:
        scheme = sliding(scheme, mu, strip_stiffness(scene.liner, setup.places))
    state = at_start(scheme, strips)
    kept = _buffers(scene.record, scene.rounds, len(setup.Phi_out), state.motion.x.shape[1])
    recorded = Recorded(
        *(buffer.now for buffer in kept),
        padded_rows(setup.Phi_out),
        force_weights(setup.places.ends)[: kept[1].now.shape[1]],
    )
    arguments = scheme, strips, state, recorded, ramp_of(scene.casing), setup.bound
    with compiling(scene.liner.law):
        march_on = for_types_of(march_round, *arguments, 0, 0)
    return _Start(state, scheme, kept, partial(march_on, *arguments))


def make_kernel(scene: Scene, setup: Setup) -> float:
    """Compile the march for the scheme and law, or read it from its file; return wall time, s."""
    start = perf_counter()
    _start(scene, setup)
    return perf_counter() - start


def march(scene: Scene, setup: Setup, left: Left | Worn | None = None) -> Outcome:
    """March all rounds; stop when the liner is worn through or u_r exceeds ``setup.bound``.

    ``left``: what another march has left, from which this one goes on, or its liner; without it a
    blade at rest starts over an unworn liner.
    """
    strips, steps, zeta = setup.strips, setup.steps, scene.damping_ratio
    integrator = SCHEMES[scene.integrator.scheme]
    state, scheme, kept, march_on = _start(scene, setup)
    first, before = _begin(scene, setup, state, scheme, left)
    u_r, forces, states = kept
    contacts, done, end, worked = 0, 0, RUNNING, [0.0]
    while done < scene.rounds and end == RUNNING:
        for buffer in (u_r, states):
            buffer.now[:] = np.nan
        touched, step, end, node = march_on(first + done, steps)
        contacts += touched
        forces.now[1:] /= step
        for buffer in kept:
            buffer.keep(done)
        worked.append(float(state.energies[CASING]))
        done += 1
    marched = (done - 1) * steps + step
    row = (first * steps + marched) % TURNS
    ledger = _ledger(integrator, setup, zeta, state, row, before)
    facts = Facts(
        end,
        ledger,
        unsolved=int(state.solver.unsolved[0]),
        at_rest=strips.touches and contacts == 0 and ledger.blade_before == 0.0,
        least_sliding=float(state.slowest[0]),
    )
    status = judge(facts)
    to_the_end, wanted = status in WITH_RESULT, scene.record.end or scene.speeds.in_turn
    at = (np.nan, np.nan) if to_the_end else _place(setup, state, end, node, step, row)
    return Outcome(
        status=status,
        rounds=marched / steps,
        xi=at[0],
        theta=at[1],
        facts=facts,
        u_r=u_r.rows(),
        states=states.rows()[:, : len(setup.Phi)] @ setup.Phi.T,
        ends=setup.places.ends,
        wear=strips.thickness * state.eps_p,
        force_peak=forces.rounds[:, 0],
        force_mean=forces.rounds[:, 1],
        force_tangential_mean=forces.rounds[:, 2],
        casing_work=np.diff(worked),
        contact_share=contacts / marched,
        left=left_by(state, setup, first + done) if wanted and end == RUNNING else None,
        reason=why_no_contact(scene, strips, state.eps_p, first + done)
        if status == "no-contact"
        else "",
    )


def _begin(
    scene: Scene, setup: Setup, state: State, scheme: Scheme, left: Left | Worn | None
) -> tuple[int, tuple[float, float]]:
    """Begin from what is left: rounds of the casing before, energies of blade and rods, J."""
    if not isinstance(left, Left):
        if left is not None:
            state.eps_p[:] = left.eps_p
        return 0, (0.0, 0.0)
    integrator, zeta = SCHEMES[scene.integrator.scheme], scene.damping_ratio
    begin(state, left, scheme, integrator, setup, zeta)
    now = left.rounds * setup.steps % TURNS
    blade = integrator.energy(setup.omega, zeta, setup.h, state.motion, now)
    return left.rounds, (blade, _elastic(setup, state))


def _elastic(setup: Setup, state: State) -> float:
    """Elastic energy of the rods under the tip, J."""
    strips = setup.strips
    return float(state.covered.strips.stored @ strips.area * strips.thickness)


def _place(
    setup: Setup, state: State, end: int, node: int, step: int, row: int
) -> tuple[float, float]:
    """Chord fraction at which a run ended, and its angle in the casing, in [0, 2 pi) rad.

    That of strip ``node`` (from 0) where the liner is worn through; else that of the strip with the
    largest radial displacement.
    """
    if end != WORN_THROUGH:
        u_r = state.motion.u[row, : len(setup.Phi_b)]
        node = int(np.abs(u_r).argmax())  # argmax takes nan as the largest
    strips = setup.strips
    middle = strips.first[node] - offset(strips, 0, 0.0)
    middle += (step + 1 - strips.placed) * strips.advance  # at the end of the step
    return float(setup.places.xi[node]), 2 * np.pi * (middle / strips.d.size % 1)


def _ledger(
    scheme: Any, setup: Setup, zeta: float, state: State, now: int, before: tuple[float, float]
) -> Ledger:
    """The ledger at the row ``now``; ``before``: energies of blade and rods at the start, J."""
    energies = state.energies
    return Ledger(
        casing=float(energies[CASING]),
        work=float(energies[WORK]),
        blade=scheme.energy(setup.omega, zeta, setup.h, state.motion, now),
        damping=float(energies[DAMPING]),
        elastic=_elastic(setup, state),
        plastic=float(energies[PLASTIC]),
        released=float(energies[RELEASED]),
        blade_before=before[0],
        elastic_before=before[1],
        friction=float(energies[FRICTION]),
        heat=float(energies[HEAT]),
    )
