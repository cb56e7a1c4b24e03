"""Compiled kernel of one revolution: predict, detect, liner forces, correct (section 6.2)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulate.contact.compiled import (
    FIRST,
    compiled,
    compiled_kernel,
    compiled_not_inlined,
    compiled_sums,
)
from simulate.contact.interface_force import Solver, new_solver
from simulate.contact.ledger import DAMPING, SUMS
from simulate.contact.rods import Covered, nothing_covered
from simulate.contact.strips import (
    Strips,
    closest,
    contact_free,
    contact_free_displaced,
    lean_at,
)
from simulate.marching.modal import (
    TURNS,
    Motion,
    Scheme,
    Step,
    at_rest,
    interface,
    modal_force,
    observe,
    predict,
)

RUNNING, WORN_THROUGH, ESCAPED = range(3)  # how a revolution ended


class State(NamedTuple):
    """State of a run from revolution to revolution; the kernel changes it in place."""

    motion: Motion
    covered: Covered
    solver: Solver
    eps_p: NDArray[np.float64]  # (strips, nu), plastic strains
    # (SUMS + ,), sums of the ledger, J; volume worn off, m3; where asked for ``forced.Summed``
    energies: NDArray[np.float64]
    slowest: NDArray[np.float64]  # (1,), least sliding speed with friction in contact, over Omega r


def at_start(scheme: Scheme, strips: Strips) -> State:
    """A blade at rest over an unworn liner."""
    nodes, nu = len(strips.g0), len(strips.d)
    return State(
        at_rest(scheme),
        nothing_covered(strips),
        new_solver(nodes, len(strips.rows)),
        np.zeros((nodes, nu)),
        np.zeros(SUMS + (scheme.summed.size if scheme.summed else 0)),
        np.full(1, np.inf),
    )


class Recorded(NamedTuple):
    """Output buffers of one revolution and the matrices that fill them."""

    samples: NDArray[np.float64]  # (samples, places), m, u_r after every steps/samples-th step
    forces: NDArray[np.float64]  # (3, shares), N: peak and sum of t_N, sum of t_T, over the steps
    states: NDArray[np.float64]  # (samples, padded n), modal displacements at every sample
    Phi: NDArray[np.float64]  # (places, padded n), modes at the places
    # (2, shares, m), the part of each strip in each share of the chord: for t_N times t_N over its
    # generalised force, and for t_T
    weights: NDArray[np.float64]
    # (samples, columns), coordinates of a casing that moves at every sample, from ``first`` on
    casing: NDArray[np.float64] = np.zeros((0, 0))
    first: int = 0
    # (samples, shares), N: sum of t_N over the steps of the revolution so far, at every sample
    pushed: NDArray[np.float64] = np.zeros((0, 0))


@compiled
def turns(round_turn, number):
    """Rows, of TURNS in a ring, of the steps n + 1, n and n - 1; ``number``: n in a revolution."""
    now = (round_turn + number) % TURNS
    return now, (now + 2) % TURNS, (now + 1) % TURNS


@compiled
def may_touch(strips, motion, a_first, a_last, number, now, last):
    """Whether the tip is beyond its contact-free displacement at any strip, Eq. (7).

    At the end of the step, or where it is over other rods than a step before, at its start.
    """
    u, free = motion.u, motion.free
    if strips.tangential:
        contact_free_displaced(strips, a_first, a_last, number, u, now, free)
        strips.waves.lower(strips, a_first, a_last, number, number, motion, now)
    beyond = False
    for i in range(strips.g0.size):
        start = closest(strips, u[last, i], lean_at(strips, u, last, i))
        end = closest(strips, u[now, i], lean_at(strips, u, now, i))
        beyond |= max(end, start) > free[i]
    return beyond


@compiled_not_inlined
def march_free(scheme, strips, motion, energies, a_first, a_last, number, end, round_turn, loaded):
    """Free motion from step ``number`` until the tip may touch, to step ``end`` at most.

    Over one step where rods are ``loaded``.

    Returns
    -------
    int, float, bool
        The last step taken; its damping loss, J, which is not booked yet; whether the tip may
        touch then.
    """
    lost = 0.0
    now, last, before = turns(round_turn, number)
    while True:
        energies[DAMPING] += lost
        number += 1
        now, last, before = before, now, last
        scheme.turn(scheme, motion, last)
        lost = predict(scheme, motion.x, motion.y, now, last, before)
        scheme.reach(scheme, motion, now)
        if strips.touches or number == end:  # without a liner, where the bound is checked
            interface(scheme.Phi, motion.x, motion.u, now)
        if strips.touches:
            loaded |= may_touch(strips, motion, a_first, a_last, number, now, last)
        if loaded or number == end:
            return number, lost, loaded


@compiled
def contact_step(scheme, strips, state, recorded, step, lost):
    """Contact in a step: forces, wear, and the change of the free motion.

    Returns
    -------
    bool, float, int
        Whether any strip bears; damping loss of the step, J, ``lost`` where none does; the strip
        that the tip came through where the liner is worn through, else -1.
    """
    motion, through = state.motion, -1
    strips.waves.follow(strips, state, step)
    loaded, deepest, where = scheme.find_force(scheme, strips, state, step)
    if loaded:
        modal_force(scheme.Phi, motion.force, motion.modal)
        lost = scheme.correct(
            scheme, motion.x, motion.y, motion.modal, step.now, step.last, step.before
        )
        scheme.book(scheme, strips, state, step)
        book_forces(strips, motion.force, recorded.weights, recorded.forces)
        if deepest >= strips.thickness and strips.rigid_depth == np.inf:
            through = where
    return loaded, lost, through


@compiled
def escaped(u, now, nodes, bound):
    """Whether any radial displacement is beyond ``bound``, m, or NaN."""
    inside = True
    for i in range(nodes):
        inside &= abs(u[now, i]) <= bound  # false for NaN
    return not inside


@compiled_sums
def book_forces(strips, force, weights, forces):
    """Add the ``force`` (rows,), N, of a step to the peaks and sums of each share of the chord."""
    first_t = strips.first_t
    for s in range(weights.shape[1]):
        normal = along = 0.0
        for i in range(weights.shape[2]):
            normal += weights[0, s, i] * force[i]
            if strips.tangential:
                along += weights[1, s, i] * force[first_t + i]
        forces[0, s] = max(forces[0, s], normal)
        forces[1, s] += normal
        forces[2, s] += along


@compiled
def under_load(state):
    """Whether rods under the tip store energy from before."""
    loaded = np.bool_(False)
    for i in range(state.covered.strips.size):
        loaded |= state.covered.strips[i].stored > 0.0
    return loaded


@compiled
def march_sample(
    scheme,
    strips,
    state,
    recorded,
    ramp,
    bound,
    done,
    steps,
    round_turn,
    number,
    stop,
    sample,
    loaded,
):
    """March a blade from step ``number`` of a revolution to ``stop``, the end of a ``sample``.

    Or within one, where ``sample`` is -1. ``ramp`` to ``steps``: as of ``march_round``;
    ``round_turn``: turn of step 0; ``loaded``: whether rods were in the step before.

    Returns
    -------
    contacts, number, loaded, end, strip
        Steps with contact, the last step taken, whether rods are loaded then, and as of
        ``march_round``.
    """
    motion, contacts, a_first, a_last = state.motion, 0, 0.0, 0.0
    if strips.touches:
        a_first, a_last = ramp.bounds(ramp.numbers, done + number / steps, done + stop / steps)
        if not strips.tangential:
            contact_free(strips, a_first, a_last, number, stop, motion.free)
            strips.waves.lower(strips, a_first, a_last, number, stop, motion, FIRST)
    while number < stop:
        through = -1
        number, lost, loaded = march_free(
            scheme, strips, motion, state.energies, a_first, a_last, number, stop, round_turn,
            loaded,
        )  # fmt: skip
        if loaded:
            a = ramp.share(ramp.numbers, done + (number - 1 + strips.placed) / steps)
            a_end = ramp.share(ramp.numbers, done + number / steps)
            step = Step(number, a, a_end, *turns(round_turn, number))
            loaded, lost, through = contact_step(scheme, strips, state, recorded, step, lost)
            contacts += loaded
        state.energies[DAMPING] += lost
        if through >= 0:
            return contacts, number, loaded, WORN_THROUGH, through
    end = RUNNING
    if sample >= 0:
        now = turns(round_turn, number)[0]
        observe(recorded.Phi, motion.x, now, recorded.samples[sample])
        for s in range(recorded.pushed.shape[1]):
            recorded.pushed[sample, s] = recorded.forces[1, s]
        for k in range(recorded.casing.shape[1]):
            recorded.casing[sample, k] = motion.x[now, recorded.first + k]
        if len(recorded.states):
            for k in range(motion.x.shape[1]):
                recorded.states[sample, k] = motion.x[now, k]
        if escaped(motion.u, now, strips.g0.size, bound):
            end = ESCAPED
    return contacts, number, loaded, end, 0


@compiled_kernel
def march_round(scheme, strips, state, recorded, ramp, bound, done, steps):
    """Compute one revolution of ``steps`` steps.

    Parameters
    ----------
    ramp : Ramp, share of the casing distortion
    bound : m, radial displacement beyond which the run ends
    done : revolutions done before

    Returns
    -------
    contacts, number, end, strip : int
        Steps with contact, steps taken, how the revolution ended, and the strip (from 0) that the
        tip came through where the liner is worn through.
    """
    recorded.forces[:] = 0.0
    every, contacts, number, loaded = steps // len(recorded.samples), 0, FIRST, under_load(state)
    strips.waves.begin(strips, done * steps)
    round_turn = done * steps % TURNS  # turns go on where the last revolution left them
    for sample in range(len(recorded.samples)):
        touched, number, loaded, end, strip = march_sample(
            scheme, strips, state, recorded, ramp, bound, done, steps, round_turn, number,
            number + every, sample, loaded,
        )  # fmt: skip
        contacts += touched
        if end != RUNNING:
            return contacts, number, end, strip
    return contacts, number, RUNNING, 0
