"""Forces of the strips on the nodes at the end of a step, found implicitly.

Node i, at w_i along its normal, would be at v_i without force; with the compliance C of the
interface

    w = v - C F(w)

where F_i(w_i) is what strip i bears: it grows with w_i, but is neither convex nor smooth (onset,
yield), or is the reaction of a rigid casing. C is positive, so w minimises a convex energy and is
unique. One node alone is a scalar equation in a bracket. Several are solved in the form

    F_i = R_i(v_i - sum over j != i of C_ij F_j),    R_i(z): the force at w + C_ii F_i(w) = z,

where R_i is a function, and bounded in slope, for a rigid casing, too. Newton's steps on it end
after a few; where one does not approach, sweeps of Gauss-Seidel do, which descend in that energy
(Tseng 2001) and so converge from anywhere.
"""

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulate.compiled import compiled
from simulate.contact import contact_functions
from simulate.law import Law

TOLERANCE = 1e-13  # of the displacements that are looked for
STEPS = 60  # Newton steps or groups of sweeps, before the last resort
SWEEPS = 4  # of Gauss-Seidel between Newton steps
LAST_RESORT = 20_000  # sweeps
CUTS = 200  # of a bracket: more than a double has bits


APART, MET, ACTIVE = range(3)  # no rod near; over rods; bearing on them, as far as is known


class Solver(NamedTuple):
    """Unknowns of a step: those of the ``count`` nodes that may bear, first."""

    active: NDArray[np.int64]  # (nodes,), their numbers
    v: NDArray[np.float64]  # (nodes,), m, where each would be without force
    C: NDArray[np.float64]  # (nodes, nodes), m/N
    F: NDArray[np.float64]  # (nodes,), N
    last: NDArray[np.float64]  # (nodes,), N, of every node, a step before
    held: NDArray[np.float64]  # (nodes,), N, of it by the rigid casing itself
    line: NDArray[np.float64]  # (nodes,), m, of every node: lift of the rigid casing
    w: NDArray[np.float64]  # (nodes,), m
    residual: NDArray[np.float64]  # (nodes,), N
    slope: NDArray[np.float64]  # (nodes,), N/m, of R_i
    matrix: NDArray[np.float64]  # (nodes, nodes), of Newton's step
    top: NDArray[np.float64]  # (nodes,), m, where each meets the rigid casing
    tau: NDArray[np.float64]  # (nodes,), tangential over radial force
    state: NDArray[np.int64]  # (nodes,), of every node: APART, MET or ACTIVE
    unsolved: NDArray[np.int64]  # (1,), steps in which no forces were found


def new_solver(nodes: int) -> Solver:
    """Room for the unknowns of ``nodes`` nodes."""
    of = {"active": (nodes,), "C": (nodes, nodes), "matrix": (nodes, nodes), "unsolved": (1,)}
    integer = ("active", "state", "unsolved")
    return Solver(
        **{
            name: np.zeros(of.get(name, (nodes,)), np.int64 if name in integer else np.float64)
            for name in Solver._fields
        }
    )


@cache
def force_finder(law: type[Law], profile: bool, tangential: bool) -> Any:
    """Function that solves for the forces of the active nodes, compiled for a law and a tip."""
    _, bearing, _ = contact_functions(law, profile, tangential, False)

    @compiled
    def one(strips, covered, i, z, c, top, F):
        """Solve w + c F_i(w) = z, w <= top, from the guess ``F``: w, F, and the slope of R_i."""
        low, end = -np.inf, min(z, top)
        high, w = end, min(z - c * F, end)
        for _ in range(CUTS):
            force, _, slope = bearing(strips, covered, i, w)
            error = w + c * force - z
            step = error / (1 + c * slope)
            if w == end and error <= 0.0:  # no force, or more than the rods': that of the casing
                return end, (z - end) / c, 0.0 if end == z else 1 / c
            if abs(step) <= TOLERANCE * (abs(w) + abs(z)):
                break
            if error > 0.0:
                high, low = w, max(low, z - c * force)  # the force only falls below w
            else:
                low = w
            w -= step
            if w >= high:
                w = end if high == end else (low + high) / 2
            elif w <= low:
                w = (low + high) / 2
        w -= step
        share = 1 + c * slope
        # where rods are stiff their force loses digits that the way left, z - w, still has
        force = force - slope * step if share < 2 else (z - w) / c
        return w, max(force, 0.0), slope / share

    @compiled
    def without(solver, count, p):
        """Displacement of active node ``p`` by its forecast and the others' forces, m."""
        z = solver.v[p]
        for q in range(count):
            if q != p:
                z -= solver.C[p, q] * solver.F[q]
        return z

    @compiled
    def measure(strips, covered, solver, count):
        """Residual of every active node; the largest as a displacement, over the tolerance."""
        worst = 0.0
        for p in range(count):
            z, c = without(solver, count, p), solver.C[p, p]
            solver.w[p], force, solver.slope[p] = one(
                strips, covered, solver.active[p], z, c, solver.top[p], solver.F[p]
            )
            solver.residual[p] = force - solver.F[p]
            allowed = 10 * TOLERANCE * (abs(solver.v[p]) + abs(z) + c * force)
            worst = max(worst, c * abs(solver.residual[p]) / allowed)
        return worst

    @compiled
    def sweep(strips, covered, solver, count):
        """One sweep of Gauss-Seidel over the active nodes."""
        for p in range(count):
            solver.w[p], solver.F[p], solver.slope[p] = one(
                strips,
                covered,
                solver.active[p],
                without(solver, count, p),
                solver.C[p, p],
                solver.top[p],
                solver.F[p],
            )

    @compiled
    def newton(solver, count):
        """Newton's step on F - R = 0: (1 + R' C_off) dF = residual, by elimination.

        No pivots: with R'_i <= 1/C_ii the matrix is a positive one, its rows scaled.
        """
        A, r = solver.matrix, solver.residual
        for p in range(count):
            for q in range(count):
                A[p, q] = 1.0 if p == q else solver.slope[p] * solver.C[p, q]
        for p in range(count):
            for q in range(p + 1, count):
                factor = A[q, p] / A[p, p]
                if factor != 0.0:
                    for k in range(p, count):
                        A[q, k] -= factor * A[p, k]
                    r[q] -= factor * r[p]
        for p in range(count - 1, -1, -1):
            for k in range(p + 1, count):
                r[p] -= A[p, k] * r[k]
            r[p] /= A[p, p]
            solver.F[p] = max(solver.F[p] + r[p], 0.0)

    @compiled
    def solve(strips, covered, solver, count):
        """Forces F and places w of the first ``count`` active nodes; False where not found."""
        if count == 1:
            solver.w[0], solver.F[0], _ = one(
                strips,
                covered,
                solver.active[0],
                solver.v[0],
                solver.C[0, 0],
                solver.top[0],
                solver.F[0],
            )
            return True
        last = np.inf
        for _ in range(STEPS):
            error = measure(strips, covered, solver, count)
            if error <= 1.0:
                return True
            if error < 0.5 * last:
                last = error
                newton(solver, count)
            else:
                last = np.inf
                for _ in range(SWEEPS):
                    sweep(strips, covered, solver, count)
        for n in range(LAST_RESORT):
            sweep(strips, covered, solver, count)
            if n % 100 == 99 and measure(strips, covered, solver, count) <= 1.0:
                return True
        return False

    return solve
