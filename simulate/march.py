"""The compiled march over one round, put together from a scheme, a law and a tip."""

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulate.compiled import compiled
from simulate.contact import Covered, Strips, nothing_covered, reach, reach_displaced
from simulate.interface_force import Solver, new_solver
from simulate.law import Law
from simulate.ledger import BOOKS, DAMPING
from simulate.modal import (
    LANES,
    TURNS,
    Motion,
    Scheme,
    at_rest,
    interface,
    modal_force,
    observe,
    predictor,
)

ENDED_NOT, WORN_THROUGH, ESCAPED = range(3)  # how a round ended


class Features(NamedTuple):
    """What the kernel of a scene holds: the rest is not in its code."""

    scheme: Any  # module of the scheme: advance, correct, contact_step
    law: type[Law]
    profile: bool = False
    tangential: bool = False
    rigid: bool = False  # rods that give no further: the run goes on where a liner is worn through
    ledger: bool = True  # off only to measure what it costs
    record_force: bool = False
    record_states: bool = False


class State(NamedTuple):
    """All that a march carries from round to round; the kernel changes it in place."""

    motion: Motion
    covered: Covered
    solver: Solver
    eps_p: NDArray[np.float64]  # (strips, nu), plastic strains
    books: NDArray[np.float64]  # (BOOKS,), J, sums of the ledger


def at_start(scheme: Scheme, strips: Strips) -> State:
    """A blade at rest over an unworn liner."""
    nodes, nu = len(strips.g0), len(strips.d)
    return State(
        at_rest(scheme),
        nothing_covered(strips),
        new_solver(nodes),
        np.zeros((nodes, nu)),
        np.zeros(BOOKS),
    )


class Recorded(NamedTuple):
    """What the kernel fills in every round, and what of the motion that is."""

    samples: NDArray[np.float64]  # (samples, places), m, u_r after every steps/samples-th step
    forces: NDArray[np.float64]  # (3, shares), N: peak and sum of t_N, sum of t_T, over the steps
    states: NDArray[np.float64]  # (samples, padded n), modal displacements at every sample
    Phi: NDArray[np.float64]  # (places, padded n), modes at the places
    weights: NDArray[np.float64]  # (shares, m), the part of each strip in each share of the chord


@compiled
def distortion_share(rounds, ramp_rounds):
    """a(t): smooth step x^2 (3 - 2 x) from 0 to 1 over the ramp."""
    if rounds >= ramp_rounds:
        return 1.0
    x = rounds / ramp_rounds
    return x * x * (3.0 - 2.0 * x)


@compiled
def may_touch(u, now, safe, nodes):
    """Whether the tip is beyond its safe displacement at any strip."""
    beyond = False
    for i in range(nodes):
        beyond |= u[now, i] > safe[i]
    return beyond


@compiled
def escaped(u, now, nodes, bound):
    """Whether any radial displacement is beyond ``bound``, m, or no number."""
    inside = True
    for i in range(nodes):
        inside &= abs(u[now, i]) <= bound  # false for no number
    return not inside


@compiled
def book_forces(force, weights, forces, tangential):
    """Add the ``force`` (rows,), N, of a step to the peaks and sums of each share of the chord."""
    across = force.size // 2
    for s in range(weights.shape[0]):
        radial = along = 0.0
        for i in range(weights.shape[1]):
            radial += weights[s, i] * force[i]
            if tangential:
                along += weights[s, i] * force[across + i]
        forces[0, s] = max(forces[0, s], radial)
        forces[1, s] += radial
        forces[2, s] += along


@cache
def march_kernel(features: Features) -> Any:
    """Compiled march over one round."""
    predict, correct = predictor(features.scheme.advance), features.scheme.correct
    law, profile, tangential = features.law, features.profile, features.tangential
    rigid, record_force = features.rigid, features.record_force
    record_states = features.record_states
    touches = law.touches
    find_force = features.scheme.contact_step(law, profile, tangential, rigid, features.ledger)

    @compiled
    def march_round(
        scheme, strips, state, recorded, ramp_rounds, bound, done, steps,
    ):  # fmt: skip
        """March one round of ``steps`` steps.

        Parameters
        ----------
        ramp_rounds : rounds over which the casing distorts
        bound : m, radial displacement beyond which the run ends
        done : rounds done before

        Returns
        -------
        contacts, step, end, node : int
            Steps with contact, steps taken, how the round ended, and the strip (from 0) that the
            tip came through where the liner is worn through.
        """
        motion, covered, solver, eps_p, books = state
        x, y, u = motion.x, motion.y, motion.u
        nodes = strips.g0.size
        safe = motion.safe
        samples, forces = recorded.samples, recorded.forces
        forces[:] = 0.0
        every = steps // len(samples)
        # a literal 0 would have all that takes it compiled once more, for the literal
        contacts, step, loaded = 0, np.int64(0), False
        for i in range(nodes):
            loaded |= covered.loaded[i] > 0.0
        # turns go on where the last round left them
        before = (done * steps + 1) % TURNS
        last, now = (before + 1) % TURNS, (before + 2) % TURNS
        for sample in range(len(samples)):
            if touches:
                a_first = distortion_share(done + step / steps, ramp_rounds)
                a_last = distortion_share(done + (step + every) / steps, ramp_rounds)
                if not tangential:
                    reach(strips, a_first, a_last, step, step + every, safe)
            for _ in range(every):
                step += 1
                before, last, now = last, now, before
                lost = predict(scheme, x, y, u, now, last, before)
                if touches:
                    if u.shape[1] > LANES:
                        interface(scheme.Phi, x, LANES, u, now)
                    if tangential:
                        reach_displaced(strips, a_first, a_last, step, u, now, safe)
                    if loaded or may_touch(u, now, safe, nodes):
                        a = distortion_share(done + step / steps, ramp_rounds)
                        loaded, deepest, where = find_force(
                            scheme, strips, covered, solver, motion, eps_p, safe, step, a,
                            now, last, before, books,
                        )  # fmt: skip
                        if loaded:
                            contacts += 1
                            modal_force(scheme.Phi, motion.force, motion.modal)
                            lost = correct(scheme, x, y, motion.modal, now, last, before)
                            if record_force:
                                book_forces(motion.force, recorded.weights, forces, tangential)
                            if not rigid and deepest >= strips.thickness:
                                books[DAMPING] += lost
                                return contacts, step, WORN_THROUGH, where
                books[DAMPING] += lost
            observe(recorded.Phi, x, now, samples[sample])
            if record_states:
                for k in range(x.shape[1]):
                    recorded.states[sample, k] = x[now, k]
            if escaped(u, now, nodes, bound):
                return contacts, step, ESCAPED, 0
        return contacts, step, ENDED_NOT, 0

    return march_round
