"""Forces of the strips on a sliding tip, w = v - A F(w) with an unsymmetric A.

Newton's steps in the places w are those without friction (``interface_force``). Their matrix
1 + A F' has positive minors under Eq. (b) of ``friction``: no pivots. Where they do not converge,
the forces come from Douglas and Rachford's method, which converges for any sum of two monotone
maps, from anywhere (Lions and Mercier 1979). With s = 1/k it is

    F^-1(F) - s F,    monotone, as F_i grows by at most k_i, and    A F + s F - v, by Eq. (b),

both solved for in turn, at a weight g: one strip after the other, and all by elimination.
"""

import numpy as np

from simulate.contact.compiled import FIRST, compiled
from simulate.contact.interface_force import (
    APART,
    eliminate,
    newton_on_strips,
    places_under_forces,
    remember,
    return_to_start,
    solve_strip,
    substitute,
)
from simulate.contact.ledger import FRICTION, HEAT, WORK
from simulate.marching.piecewise_exact import (
    activate,
    activate_moved,
    detect,
    displace,
    press_detected,
    widen_reached,
)

ROUNDS = 400  # of Newton's steps and, where they do not converge, of the splitting
SPLITTINGS = 20  # in a round


@compiled
def couple_sliding(scheme, solver, count):
    """Compliance A between the active strips, and the ratio mu of their forces."""
    for p in range(count):
        i = solver.unknowns[p].strip
        solver.unknowns[p].tau = scheme.mu
        for q in range(count):
            solver.C[p, q] = scheme.A[i, solver.unknowns[q].strip]


@compiled
def split(strips, covered, scheme, solver, n):
    """One step of the splitting: ``shift`` is its variable, a displacement, ``change`` the other F.

    (A + s + g) F' = v + 2 g F - y, then y += g (F' - F), F solving F^-1(F) + (g - s) F = y.
    """
    A, other = solver.matrix, solver.change
    for p in range(n):
        at, c = solver.unknowns[p], abs(solver.C[p, p])
        at.w, F, _ = solve_strip(strips, covered, at.strip, at.shift, c, np.inf, solver.F[p])
        solver.F[p], g = F, c + scheme.soft[at.strip]
        other[p] = at.v + 2 * g * F - at.shift
        for q in range(n):
            A[p, q] = solver.C[p, q]
        A[p, p] += scheme.soft[at.strip] + g
    eliminate(A, n)
    substitute(A, other, n)
    for p in range(n):
        at = solver.unknowns[p]
        at.shift += (abs(solver.C[p, p]) + scheme.soft[at.strip]) * (other[p] - solver.F[p])


@compiled
def solve_sliding(strips, covered, scheme, solver, count):
    """Forces F and places w of the first ``count`` active strips; False where not found."""
    n = np.uint64(count)
    remember(solver, n)
    if newton_on_strips(strips, covered, solver, n):
        return True
    return_to_start(solver, n)
    places_under_forces(solver, n)
    for p in range(n):
        at = solver.unknowns[p]
        at.shift = at.w + abs(solver.C[p, p]) * solver.F[p]
    for _ in range(ROUNDS):
        for _ in range(SPLITTINGS):
            split(strips, covered, scheme, solver, n)
        remember(solver, n)
        if newton_on_strips(strips, covered, solver, n):
            return True
        return_to_start(solver, n)
    return False


@compiled
def book_friction(scheme, strips, state, step):
    """Work of the tangential forces on the blade, frictional heat, and the least sliding speed."""
    u, force, energies = state.motion.u, state.motion.force, state.energies
    first_t = u.shape[1] // 2
    for i in range(strips.g0.size):
        t_T = force[first_t + i]
        if t_T > 0.0:
            way = u[step.now, first_t + i] - u[step.last, first_t + i]
            arc = strips.advance * strips.pitch[i]  # Omega r h
            energies[FRICTION] -= t_T * way
            energies[HEAT] += t_T * (arc + way)
            scheme.slowest[0] = min(scheme.slowest[0], 1 + way / arc)


@compiled
def find_force(scheme, strips, state, step):
    """As that of ``piecewise_exact``, for a sliding tip.

    Returns
    -------
    bool, float, int
        Whether any strip bears; deepest penetration, m, and its strip.
    """
    motion, solver = state.motion, state.solver
    u, force, moved = motion.u, motion.force, motion.moved
    force[:] = 0.0
    moved[:] = 0.0
    count, solved = FIRST, False
    for i in range(strips.g0.size):
        solver.strips[i].state = APART
        if (
            max(u[step.now, i], u[step.last, i]) > motion.free[i]
            or state.covered.strips[i].stored > 0.0
        ):
            detect(strips, state, step, i)
            count = activate(strips, state, i, count, u[step.now, i], u[step.now, i])
    while count > 0 and not solved:
        couple_sliding(scheme, solver, count)
        if not solve_sliding(strips, state.covered, scheme, solver, count):
            solver.unsolved[0] += 1
        displace(scheme.C, solver, count, True, motion)
        wider = widen_reached(strips, state, step, count)
        more = activate_moved(strips, state, step, count)
        solved, count = more == count and not wider, more
    for row in range(u.shape[1]):
        u[step.now, row] -= moved[row]
    touched, deepest, where = press_detected(strips, state, step, count)
    for i in range(strips.g0.size):
        solver.strips[i].F = force[i]
    for row in range(u.shape[1]):
        state.energies[WORK] -= force[row] * (u[step.now, row] - u[step.last, row])
    book_friction(scheme, strips, state, step)
    return touched, deepest, where
