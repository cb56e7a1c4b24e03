"""Liner strips of rods and the tip over them: the gap of Eq. (7) and where it may close.

Strip i has nu rods, rod j centred at theta_j = 2 pi j / nu in the casing frame. The footprint
covers ``length`` rods of it, at the two ends a part of one. A footprint shorter than a rod, or
than the blade's way in a step, is lengthened to that, and A_i reduced: the force stays.
"""

from math import floor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulate.contact.compiled import FIRST, compiled
from simulate.contact.rod_law import RodLaw
from simulate.contact.travelling import STANDING, Waves

MOST_LEVER = 2.0  # the lever of a rod then is the footprint's length at most


class Tip(NamedTuple):
    """Profile of the tip, p(s) = tilt (s - apex) + curvature (s^2 - apex^2) >= 0."""

    tilt: float
    curvature: NDArray[np.float64]  # (strips,), 1/m, half of p''
    apex: NDArray[np.float64]  # (strips,), m, where it is closest to the casing: p = 0
    # (strips,), m, half of the footprint: |s| <= half; 0 where the tip is modelled as flat
    half: NDArray[np.float64]


class Strips(NamedTuple):
    """Liner, casing, clearances and tip as the kernel reads them."""

    law: RodLaw
    g0: NDArray[np.float64]  # (strips,), m, clearances
    d: NDArray[np.float64]  # (nu,), m, casing distortion at the rods, inward
    d_end: NDArray[np.float64]  # (nu,), m, the same at the end of a step, where harmonics travel
    d_window: NDArray[np.float64]  # (nu,), m, largest d over the window from rod j, and beside it
    first: NDArray[np.float64]  # (strips,), rods: where the window on strip i begins at step 0
    advance: float  # rods that the blade passes in a step
    length: NDArray[np.float64]  # (strips,), of a footprint, rods
    lengthened: NDArray[np.float64]  # (strips,), over that given: 1 where it is not lengthened
    rods_covered: int  # of the longest, rounded up
    inset: NDArray[np.int64]  # (strips,), rods at either end of its window that it never covers
    partly_covered: int  # rods on either side of it whose centre it covers for a part of the step
    placed: float  # share of a step after which its rods are those under the tip
    w_end: NDArray[np.float64]  # (strips,), weight of the end of the step in its force
    area: NDArray[np.float64]  # (strips,), m2, A_j of a rod of each strip
    thickness: float  # l, m
    pitch: NDArray[np.float64]  # (strips,), m, arc from rod to rod
    tip: Tip
    touches: bool  # False with law `none`
    tangential: bool  # whether the rods' forces, normal to the profile, have a tangential part
    rigid_depth: float  # m, penetration at which the backing is rigid; inf if never
    first_t: int  # row of the first tangential displacement
    first_lean: int  # row of the first lean, the edge ahead less the edge behind
    lean: NDArray[np.float64]  # (strips,), m, gap ahead less gap behind
    # of the rows of a strip that closes gaps, its middle and where the tip leans its lean: their
    # number is known when the kernel is compiled, so that a lean that is not modelled costs nothing
    rows: tuple[float, ...]
    waves: Waves = STANDING  # travelling harmonics of the casing


def largest_over_window(d: NDArray[np.float64], m: int) -> NDArray[np.float64]:
    """Largest of d[j], ..., d[j + m - 1] around the circumference, (nu,)."""
    from scipy.ndimage import maximum_filter1d  # a slow import, for jobs that march alone

    return maximum_filter1d(d, m, mode="wrap", origin=-(m // 2))


@compiled
def rod_under(strips, i, step):
    """First rod of the window on strip ``i`` at ``step`` of the revolution, from 0."""
    return int(strips.first[i] + step * strips.advance) % strips.d.size


@compiled
def contact_free(strips, a_first, a_last, first, last, u_limit):
    """Largest displacement (strips,), m, that meets no rod from step ``first`` to ``last``.

    Into ``u_limit``. ``a_first`` and ``a_last`` bound the share of the casing distortion. While
    every strip stays below, no rod needs to be looked at.
    """
    for i in range(strips.g0.size):
        j, end = rod_under(strips, i, first), rod_under(strips, i, last)
        d = strips.d_window[j]
        while j != end:
            j = j + 1 if j + 1 < strips.d.size else 0
            d = max(d, strips.d_window[j])
        u_limit[i] = strips.g0[i] - max(a_first * d, a_last * d)


@compiled
def contact_free_displaced(strips, a_first, a_last, step, u, now, u_limit):
    """As ``contact_free`` at one ``step``, with the tangential displacements, u's second half."""
    for i in range(strips.g0.size):
        x = strips.first[i] + step * strips.advance
        x += u[now, strips.first_t + i] / strips.pitch[i]
        d = strips.d_window[floor(x) % strips.d.size]
        u_limit[i] = strips.g0[i] - max(a_first * d, a_last * d)


@compiled
def offset(strips, k, passed):
    """Distance of rod ``k`` of the window from the camber line, rods.

    ``passed``: fraction of a pitch that the blade is past the window's first rod.
    """
    return k - passed - strips.partly_covered - (strips.rods_covered - 1) / 2


@compiled
def covered_part(strips, i, k, passed):
    """Part of rod ``k`` that the footprint of strip ``i`` covers."""
    covered = (strips.length[i] + 1) / 2 - abs(offset(strips, k, passed))
    return min(max(covered, 0.0), 1.0)


@compiled
def part_ahead(x, length):
    """Part of a rod, ``x`` rods from the camber line, that lies ahead of the footprint."""
    return min(max((1 - length) / 2 + x, 0.0), 1.0)


@compiled
def covered_share(strips, i, k, passed, slid):
    """Shares of a step at which the footprint first covers the centre of rod ``k``, and last.

    0 and 0 where it does not. ``slid``: rods that the footprint passes in the step.
    """
    x, half = offset(strips, k, passed), abs(slid) / 2
    inside = strips.length[i] / 2 - abs(x)
    if inside >= half:
        return 0.0, 1.0
    share = max(half + inside, 0.0) / (2 * half)
    return (0.0, share) if share == 0.0 or (x < 0.0) == (slid > 0.0) else (1.0 - share, 1.0)


@compiled
def covered_middle(strips, i, k, passed):
    """Distance from the camber line of the middle of the covered part of rod ``k``, rods."""
    x, half = offset(strips, k, passed), strips.length[i] / 2
    return (max(x - 0.5, -half) + min(x + 0.5, half)) / 2


@compiled
def leverage(strips, i, passed):
    """Factor on the distances of ``covered_middle`` in forces of a tip that leans.

    With it the rods' force and moment under a uniform and a linear penetration are exact wherever
    the blade is: the squares of the distances, over the parts, sum up to length^3 / 12. At most
    ``MOST_LEVER``, for footprints of some 1.1 rods and less.
    """
    length = strips.length[i]
    if length <= 1.0:
        return 1.0
    first = (offset(strips, FIRST, passed) + (1 + length) / 2) % 1.0  # part of the first rod
    whole = floor(length - first)
    last = length - first - whole
    missing = (first**3 + whole + last**3) / length**3
    return 1 / np.sqrt(max(1 - missing, 1 / MOST_LEVER**2))


@compiled
def lean_at(strips, u, turn, i):
    """Penetration of the edge ahead less that of the edge behind, m; 0 where no lean is modelled.

    ``u``: displacements of the rows, in turns.
    """
    if len(strips.rows) == 1:
        return 0.0
    return u[turn, strips.first_lean + i] - strips.lean[i]


@compiled
def closest(strips, w, lean):
    """Displacement of the edge that is closer to the casing, m: of ``w``, where no lean is."""
    return w if len(strips.rows) == 1 else w + abs(lean) / 2


@compiled
def apex_of(strips, i, lean):
    """Where the tip of strip ``i`` is closest to the casing, m; -inf for one that is flat."""
    tip = strips.tip
    if len(strips.rows) == 1:
        return tip.apex[i] if tip.half[i] > 0.0 else -np.inf
    span, half = strips.length[i] * strips.pitch[i], tip.half[i]
    tilt = tip.tilt - lean / span
    if tip.curvature[i] > 0.0:
        return min(max(-tilt / (2 * tip.curvature[i]), -half), half)
    if tilt < 0.0:
        return max(half, span / 2)
    return -half if half > 0.0 else -np.inf


@compiled
def profile_at(tip, i, s):
    """Profile p (m) at ``s`` (m), and its slope; that of its end for a rod that ends beyond."""
    apex, half, curvature = tip.apex[i], tip.half[i], tip.curvature[i]
    s = min(max(s, -half), half)
    p = tip.tilt * (s - apex) + curvature * (s * s - apex * apex)
    return p, tip.tilt + 2 * curvature * s


@compiled
def below(tip, i, depth):
    """Where the profile is less than ``depth`` (m): from and to, m, within the footprint."""
    apex, half, curvature = tip.apex[i], tip.half[i], tip.curvature[i]
    if depth <= 0.0:
        return apex, apex
    if curvature == 0.0:  # closest at one end
        way = depth / abs(tip.tilt) if tip.tilt != 0.0 else np.inf
        return max(apex - way, -half), min(apex + way, half)
    lowest = -tip.tilt / (2 * curvature)  # of the parabola, inside the footprint or not
    way = np.sqrt((apex - lowest) ** 2 + depth / curvature)
    return max(lowest - way, -half), min(lowest + way, half)
