"""The massless boundary of Monjaraz Tec, Gross, Krack 2022, as another method for the same runs.

Written from Computers & Structures 260 (2022) 106698 (arXiv 2111.07693). A component whose
interface DoFs bear no mass, in their form, with inner coordinates q and forces F on the interface,
inward,

    K_bb u_b + K_bi q = -F,    q'' + 2 zeta Lambda^1/2 q' + K_ii q + K_ib u_b = 0.

MacNeal's reduction gives it: q are the lowest free modes, the others bear stiffness but no mass,

    K_bb = R^-1,  K_bi = -R^-1 Phi_b,  K_ii = Lambda + Phi_b^T R^-1 Phi_b,

with the residual flexibility R = P K^-1 P^T - Phi_b Lambda^-1 Phi_b^T of the interface rows. So

    u_b = Phi_b q - R F,    q'' + 2 zeta Lambda^1/2 q' + Lambda q + Phi_b^T F = 0,

also where R is singular, as with more strips than patches. The paper's second reduction, of Craig
and Bampton, is brought to the same form. Time integration is leapfrog, with velocities at half
steps; contact is static, and set-valued on a rigid casing, at the time of each step:

    q_n = q_{n-1} + h v_{n-1/2},    Phi_b q_n = u_b + R F(u_b),
    (1 + zeta w h) v_{n+1/2} = (1 - zeta w h) v_{n-1/2} - h (w^2 q_n + Phi_b^T F_n).

What differs from the paper: contact is solved by the product's solver, without friction and at the
level of displacements (the paper's is a projection at that of velocities); damping is that of the
free modes; and rods wear, to the deepest reach of the tip on its way, even, from step to step. This
is the compiled kernel of the product with another scheme: times of both are of the same code.
"""

from collections.abc import Callable
from math import ceil
from time import process_time
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from rom.model import Rom
from simulate.contact.compiled import FIRST, compiled, compiled_sums, for_types_of
from simulate.contact.places import force_weights
from simulate.contact.ramp import ramp_of
from simulate.contact.strips import Strips, largest_over_window
from simulate.marching import piecewise_exact
from simulate.marching.kernel import RUNNING, Recorded, at_start, march_round
from simulate.marching.modal import Motion, Scheme, padded_rows, scheme_arrays
from simulate.marching.piecewise_exact import activate, displace, press_detected, widen_reached
from simulate.marching.setup import MARGIN, Setup
from simulate.scene import Scene


class Massless(NamedTuple):
    """A reduced model without mass at its interface; of ``setup`` where not said."""

    omega: NDArray[np.float64]  # (r,), rad/s
    Phi_b: NDArray[np.float64]  # (m, r), over the strips
    R: NDArray[np.float64]  # (m, m), m/N, residual flexibility
    Phi_out: NDArray[np.float64]  # (places, r), at the outputs
    R_out: NDArray[np.float64]  # (places, m), m/N


def macneal(setup: Setup, r: int, rows: NDArray[np.float64] | None = None) -> Massless:
    """The ``r`` lowest free modes; the others are static.

    ``rows`` (m + places, n): over the strips and at the outputs, instead of those of ``setup``.
    """
    m, own = len(setup.Phi_b), np.vstack([setup.Phi_b, setup.Phi_out])
    every = own if rows is None else rows @ setup.Phi
    low, high = every[:, :r], every[:, r:] / setup.omega[r:]
    R = high @ high[:m].T
    return Massless(setup.omega[:r], low[:m], R[:m], low[m:], R[m:])


def craig_bampton(setup: Setup, rom: Rom, places: NDArray[np.float64], r: int) -> Massless:
    """The ``r`` lowest modes of fixed interface DoFs, without the mass that these bear.

    Their coordinates plus M_ib u_b have no mass in common with the interface: with these as q, M_bb
    alone is dropped. ``places`` (k,): chord fractions of the outputs.
    """
    M, K, every = rom.M, rom.stiffness(setup.Omega), len(rom.directions)
    b = np.arange(0, every * len(rom.xi), every)  # the radial ones
    i = np.setdiff1d(np.arange(rom.n), b)
    bi, ii = np.ix_(b, i), np.ix_(i, i)
    squares, X = eigh(K[ii], M[ii], subset_by_index=[0, r - 1])
    constraint = np.linalg.solve(K[ii], K[bi].T)  # of u_b = 1, inward
    coupling = (M[bi] - constraint.T @ M[ii]) @ X * squares  # M_bi Lambda
    K_bb = K[np.ix_(b, b)] - K[bi] @ constraint + (coupling / squares) @ coupling.T
    flexible = np.linalg.inv(K_bb)
    # without force u_b is static: the free modes
    squares, Q = eigh(np.diag(squares) - coupling.T @ flexible @ coupling)
    P, P_out = (rom.rows(xi)[:, b] for xi in (setup.places.xi, places))
    Phi_b, Phi_out = (rows @ flexible @ coupling @ Q for rows in (P, P_out))
    R, R_out = (rows @ flexible @ P.T for rows in (P, P_out))
    return Massless(np.sqrt(squares), Phi_b, R, Phi_out, R_out)


def step_limit(of: Massless, stiffness: NDArray[np.float64]) -> float:
    """Largest stable step of leapfrog, s: h w < 2 with all strips engaged, and so with any.

    ``stiffness`` (m,), N/m, of the strips; inf for a rigid casing, where R must be regular.
    """
    held = np.linalg.solve(of.R + np.diag(1 / stiffness), of.Phi_b)
    return 2 / np.sqrt(np.linalg.eigvalsh(np.diag(of.omega**2) + of.Phi_b.T @ held)[-1])


def coefficients(of: Massless, zeta: float, h: float) -> Scheme:
    """The scheme as the kernel reads it, for step ``h``, s: x is q, y is v, half a step later.

    Behind the modes there is one static one for each output, which shows R_out F there.
    """
    r, outputs = len(of.omega), len(of.R_out)
    lost = zeta * of.omega * h
    moving = np.column_stack(
        [
            h * of.omega**2 / (1 + lost),
            (1 - lost) / (1 + lost),
            lost / 2,
            h / (1 + lost),
            np.zeros(r),
            np.full(r, h),
            np.ones(r),
        ]
    )
    static = np.zeros((outputs, 7))
    static[:, 4] = 1.0
    a, b, loss, *gain = np.concatenate([moving, static]).T
    scheme = scheme_arrays(
        a,
        b,
        loss[None],
        np.array(gain),
        np.hstack([of.Phi_b, of.R_out.T]),
        (advance, correct, find_force, piecewise_exact.held_forces),
    )
    scheme.C[:] = 0.0
    scheme.C[: len(of.R), : len(of.R)] = of.R
    return scheme


def over_outputs(of: Massless) -> NDArray[np.float64]:
    """Rows (places, n) of the outputs, for the modes of ``coefficients``."""
    return padded_rows(np.hstack([of.Phi_out, np.eye(len(of.R_out))]))


def energy(of: Massless, h: float, motion: Motion, now: int) -> float:
    """Energy of the modes half a step after turn ``now``, J, which leapfrog conserves."""
    x, v = (values[now, : len(of.omega)] for values in (motion.x, motion.y))
    return float(v @ v + (of.omega**2 * x) @ (x + h * v)) / 2


@compiled_sums
def advance(scheme, x, y, k, now, last, before):
    """Free motion of mode ``k`` to turn ``now``; returns the damping loss of the step, J."""
    v = y[last, k]
    x[now, k] = scheme.gain[3, k] * x[last, k] + scheme.gain[2, k] * v
    y[now, k] = scheme.b[k] * v - scheme.a[k] * x[now, k]
    return scheme.loss[0, k] * (v + y[now, k]) ** 2


@compiled_sums
def correct(scheme, x, y, modal, now, last, before):
    """Add the effect of the modal force (n,), N; returns the damping loss of the step, J."""
    lost = 0.0
    for k in range(modal.size):
        y[now, k] -= scheme.gain[0, k] * modal[k]
        x[now, k] -= scheme.gain[1, k] * modal[k]
        lost += scheme.loss[0, k] * (y[last, k] + y[now, k]) ** 2
    return lost


@compiled
def find_force(scheme, strips, state, step):
    """As that of ``piecewise_exact``; rods bear at the end of a step, and wear on the way there.

    The work on the blade is not booked.
    """
    motion, solver = state.motion, state.solver
    motion.force[:] = 0.0
    motion.moved[:] = 0.0
    count, wider = FIRST, False
    while True:
        active = activate(strips, state, step, count)
        if active == count and not wider:
            break
        count = active
        if not scheme.forces(scheme, strips, state, count):
            solver.unsolved[0] += 1
        displace(scheme.C, strips, solver, count, motion)
        wider = widen_reached(strips, state, step, count)
    for row in range(motion.u.shape[1]):
        motion.u[step.now, row] -= motion.moved[row]
    for i in range(strips.g0.size):
        state.covered.strips[i].passed -= strips.advance / 2
    found = press_detected(strips, state, step, count)
    for i in range(strips.g0.size):
        state.covered.strips[i].passed += strips.advance / 2
    return found


def at_the_end(strips: Strips) -> Strips:
    """Rods under the tip at the end of a step, not in its middle, as far as it may wear them."""
    behind, nu = ceil(strips.advance / 2), len(strips.d)
    partly_covered = strips.partly_covered + behind
    window = min(strips.rods_covered + 1 + 2 * (partly_covered + MARGIN), nu)
    first = strips.first + (1 - strips.placed) * strips.advance - behind
    return strips._replace(
        first=first % nu,
        d_window=np.roll(largest_over_window(strips.d, window), MARGIN),
        partly_covered=partly_covered,
        placed=1.0,
        w_end=np.ones(len(strips.g0)),
    )


class Run(NamedTuple):
    """What both methods show of a run."""

    u_r: NDArray[np.float64]  # (rounds * samples, places), m, at the outputs
    wear: NDArray[np.float64]  # (m, nu), m
    force: NDArray[np.float64]  # (rounds, shares), N, peak on each eighth of the chord
    mean_force: NDArray[np.float64]  # (rounds, shares), N, over the steps
    contacts: int  # steps with contact
    cpu: float  # s, of the kernel alone
    unsolved: int  # steps in which no forces were found


def massless_run(scene: Scene, setup: Setup, of: Massless) -> Run:
    """The run of a scene by leapfrog and static contact."""
    scheme = coefficients(of, scene.damping_ratio, setup.h)
    return _marched(scene, setup, scheme, at_the_end(setup.strips), over_outputs(of))


def own_run(scene: Scene, setup: Setup, scheme: Scheme | None = None) -> Run:
    """The same run by ``piecewise_exact``, or by another ``scheme`` of the product."""
    of_modes = setup.omega, setup.Phi_b, scene.damping_ratio, setup.h
    scheme = scheme or piecewise_exact.coefficients(*of_modes)
    return _marched(scene, setup, scheme, setup.strips, padded_rows(setup.Phi_out))


def exact_but_static(setup: Setup, zeta: float, r: int) -> Scheme:
    """``piecewise_exact`` with the ``r`` lowest modes, and the others static as in ``macneal``."""
    scheme = piecewise_exact.coefficients(setup.omega, setup.Phi_b, zeta, setup.h)
    m, n = setup.Phi_b.shape
    for array in (scheme.a, scheme.b, scheme.loss, scheme.gain):
        array[..., r:] = 0.0
    scheme.gain[0, r:n] = 1 / setup.omega[r:] ** 2
    scheme.C[:m, :m] = setup.Phi_b * scheme.gain[0, :n] @ setup.Phi_b.T
    return scheme


def _marched(
    scene: Scene, setup: Setup, scheme: Scheme, strips: Strips, Phi_out: NDArray[np.float64]
) -> Run:
    rounds, samples = scene.rounds, scene.record.samples_per_round
    weights, state = force_weights(setup.places.ends), at_start(scheme, strips)
    u_r = np.full((rounds, samples, len(Phi_out)), np.nan)
    force = np.full((rounds, 3, len(weights)), np.nan)
    ramp, contacts, cpu = ramp_of(scene.casing), 0, 0.0

    def of_round(done: int) -> tuple[Callable, tuple[Any, ...]]:
        both = np.stack([weights, weights])  # of t_N and t_T
        recorded = Recorded(u_r[done], force[done], np.zeros((0, 0)), Phi_out, both)
        arguments = scheme, strips, state, recorded, ramp, setup.bound, done, setup.steps
        return for_types_of(march_round, *arguments), arguments

    for done in range(rounds):
        kernel, arguments = of_round(done)
        start = process_time()
        touched, _, end, _ = kernel(*arguments)
        cpu, contacts = cpu + process_time() - start, contacts + touched
        if end != RUNNING:
            break
    return Run(
        u_r.reshape(-1, len(Phi_out)),
        strips.thickness * state.eps_p,
        force[:, 0],
        force[:, 1] / setup.steps,
        contacts,
        cpu,
        int(state.solver.unsolved[0]),
    )
