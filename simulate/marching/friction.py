"""Coulomb friction of the tip on the liner, always sliding: t_T = mu t_N against the rotation.

The tip slides past the casing at v_i = Omega r_i + du_t,i/dt, hundreds of m/s. With C_rr and C_rt
the radial displacements over the strips by radial and tangential forces held for a step, a step is

    w = v - A F(w),    A = C_rr + mu C_rt                                                      (a)

which is unsymmetric. With k_i the stiffness of strip i engaged, F_i grows with w_i by at most k_i,
and (a) has one solution, whatever the state of the rods, while

    diag(1/k) + (A + A^T)/2 is positive definite:                                              (b)

the slope (F - F').(w - w') >= sum (F_i - F'_i)^2 / k_i of the rods outweighs A. A short enough step
always meets (b), for 1/k does not depend on it, and A goes with its square.

In statics C_rt may be negative, and A with it: the blade then moves towards the casing that
pushes it away. One mode, of radial and tangential displacements phi_r and phi_t, on strips of
stiffness k,

    q'' + 2 zeta omega q' + [omega^2 + k phi_r (phi_r + mu phi_t)] q = 0,                      (c)

is stable while the bracket is positive; beyond it grows by

    s = sqrt(-bracket + zeta^2 omega^2) - zeta omega                                           (d)

a second. Of all modes, contact of the strips of stiffness k locks where diag(1/k) + C_rr + mu C_rt,
C now of statics, becomes singular: ``mu_crit``. Two modes may also grow as a vibration, at less
friction: ``growth_rate``.

The forces of a step are found by Newton's steps in the places w, as those without friction
(``interface_force``). Their matrix 1 + A F' has positive minors under (b): no pivots. Where they do
not converge, the forces come from Douglas and Rachford's method, which converges for any sum of two
monotone maps, from anywhere (Lions and Mercier 1979). With s = 1/k it is

    F^-1(F) - s F,    monotone, as F_i grows by at most k_i, and    A F + s F - v, by (b),

both solved for in turn, at a weight g: one strip after the other, and all by elimination.
"""

from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulate.contact.compiled import compiled
from simulate.contact.interface_force import (
    copy,
    eliminate,
    newton_on_strips,
    places_under_forces,
    solve,
    solve_strip,
    substitute,
)
from simulate.contact.ledger import FRICTION, HEAT
from simulate.marching.modal import Scheme
from simulate.marching.piecewise_exact import couple, find_force, gain
from simulate.scene.damping import Ratios

LEAST = 0.01  # of the smallest eigenvalue of (b), scaled to 1 without friction and compliance
ROUND_OFF = 1e-9  # imaginary part of a real eigenvalue, over it
PLACES = 32  # along the chord, at which sets of neighbouring strips begin and end
DOUBLINGS = 20  # of the steps, in search of some that meet (b)
ROUNDS = 400  # of Newton's steps and, where they do not converge, of the splitting
SPLITTINGS = 20  # in one of ``ROUNDS``
Modes = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]  # omega, Phi_b, Phi_t


class Sliding(NamedTuple):
    """Data of a scheme for a tip that slides with friction."""

    mu: NDArray[np.float64]  # (strips,), t_T over the generalised force, mu / cos g
    A: NDArray[np.float64]  # (rows, rows), m/N, Eq. (a)
    soft: NDArray[np.float64]  # (strips,), m/N, 1/k


def sliding(
    scheme: Scheme, first_t: int, mu: NDArray[np.float64], stiffness: NDArray[np.float64]
) -> Scheme:
    """``scheme``, with tangential rows from ``first_t`` on, whose forces slide.

    ``mu`` (strips,): t_T over the generalised force; ``stiffness`` k (strips,), N/m.
    """
    m, A = len(stiffness), scheme.C.copy()
    A[:, :m] += mu * scheme.C[:, first_t : first_t + m]
    solved_by = Sliding(mu, A, 1 / stiffness)
    return scheme._replace(find_force=find_sliding_force, forces=sliding_forces, sliding=solved_by)


def monotony(
    modes: Modes,
    mu: float,
    zeta: Ratios,
    h: float,
    stiffness: NDArray[np.float64],
) -> float:
    """Smallest eigenvalue of Eq. (b), scaled by sqrt(k) on both sides; a step needs it positive.

    Parameters
    ----------
    modes : omega (n,), rad/s, with radial and tangential displacements over the strips (m, n)
    h : s, step
    stiffness : (m,), k, N/m
    """
    omega, Phi_b, Phi_t = modes
    A = (Phi_b * gain(omega, zeta, h)) @ (Phi_b + mu * Phi_t).T
    root = np.sqrt(stiffness)
    scaled = root[:, None] * A * root
    return float(np.linalg.eigvalsh(np.eye(len(root)) + (scaled + scaled.T) / 2)[0])


def steps_with_one_solution(
    modes: Modes,
    mu: float,
    zeta: Ratios,
    h: float,
    stiffness: NDArray[np.float64],
) -> int:
    """How many times shorter than ``h`` (s) a step, and its half, have one solution, Eq. (b).

    A power of 2, 1 where ``h`` itself is short enough; 0 where none is found.
    """
    shorter = 2.0 ** np.arange(DOUBLINGS)
    unique = [monotony(modes, mu, zeta, h / by, stiffness) >= LEAST for by in shorter]
    if unique[0]:
        return 1
    both = np.flatnonzero(np.array(unique[:-1]) & np.array(unique[1:]))
    return int(shorter[both[0]]) if both.size else 0


def mu_crit(modes: Modes, stiffness: NDArray[np.float64]) -> float:
    """Least friction at which strips that are engaged lock; inf if none do.

    Of any set of neighbouring strips: gaps are linear along the chord, so that contact begins at an
    end, but strips there may be worn free. Of more than ``PLACES`` strips, any alone, and the sets
    between so many places of the chord. Parameters as of ``monotony``.
    """
    omega, Phi_b, Phi_t = modes
    static = Phi_b / omega**2
    S, C_rt = np.diag(1 / stiffness) + static @ Phi_b.T, static @ Phi_t.T
    m = len(stiffness)
    ends = np.unique(np.ceil(m * np.linspace(0, 1, PLACES + 1)).astype(int)).tolist()
    sets = [slice(i, i + 1) for i in range(m)]
    sets += [slice(*pair) for pair in combinations(ends, 2)]
    most = max(_most(np.linalg.solve(S[part, part], -C_rt[part, part])) for part in sets)
    return float(1 / most) if most > 0 else np.inf


def _most(A: NDArray[np.float64]) -> float:
    """Largest positive real eigenvalue; 0 without one."""
    eigenvalues = np.linalg.eigvals(A)
    return float(
        eigenvalues.real[np.abs(eigenvalues.imag) <= ROUND_OFF * np.abs(eigenvalues)].max(
            initial=0.0
        )
    )


def growth_rate(modes: Modes, mu: float, zeta: Ratios, stiffness: NDArray[np.float64]) -> float:
    """Rate (1/s) at which the blade moves away from rest with all strips engaged; < 0: it decays.

    Parameters as of ``monotony``.
    """
    omega, Phi_b, Phi_t = modes
    K = np.diag(omega**2) + (Phi_b + mu * Phi_t).T @ (stiffness[:, None] * Phi_b)
    free = np.zeros_like(K), np.eye(len(omega))
    motion = np.block([[*free], [-K, -2 * zeta * np.diag(omega)]])
    return float(np.linalg.eigvals(motion).real.max())


@compiled
def split(strips, covered, soft, solver, n):
    """One step of the splitting: ``shift`` is its variable, a displacement, ``change`` the other F.

    (A + s + g) F' = v + 2 g F - y, then y += g (F' - F), F solving F^-1(F) + (g - s) F = y.
    """
    A, other = solver.matrix, solver.change
    for p in range(n):
        unknown, c = solver.unknowns[p], abs(solver.C[p, p])
        unknown.w, F, _ = solve_strip(
            strips, covered, unknown.strip, unknown.shift, c, np.inf, solver.F[p]
        )
        solver.F[p], g = F, c + soft[unknown.strip]
        other[p] = unknown.v + 2 * g * F - unknown.shift
        for q in range(n):
            A[p, q] = solver.C[p, q]
        A[p, p] += soft[unknown.strip] + g
    eliminate(A, n)
    substitute(A, other, n)
    for p in range(n):
        unknown = solver.unknowns[p]
        unknown.shift += (abs(solver.C[p, p]) + soft[unknown.strip]) * (other[p] - solver.F[p])


@compiled
def solve_sliding(strips, covered, soft, solver, count):
    """Forces F and places w of the ``count`` active strips; False where not found.

    Those of a tip that leans by ``solve``: the splitting asks for R_i.
    """
    if len(strips.rows) == 2:
        return solve(strips, covered, solver, count)
    n = np.uint64(count)
    for number in range(ROUNDS):
        copy(solver.F, solver.start, n)
        if newton_on_strips(strips, covered, solver, n):
            return True
        copy(solver.start, solver.F, n)
        if number == 0:
            places_under_forces(solver, n)
            for p in range(n):
                unknown = solver.unknowns[p]
                unknown.shift = unknown.w + abs(solver.C[p, p]) * solver.F[p]
        for _ in range(SPLITTINGS):
            split(strips, covered, soft, solver, n)
    return False


@compiled
def sliding_forces(scheme, strips, state, count):
    """Forces F and places w of the first ``count`` active strips; False where not found."""
    for p in range(count):  # of the forces: a moment has no tangential part
        unknown = state.solver.unknowns[p * len(strips.rows)]
        unknown.tau = scheme.sliding.mu[unknown.strip]
    couple(scheme.sliding.A, strips, state.solver, count, False)
    return solve_sliding(strips, state.covered, scheme.sliding.soft, state.solver, count)


@compiled
def book_friction(strips, state, step):
    """Work of the tangential forces on the blade, frictional heat, and the least sliding speed."""
    u, force, energies = state.motion.u, state.motion.force, state.energies
    first_t = strips.first_t
    for i in range(strips.g0.size):
        t_T = force[first_t + i]
        if t_T > 0.0:
            way = u[step.now, first_t + i] - u[step.last, first_t + i]
            arc = strips.advance * strips.pitch[i]  # Omega r h
            energies[FRICTION] -= t_T * way
            energies[HEAT] += t_T * (arc + way)
            state.slowest[0] = min(state.slowest[0], 1 + way / arc)


@compiled
def find_sliding_force(scheme, strips, state, step):
    """As ``find_force``, and book the friction."""
    pressed = find_force(scheme, strips, state, step)
    book_friction(strips, state, step)
    return pressed
