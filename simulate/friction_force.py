"""Forces of the strips on a sliding tip, w = v - A F(w) with an unsymmetric A.

Newton's steps in the places w are those without friction (``interface_force``). Their matrix
1 + A F' has positive minors under Eq. (b) of ``friction``: no pivots. Where they do not converge,
the forces come from Douglas and Rachford's method, which converges for any sum of two monotone
maps, from anywhere (Lions and Mercier 1979). With s = 1/k it is

    F^-1(F) - s F,    monotone, as F_i grows by at most k_i, and    A F + s F - v, by Eq. (b),

both solved for in turn, at a weight g: one strip after the other, and all by elimination.
"""

import numpy as np

from simulate.compiled import compiled
from simulate.interface_force import newton_on_strips, places_under_forces, solve_strip
from simulate.ledger import FRICTION, HEAT
from simulate.piecewise_exact import settle

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
def split(strips, covered, scheme, solver, count):
    """One step of the splitting: ``shift`` is its variable, a displacement, ``change`` the other F.

    (A + s + g) F' = v + 2 g F - y, then y += g (F' - F), F solving F^-1(F) + (g - s) F = y.
    """
    A, unknowns = solver.matrix, solver.unknowns
    for p in range(count):
        at = unknowns[p]
        c = abs(solver.C[p, p])
        at.w, at.F, _ = solve_strip(strips, covered, at.strip, at.shift, c, np.inf, at.F)
        g = c + scheme.soft[at.strip]
        at.change = at.v + 2 * g * at.F - at.shift
        for q in range(count):
            A[p, q] = solver.C[p, q]
        A[p, p] += scheme.soft[at.strip] + g
    for p in range(count):
        for q in range(p + 1, count):
            factor = A[q, p] / A[p, p]
            for k in range(p + 1, count):
                A[q, k] -= factor * A[p, k]
            unknowns[q].change -= factor * unknowns[p].change
    for p in range(count - 1, -1, -1):
        at = unknowns[p]
        for k in range(p + 1, count):
            at.change -= A[p, k] * unknowns[k].change
        at.change /= A[p, p]
        at.shift += (abs(solver.C[p, p]) + scheme.soft[at.strip]) * (at.change - at.F)


@compiled
def solve_sliding(strips, covered, scheme, solver, count):
    """Forces F and places w of the first ``count`` active strips; False where not found."""
    unknowns = solver.unknowns
    for p in range(count):
        unknowns[p].start = unknowns[p].F
    places_under_forces(solver, count)
    if newton_on_strips(strips, covered, solver, count):
        return True
    for p in range(count):
        unknowns[p].F = unknowns[p].start
    places_under_forces(solver, count)
    for p in range(count):
        unknowns[p].shift = unknowns[p].w + abs(solver.C[p, p]) * unknowns[p].F
    for _ in range(ROUNDS):
        for _ in range(SPLITTINGS):
            split(strips, covered, scheme, solver, count)
        for p in range(count):
            unknowns[p].start = unknowns[p].F
        if newton_on_strips(strips, covered, solver, count):
            return True
        for p in range(count):
            unknowns[p].F = unknowns[p].start
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
def solve_active_sliding(scheme, strips, state, count):
    """Forces of the first ``count`` active strips; False where not found."""
    couple_sliding(scheme, state.solver, count)
    return solve_sliding(strips, state.covered, scheme, state.solver, count)


@compiled
def find_force(scheme, strips, state, step):
    """Forces of a sliding tip, as ``settle`` finds them, and their energies."""
    found = settle(scheme, strips, state, step, solve_active_sliding)
    book_friction(scheme, strips, state, step)
    return found
