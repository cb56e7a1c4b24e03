"""Forces of the strips on the tip at the end of a step, found implicitly.

The tip over strip i, at w_i (its radial displacement, and tau_i times the tangential one since the
forecast), would be at v_i without force; with the compliance C of the interface

    w = v - C F(w)

where F_i(w_i), the force on strip i, grows with w_i, but is neither convex nor smooth (onset,
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

Where the tip leans a strip has two unknowns, one after the other: w and the lean, with the force
and the moment, its gradient again, and a slope of two by two. The same Newton's steps in the places
are taken. Where they do not converge, steps in the forces f go down the energy

    f.C f/2 + sum over i of the energy of strip i at v - C f,    df = (1 + F'C)^-1 (F - f),

of gradient C (f - F), which asks for no R_i. The slope of a strip acts at an arm e: F' = L D L^T, D
diagonal, L = [1 0; e 1]. With C'' = L^T C L both steps have the matrices of one row, 1 + C'' D and
1 + D C'', whose minors are positive: no row is exchanged.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulate.contact.compiled import compiled, compiled_sums, records
from simulate.contact.rods import contact_force

# Of unsigned indices: signed ones may count from the end of an array, which takes a branch each
# and keeps loops from being vectors.
ZERO, ONE, TWO = np.uint64(0), np.uint64(1), np.uint64(2)
TOLERANCE = 1e-13  # of the displacements that are looked for
ULP = 2.3e-16  # round-off of a depth in the liner, over its thickness
FEW = 10  # Newton's steps in the places
DESCENTS = 500  # of the energy; none in most steps, 61 in the worst of 32,000 random ones
FAR = 1e300  # of the tolerance: a finite residual where the tolerance is 0
LEAST_SHARE = 1e-14  # of the diagonal
FLAT_ENOUGH = 0.5  # of the slope of the energy, which is left at the end of a step down
CUTS = 200  # of a bracket: more than a double has bits


APART, DETECTED, ACTIVE = range(3)  # no rod near; over rods; bearing on them, as far as is known


UNKNOWN = np.dtype(
    [
        ("strip", np.uint64),
        ("row", np.uint64),  # of the displacements
        ("v", float),  # m, where it would be without force
        ("w", float),  # m, where it is
        ("top", float),  # m, where it meets the rigid casing
        ("tau", float),  # tangential over radial force
        ("residual", float),  # N
        ("shift", float),  # m, C' times Newton's step
    ]
)
AT_STRIP = np.dtype(
    [
        ("state", int),  # APART, DETECTED or ACTIVE
        ("F", float),  # N, a step before
        ("moment", float),  # N, along the lean, a step before
        ("reaction", float),  # N, of it by the rigid casing itself
        ("casing", float),  # m, penetration at w = 0 into the rigid casing
    ]
)


class Solver(NamedTuple):
    """Unknowns of a step: the first ``n`` are those of the strips that may bear.

    There are as many as strips, or twice as many where the tip leans: w and the lean in turn.
    Entries of sums and eliminations lie next to each other.
    """

    unknowns: np.recarray  # (n,), UNKNOWN
    F: NDArray[np.float64]  # (n,), N, of the unknowns
    slope: NDArray[np.float64]  # (n,), N/m, of F_i, or of R_i
    arm: NDArray[np.float64]  # (n,), of the force of a strip that leans, where its slope acts
    turned: NDArray[np.float64]  # (n,), the arms of ``matrix``
    trial: NDArray[np.float64]  # (n,), N, forces and moments at the places of a tip that leans
    change: NDArray[np.float64]  # (n,), Newton's step: m, or N
    start: NDArray[np.float64]  # (n,), N, from which Newton's steps began
    strips: np.recarray  # (strips,), AT_STRIP
    C: NDArray[np.float64]  # (n, n), m/N
    matrix: NDArray[np.float64]  # (n, n), of Newton's step
    unsolved: NDArray[np.int64]  # (1,), steps in which no forces were found


def new_solver(strips: int, rows: int = 1) -> Solver:
    """Room for the unknowns of so many strips of 1 row, or 2."""
    n = rows * strips
    C, matrix = np.zeros((2, n, n))
    return Solver(
        records(n, UNKNOWN),
        *np.zeros((7, n)),
        strips=records(strips, AT_STRIP),
        C=C,
        matrix=matrix,
        unsolved=np.zeros(1, np.int64),
    )


@compiled
def solve_strip(strips, covered, i, z, c, top, F):
    """Solve w + c F_i(w) = z, w <= top, from the guess ``F``: w, F, and the slope of R_i."""
    low, end, last = -np.inf, min(z, top), np.inf
    high, w = end, min(z - c * F, end)
    for _ in range(CUTS):
        force, _, _, slope, _, _ = contact_force(strips, covered, i, w, 0.0)
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
    force = force - slope * step if share < 2 else (z - w) / c  # pyright: ignore[reportOperatorIssue]
    return w, max(force, 0.0), slope / share


@compiled
def forces_there(strips, covered, solver, F, n):
    """Forces ``F`` at the places of the unknowns, with their slopes; of a lean the moments, too."""
    leans, slope = len(strips.rows) == 2, solver.slope
    for p in range(ZERO, n, TWO if leans else ONE):
        unknown = solver.unknowns[p]
        lean = solver.unknowns[p + ONE].w if leans else 0.0
        F[p], _, moment, slope[p], crossed, turning = contact_force(
            strips, covered, unknown.strip, unknown.w, lean
        )
        if leans:
            solver.arm[p] = e = crossed / slope[p] if slope[p] > 0.0 else 0.0
            F[p + ONE], slope[p + ONE] = moment, max(turning - e * crossed, 0.0)


@compiled
def turn(solver, n):
    """C'' = L^T C L into the matrix."""
    A, C, arm = solver.matrix, solver.C, solver.turned
    copy(solver.arm, arm, n)
    for p in range(n):
        for q in range(ZERO, n, TWO):
            A[p, q], A[p, q + ONE] = C[p, q] + arm[q] * C[p, q + ONE], C[p, q + ONE]
    for p in range(ZERO, n, TWO):
        for q in range(n):
            A[p, q] += arm[p] * A[p + ONE, q]


@compiled
def shear(x, arm, sign, n):
    """L^T x of displacements, or its inverse with ``sign`` -1."""
    for p in range(ZERO, n, TWO):
        x[p] += sign * arm[p] * x[p + ONE]


@compiled
def residual_of_leaning(strips, covered, solver, n):
    """Residual F(v - C f) - f of the forces f, and the largest over its tolerance."""
    worst, blur, f = 0.0, ULP * strips.thickness, solver.F
    places_under_forces(solver, n)
    forces_there(strips, covered, solver, solver.trial, n)
    for p in range(n):
        at, force, slope = solver.unknowns[p], solver.trial[p], solver.slope[p]
        at.residual = force - f[p]
        if force != f[p]:
            _, terms, _ = row_sums(solver.C, p, f, solver.slope, n)
            size = abs(solver.trial[p & ~ONE]) + abs(force)  # a moment may cancel
            stiff = slope + solver.slope[p & ~ONE] * (1 + abs(solver.arm[p & ~ONE])) ** 2
            allowed = stiff * (10 * TOLERANCE * (abs(at.v) + terms) + blur) + 10 * TOLERANCE * size
            worst = max(worst, min(abs(at.residual) / allowed, FAR))
    return worst


@compiled
def residual(strips, covered, solver, n, share):
    """Residual R(z) - F of the active strips, and the largest over its tolerance.

    The tolerance is the round-off of the displacements that add up to z, which may cancel, and
    of the depths of worn rods, which may be far more than a blade moves.
    """
    if len(strips.rows) == 2:
        return residual_of_leaning(strips, covered, solver, n)
    worst, blur = 0.0, ULP * strips.thickness
    for p in range(n):
        at, c, F = solver.unknowns[p], solver.C[p, p], solver.F[p]
        z, terms = at.v - (1 - share) * c * F, abs(at.v) + c * abs(F)
        for q in range(n):
            if q != p:
                moved = solver.C[p, q] * solver.F[q]
                z, terms = z - moved, terms + abs(moved)
        at.w, force, slope = solve_strip(strips, covered, at.strip, z, share * c, at.top, F)
        at.residual, solver.slope[p] = force - F, slope
        if force != F:
            allowed = slope * (10 * TOLERANCE * terms + blur) + 10 * TOLERANCE * force
            worst = max(worst, min(abs(force - F) / allowed, FAR))
    return worst


@compiled
def eliminate(A, n):
    """Eliminate the first ``n`` rows of A: factors below its diagonal, pivots' reciprocals on it.

    No row is exchanged: that is for matrices whose pivots are positive.
    """
    for p in range(n):
        A[p, p] = 1 / A[p, p]
        for q in range(p + ONE, n):
            A[q, p] *= A[p, p]
            factor = A[q, p]
            for k in range(p + ONE, n):
                A[q, k] -= factor * A[p, k]


@compiled
def substitute(A, x, n):
    """Solve A x = b for the eliminated A; ``x`` holds b before."""
    for p in range(n):
        value = x[p]
        for q in range(p + ONE, n):
            x[q] -= A[q, p] * value
    for after in range(n):
        p = n - ONE - after
        value = x[p] * A[p, p]
        x[p] = value
        for q in range(p):
            x[q] -= A[q, p] * value


@compiled
def newton(strips, solver, n, share):
    """Newton's step on F - R = 0: (1 + R' C') dF = residual.

    With R'_i <= 1/D_i the matrix is a positive one, its rows scaled.
    """
    A, C, change, leans = solver.matrix, solver.C, solver.change, len(strips.rows) == 2
    if leans:
        turn(solver, n)
        C = A
    for p in range(n):
        change[p] = solver.unknowns[p].residual
        for q in range(n):
            A[p, q] = solver.slope[p] * C[p, q]
        A[p, p] = 1.0 + (1 - share) * A[p, p]
    if leans:
        for p in range(ZERO, n, TWO):
            change[p + ONE] -= solver.turned[p] * change[p]
    eliminate(A, n)
    substitute(A, change, n)
    if leans:
        for p in range(ZERO, n, TWO):
            change[p + ONE] += solver.turned[p] * change[p]


@compiled
def newton_from(strips, covered, solver, n):
    """Newton's steps with the whole diagonal, from F; False once one does not halve the residual.

    Forces are clipped at 0: no tension. Where the tip leans, with none of the diagonal, unclipped.
    """
    share, least = (1.0, 0.0) if len(strips.rows) == 1 else (0.0, -np.inf)
    last = np.inf
    while True:
        error = residual(strips, covered, solver, n, share)
        if error <= 1.0:
            return True
        if error >= 0.5 * last:
            return False
        last = error
        newton(strips, solver, n, share)
        for p in range(n):
            solver.F[p] = max(solver.F[p] + solver.change[p], least)


@compiled
def diagonal_shift_keeping_C_positive(solver, n):
    """Share of its diagonal without which C is still positive: its elimination says."""
    A, share, positive = solver.matrix, 1.0, False
    while not positive and share > LEAST_SHARE:
        share, positive = share / 4, True
        for p in range(n):
            for q in range(n):
                A[p, q] = solver.C[p, q] * (1 - share if p == q else 1.0)
        eliminate(A, n)
        for p in range(n):
            positive = positive and 0.0 < A[p, p] < np.inf
    return share


@compiled
def slope_along(solver, n):
    """Slope of the energy along Newton's step, N m."""
    slope = 0.0
    for p in range(n):
        unknown = solver.unknowns[p]
        slope -= unknown.shift * unknown.residual
    return slope


@compiled
def descend(strips, covered, solver, n, share):
    """Newton's step with a ``share`` of the diagonal, cut to where the energy has fallen enough."""
    residual(strips, covered, solver, n, share)
    newton(strips, solver, n, share)
    change = solver.change
    for p in range(n):
        diagonal = share * solver.C[p, p] * change[p]
        solver.unknowns[p].shift = row_sum(solver.C, p, change, n) - diagonal
    low, high, slope_low, slope_high = 0.0, 1.0, slope_along(solver, n), 0.0
    length = way = 1.0
    while way != 0.0:
        for p in range(n):
            solver.F[p] += way * change[p]
        residual(strips, covered, solver, n, share)
        slope = slope_along(solver, n)
        if slope <= 0.0 and (length == 1.0 or slope >= FLAT_ENOUGH * slope_low):
            return
        if slope > 0.0:
            high, slope_high = length, slope
        else:
            low, slope_low = length, slope
        cut = slope_low / (slope_low - slope_high)
        last, length = length, low + (high - low) * min(max(cut, 0.1), 0.9)
        way = length - last


@compiled
def copy(values, to, n):
    """Copy the first ``n`` of ``values``."""
    for p in range(n):
        to[p] = values[p]


@compiled_sums
def row_sum(C, p, F, n):
    """Row ``p`` of C F."""
    total = 0.0
    for q in range(n):
        total += C[p, q] * F[q]
    return total


@compiled_sums
def row_sums(C, p, F, slope, n):
    """Row ``p`` of C F, of the absolute values of its terms, and of abs(C) F'."""
    moved = terms = stiff = 0.0
    for q in range(n):
        c, way = C[p, q], C[p, q] * F[q]
        moved += way
        terms += abs(way)
        stiff += abs(c) * slope[q]
    return moved, terms, stiff


@compiled
def places_under_forces(solver, n):
    """Where the strips are under the forces F: w = v - C F."""
    for p in range(n):
        unknown = solver.unknowns[p]
        unknown.w = unknown.v - row_sum(solver.C, p, solver.F, n)


@compiled
def misplaced(strips, covered, solver, n):
    """Forces F(w) with their slopes, and v - C F - w; the largest of these over its tolerance."""
    worst, blur = 0.0, ULP * strips.thickness
    F, slope, change = solver.F, solver.slope, solver.change
    forces_there(strips, covered, solver, F, n)
    for p in range(n):
        unknown = solver.unknowns[p]
        moved, terms, stiff = row_sums(solver.C, p, F, slope, n)
        change[p] = unknown.v - unknown.w - moved
        allowed = 10 * TOLERANCE * (abs(unknown.v) + terms) + blur * stiff
        worst = max(worst, abs(change[p]) - allowed)
    return worst


@compiled
def eliminate_on_places(strips, solver, n):
    """Eliminate 1 + C F'; where the tip leans 1 + C'' D."""
    A, C = solver.matrix, solver.C
    if len(strips.rows) == 2:
        turn(solver, n)
        C = A
    for p in range(n):
        for q in range(n):
            A[p, q] = C[p, q] * solver.slope[q]
        A[p, p] += 1.0
    eliminate(A, n)


@compiled
def newton_on_strips(strips, covered, solver, n):
    """Newton's steps in the places w, without a rigid casing; False where they do not converge.

    They start from the places under the forces F. Each is (1 + C F') dw = v - C F - w.
    """
    F, change, leans = solver.F, solver.change, len(strips.rows) == 2
    places_under_forces(solver, n)
    for number in range(FEW):
        solved = misplaced(strips, covered, solver, n) <= 0.0
        if number == 0 or not solved:  # the last step moves last digits: by the matrix before
            eliminate_on_places(strips, solver, n)
        if leans:
            shear(change, solver.turned, 1.0, n)
        substitute(solver.matrix, change, n)
        if solved:  # where rods are stiff their forces lose digits that the places still have
            for p in range(n):
                F[p] = max(F[p] + solver.slope[p] * change[p], -np.inf if leans else 0.0)
            if leans:
                for p in range(ZERO, n, TWO):
                    F[p + ONE] += solver.turned[p] * solver.slope[p] * change[p]
        if leans:
            shear(change, solver.turned, -1.0, n)
        for p in range(n):
            solver.unknowns[p].w += change[p]
        if solved:
            return True
    return False


@compiled
def solve(strips, covered, solver, count):
    """Forces F and places w of the ``count`` active strips; False where not found."""
    n = np.uint64(count * len(strips.rows))
    if n == 1:
        at, c = solver.unknowns[0], solver.C[0, 0]
        at.w, F, _ = solve_strip(strips, covered, at.strip, at.v, c, at.top, solver.F[0])
        solver.F[0] = F
        return True
    if strips.rigid_depth == np.inf and newton_on_strips(strips, covered, solver, n):
        return True
    if newton_from(strips, covered, solver, n):
        return True
    share = 0.0 if len(strips.rows) == 2 else diagonal_shift_keeping_C_positive(solver, n)
    for _ in range(DESCENTS):
        descend(strips, covered, solver, n, share)
        copy(solver.F, solver.start, n)
        if newton_from(strips, covered, solver, n):
            return True
        copy(solver.start, solver.F, n)
    return False
