"""Forces of the strips on the tip at the end of a step, found implicitly.

The tip over strip i, at w_i (its radial displacement, and tau_i times the tangential one since the
forecast), would be at v_i without force; with the compliance C of the interface

    w = v - C F(w)

where F_i(w_i) is what strip i bears: it grows with w_i, but is neither convex nor smooth (onset,
yield), or is the reaction of a rigid casing. C is positive semidefinite, so w minimises a convex
energy and is unique; with more strips than patches C is singular, and the forces are unique only
over compressible rods. One strip alone is a scalar equation in a bracket. Several are found by
Newton's steps in w; where these do not converge, or a rigid casing is near, in the form

    F_i = R_i(v_i - sum over j of C'_ij F_j),    R_i(z): the force at w + D_i F_i(w) = z,

C' = C - D, D a share of the diagonal of C. R_i is a function, and bounded in slope, for a rigid
casing, too. Newton's steps with the whole diagonal end after a few, but may cycle. Where they do
not converge, steps with a share so small that C' is positive go down the energy

    F.C' F/2 + sum over i of the integral of R_i to v_i - C'F_i,

convex and smooth, of gradient -C' (R - F), until Newton's steps converge from there. A line search
makes Newton's method converge from anywhere on such an energy (Pang 1990).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulate.compiled import compiled, records
from simulate.contact import bearing

TOLERANCE = 1e-13  # of the displacements that are looked for
ULP = 2.3e-16  # round-off of a depth in the liner, over its thickness
FEW = 10  # Newton's steps in the places
STEPS = 5_000  # evaluations; a few in most steps, 900 in the worst of 30,000 random ones
FAR = 1e300  # of what is allowed: a finite residual where nothing is
LEAST_SHARE = 1e-14  # of the diagonal
FLAT_ENOUGH = 0.5  # of the slope of the energy, which is left at the end of a step down
CUTS = 200  # of a bracket: more than a double has bits


AT, LOW, HIGH, SLOPE_LOW, SLOPE_HIGH = range(5)
APART, DETECTED, ACTIVE = range(3)  # no rod near; over rods; bearing on them, as far as is known


UNKNOWN = np.dtype(
    [
        ("strip", int),
        ("v", float),  # m, where it would be without force
        ("w", float),  # m, where it is
        ("F", float),  # N
        ("top", float),  # m, where it meets the rigid casing
        ("tau", float),  # tangential over radial force
        ("residual", float),  # N
        ("slope", float),  # N/m, of R_i
        ("change", float),  # N, Newton's step
        ("shift", float),  # m, C' times Newton's step
        ("start", float),  # N, where the last Newton's steps began
    ]
)
AT_STRIP = np.dtype(
    [
        ("state", int),  # APART, DETECTED or ACTIVE
        ("F", float),  # N, a step before
        ("reaction", float),  # N, of it by the rigid casing itself
        ("casing", float),  # m, penetration at w = 0 into the rigid casing
    ]
)


class Solver(NamedTuple):
    """Unknowns of a step: the first ``count`` are those of the strips that may bear."""

    unknowns: np.recarray  # (strips,), UNKNOWN
    strips: np.recarray  # (strips,), AT_STRIP
    C: NDArray[np.float64]  # (strips, strips), m/N
    matrix: NDArray[np.float64]  # (strips, strips), of Newton's step
    line: NDArray[np.float64]  # (5,), place on Newton's step, its bracket, slopes at its ends
    unsolved: NDArray[np.int64]  # (1,), steps in which no forces were found


def new_solver(n: int) -> Solver:
    """Room for the unknowns of ``n`` strips."""
    C, matrix = np.zeros((2, n, n))
    return Solver(
        records(n, UNKNOWN), records(n, AT_STRIP), C, matrix, np.zeros(5), np.zeros(1, np.int64)
    )


@compiled
def solve_strip(strips, covered, i, z, c, top, F):
    """Solve w + c F_i(w) = z, w <= top, from the guess ``F``: w, F, and the slope of R_i."""
    low, end, last = -np.inf, min(z, top), np.inf
    high, w = end, min(z - c * F, end)
    for _ in range(CUTS):
        force, _, slope = bearing(strips, covered, i, w)
        error = w + c * force - z
        step = error / (1 + c * slope)
        if w == top and error < 0.0:  # more than the rods bear: the casing does, Eq. (8)
            return top, (z - top) / c, 1 / c
        if abs(step) <= TOLERANCE * (abs(w) + abs(z)):
            break
        if error > 0.0:
            high, low = w, max(low, z - c * force)  # the force only falls below w
        else:
            low = w
        w -= step
        if w >= high and high == end:
            w, last = end, np.inf
        elif w >= high or w <= low or 2 * abs(step) > last:  # Newton's steps may cycle
            w, last = (low + high) / 2, high - low
        else:
            last = abs(step)
    w -= step
    share = 1 + c * slope
    # where rods are stiff their force loses digits that the way left, z - w, still has
    force = force - slope * step if share < 2 else (z - w) / c
    return w, max(force, 0.0), slope / share


@compiled
def residual(strips, covered, solver, count, share):
    """Residual R(z) - F of the active strips, and the largest over what is allowed.

    Allowed is what round-off does of the displacements that add up to z, which may cancel, and
    of the depths of worn rods, which may be far more than a blade moves.
    """
    worst, blur = 0.0, ULP * strips.thickness
    for p in range(count):
        at, c = solver.unknowns[p], solver.C[p, p]
        F = at.F
        z, terms = at.v - (1 - share) * c * F, abs(at.v) + c * abs(F)
        for q in range(count):
            if q != p:
                moved = solver.C[p, q] * solver.unknowns[q].F
                z, terms = z - moved, terms + abs(moved)
        at.w, force, at.slope = solve_strip(strips, covered, at.strip, z, share * c, at.top, F)
        at.residual = force - F
        if force != F:
            allowed = at.slope * (10 * TOLERANCE * terms + blur) + 10 * TOLERANCE * force
            worst = max(worst, min(abs(force - F) / allowed, FAR))
    return worst


@compiled
def newton(solver, count, share):
    """Newton's step on F - R = 0: (1 + R' C') dF = residual, by elimination.

    No pivots: with R'_i <= 1/D_i the matrix is a positive one, its rows scaled.
    """
    A, unknowns = solver.matrix, solver.unknowns
    for p in range(count):
        unknowns[p].change = unknowns[p].residual
        for q in range(count):
            A[p, q] = unknowns[p].slope * solver.C[p, q]
        A[p, p] = 1.0 + (1 - share) * A[p, p]
    for p in range(count):
        for q in range(p + 1, count):
            factor = A[q, p] / A[p, p]
            if factor != 0.0:
                for k in range(p, count):
                    A[q, k] -= factor * A[p, k]
                unknowns[q].change -= factor * unknowns[p].change
    for p in range(count - 1, -1, -1):
        change = unknowns[p].change
        for k in range(p + 1, count):
            change -= A[p, k] * unknowns[k].change
        unknowns[p].change = change / A[p, p]


@compiled
def take_newton(solver, count):
    """Take Newton's step; forces are clipped at 0: no tension."""
    for p in range(count):
        at = solver.unknowns[p]
        at.F = max(at.F + at.change, 0.0)


@compiled
def diagonal_shift_keeping_C_positive(solver, count):
    """Share of its diagonal without which C is still positive: its elimination says."""
    A, share, positive = solver.matrix, 1.0, False
    while not positive and share > LEAST_SHARE:
        share, positive = share / 4, True
        for p in range(count):
            for q in range(count):
                A[p, q] = solver.C[p, q] * (1 - share if p == q else 1.0)
        for p in range(count):
            positive = positive and A[p, p] > 0.0
            for q in range(p + 1, count):
                factor = A[q, p] / A[p, p]
                for k in range(p, count):
                    A[q, k] -= factor * A[p, k]
    return share


@compiled
def slope_along(solver, count):
    """Slope of the energy along Newton's step, N m."""
    slope = 0.0
    for p in range(count):
        at = solver.unknowns[p]
        slope -= at.shift * at.residual
    return slope


@compiled
def step_down(solver, count, share):
    """Take Newton's step, and note what tells whether the energy falls along it."""
    line = solver.line
    for p in range(count):
        at = solver.unknowns[p]
        at.shift = -share * solver.C[p, p] * at.change
        for q in range(count):
            at.shift += solver.C[p, q] * solver.unknowns[q].change
        at.F += at.change
    line[AT], line[LOW], line[HIGH] = 1.0, 0.0, 1.0
    line[SLOPE_LOW], line[SLOPE_HIGH] = slope_along(solver, count), 0.0


@compiled
def line_search_done(solver, count):
    """Whether the energy has fallen far enough; else F goes elsewhere on Newton's step."""
    line, at, slope = solver.line, solver.line[AT], slope_along(solver, count)
    if slope <= 0.0 and (at == 1.0 or slope >= FLAT_ENOUGH * line[SLOPE_LOW]):
        return True
    if slope > 0.0:
        line[HIGH], line[SLOPE_HIGH] = at, slope
    else:
        line[LOW], line[SLOPE_LOW] = at, slope
    cut = line[SLOPE_LOW] / (line[SLOPE_LOW] - line[SLOPE_HIGH])
    line[AT] = line[LOW] + (line[HIGH] - line[LOW]) * min(max(cut, 0.1), 0.9)
    for p in range(count):
        solver.unknowns[p].F += (line[AT] - at) * solver.unknowns[p].change
    return line[AT] == at


@compiled
def damped_newton(strips, covered, solver, count):
    """Go down the energy to where Newton's steps approach; False where that is not found."""
    unknowns, last, share, on_line = solver.unknowns, 0.0, 1.0, False
    least = diagonal_shift_keeping_C_positive(solver, count)
    for _ in range(STEPS):
        error = residual(strips, covered, solver, count, share)
        if on_line:
            if line_search_done(solver, count):
                share, last, on_line = 1.0, np.inf, False
            continue
        if share == 1.0:
            if error <= 1.0:
                return True
            if last == np.inf:
                for p in range(count):
                    unknowns[p].start = unknowns[p].F
            if error >= 0.5 * last:
                if last > 0.0:
                    for p in range(count):
                        unknowns[p].F = unknowns[p].start
                share = least
                continue
            last = error
        newton(solver, count, share)
        if share == 1.0:
            take_newton(solver, count)
        else:
            step_down(solver, count, share)
            on_line = True
    return False


@compiled
def places_under_forces(solver, count):
    """Where the strips are under the forces F: w = v - C F."""
    for p in range(count):
        at = solver.unknowns[p]
        at.w = at.v
        for q in range(count):
            at.w -= solver.C[p, q] * solver.unknowns[q].F


@compiled
def misplaced(strips, covered, solver, count):
    """Forces F(w) with their slopes, and v - C F - w; the largest of these over what is allowed."""
    unknowns, worst, blur = solver.unknowns, 0.0, ULP * strips.thickness
    for p in range(count):
        at = unknowns[p]
        at.F, _, at.slope = bearing(strips, covered, at.strip, at.w)
    for p in range(count):
        at = unknowns[p]
        at.change, terms, stiff = at.v - at.w, abs(at.v), 0.0
        for q in range(count):
            moved = solver.C[p, q] * unknowns[q].F
            at.change -= moved
            terms += abs(moved)
            stiff += abs(solver.C[p, q]) * unknowns[q].slope
        worst = max(worst, abs(at.change) - 10 * TOLERANCE * terms - blur * stiff)
    return worst


@compiled
def newton_on_places(solver, count):
    """Take Newton's step on w + C F(w) = v: (1 + C F') dw = v - C F - w, by elimination."""
    A, unknowns = solver.matrix, solver.unknowns
    for p in range(count):
        for q in range(count):
            A[p, q] = solver.C[p, q] * unknowns[q].slope
        A[p, p] += 1.0
    for p in range(count):
        A[p, p] = 1 / A[p, p]
        for q in range(p + 1, count):
            factor = A[q, p] * A[p, p]
            for k in range(p + 1, count):
                A[q, k] -= factor * A[p, k]
            unknowns[q].change -= factor * unknowns[p].change
    for p in range(count - 1, -1, -1):
        for k in range(p + 1, count):
            unknowns[p].change -= A[p, k] * unknowns[k].change
        unknowns[p].change *= A[p, p]
        unknowns[p].w += unknowns[p].change


@compiled
def newton_on_strips(strips, covered, solver, count):
    """Newton's steps in the places w, without a rigid casing; False where they do not converge."""
    for _ in range(FEW):
        solved = misplaced(strips, covered, solver, count) <= 0.0
        newton_on_places(solver, count)
        if solved:  # where rods are stiff their forces lose digits that the places still have
            for p in range(count):
                at = solver.unknowns[p]
                at.F = max(at.F + at.slope * at.change, 0.0)
            return True
    return False


@compiled
def solve(strips, covered, solver, count):
    """Forces F and places w of the first ``count`` active strips; False where not found."""
    if count == 1:
        at = solver.unknowns[0]
        at.w, at.F, _ = solve_strip(strips, covered, at.strip, at.v, solver.C[0, 0], at.top, at.F)
        return True
    if strips.rigid_depth == np.inf:
        places_under_forces(solver, count)
        if newton_on_strips(strips, covered, solver, count):
            return True
    last = np.inf
    while True:
        error = residual(strips, covered, solver, count, 1.0)
        if error <= 1.0:
            return True
        if not error < 0.5 * last:
            return damped_newton(strips, covered, solver, count)
        last = error
        newton(solver, count, 1.0)
        take_newton(solver, count)
