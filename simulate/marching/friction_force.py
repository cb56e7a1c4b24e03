"""Forces of the strips on a sliding tip, w = v - A F(w) with an unsymmetric A.

Newton's steps in the places w are those without friction (``interface_force``). Their matrix
1 + A F' has positive minors under Eq. (b) of ``friction``: no pivots. Where they do not converge,
the forces come from Douglas and Rachford's method, which converges for any sum of two monotone
maps, from anywhere (Lions and Mercier 1979). With s = 1/k it is

    F^-1(F) - s F,    monotone, as F_i grows by at most k_i, and    A F + s F - v, by Eq. (b),

both solved for in turn, at a weight g: one strip after the other, and all by elimination.
"""

import numpy as np

from simulate.contact.compiled import compiled
from simulate.contact.interface_force import (
    copy,
    eliminate,
    newton_on_strips,
    places_under_forces,
    solve_strip,
    substitute,
)
from simulate.contact.ledger import FRICTION, HEAT
from simulate.marching import piecewise_exact

ROUNDS = 400  # of Newton's steps and, where they do not converge, of the splitting
SPLITTINGS = 20  # in a round


@compiled
def couple_sliding(sliding, solver, count):
    """Compliance A between the active strips, and the ratio mu of their forces."""
    for p in range(count):
        i = solver.unknowns[p].strip
        solver.unknowns[p].tau = sliding.mu
        for q in range(count):
            solver.C[p, q] = sliding.A[i, solver.unknowns[q].strip]


@compiled
def split(strips, covered, soft, solver, n):
    """One step of the splitting: ``shift`` is its variable, a displacement, ``change`` the other F.

    (A + s + g) F' = v + 2 g F - y, then y += g (F' - F), F solving F^-1(F) + (g - s) F = y.
    """
    A, other = solver.matrix, solver.change
    for p in range(n):
        at, c = solver.unknowns[p], abs(solver.C[p, p])
        at.w, F, _ = solve_strip(strips, covered, at.strip, at.shift, c, np.inf, solver.F[p])
        solver.F[p], g = F, c + soft[at.strip]
        other[p] = at.v + 2 * g * F - at.shift
        for q in range(n):
            A[p, q] = solver.C[p, q]
        A[p, p] += soft[at.strip] + g
    eliminate(A, n)
    substitute(A, other, n)
    for p in range(n):
        at = solver.unknowns[p]
        at.shift += (abs(solver.C[p, p]) + soft[at.strip]) * (other[p] - solver.F[p])


@compiled
def solve_sliding(strips, covered, soft, solver, count):
    """Forces F and places w of the first ``count`` active strips; False where not found."""
    n = np.uint64(count)
    for number in range(ROUNDS):
        copy(solver.F, solver.start, n)
        if newton_on_strips(strips, covered, solver, n):
            return True
        copy(solver.start, solver.F, n)
        if number == 0:
            places_under_forces(solver, n)
            for p in range(n):
                at = solver.unknowns[p]
                at.shift = at.w + abs(solver.C[p, p]) * solver.F[p]
        for _ in range(SPLITTINGS):
            split(strips, covered, soft, solver, n)
    return False


@compiled
def sliding_forces(scheme, strips, state, count):
    """Forces F and places w of the first ``count`` active strips; False where not found."""
    couple_sliding(scheme.sliding, state.solver, count)
    return solve_sliding(strips, state.covered, scheme.sliding.soft, state.solver, count)


@compiled
def book_friction(strips, state, step):
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
            state.slowest[0] = min(state.slowest[0], 1 + way / arc)


@compiled
def find_force(scheme, strips, state, step):
    """As that of ``piecewise_exact``, and book the friction."""
    found = piecewise_exact.find_force(scheme, strips, state, step)
    book_friction(strips, state, step)
    return found
