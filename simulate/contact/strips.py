"""Liner strips of rods and the tip over them: the gap of Eq. (7) and where it may close.

Strip i has nu rods, rod j centred at theta_j = 2 pi j / nu in the casing frame. The footprint
covers ``length`` rods of a strip, at the two ends a part of one. A footprint shorter than a rod, or
than the blade's way in a step, is lengthened to that, and A_i reduced: the force stays.
"""

from math import floor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d

from simulate.contact.compiled import compiled
from simulate.contact.rod_law import RodLaw
from simulate.contact.travelling import STANDING, Waves


class Tip(NamedTuple):
    """Profile of the tip, p(s) = tilt (s - apex) + curvature (s^2 - apex^2) >= 0."""

    tilt: float
    curvature: float  # 1/m, half of p''
    apex: float  # m, where it is closest to the casing: p = 0
    half: float  # m, half of the footprint: |s| <= half; 0 where the tip is modelled as flat


FLAT = Tip(0.0, 0.0, 0.0, 0.0)


class Strips(NamedTuple):
    """Liner, casing, clearances and tip as the kernel reads them."""

    law: RodLaw
    g0: NDArray[np.float64]  # (strips,), m, clearances
    d: NDArray[np.float64]  # (nu,), m, casing distortion at the rods, inward
    d_end: NDArray[np.float64]  # (nu,), m, the same at the end of a step, where harmonics travel
    d_window: NDArray[np.float64]  # (nu,), m, largest d over the window from rod j, and beside it
    first: NDArray[np.float64]  # (strips,), rods: where the window on strip i begins at step 0
    advance: float  # rods that the blade passes in a step
    length: float  # of a footprint, rods
    rods_covered: int  # the same, rounded up
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
    waves: Waves = STANDING  # travelling harmonics of the casing


def rods_in_footprint(footprint: float, radius: float, nu: int) -> float:
    """Length of the footprint (m) in rods."""
    return footprint * nu / (2 * np.pi * radius)


def largest_over_window(d: NDArray[np.float64], m: int) -> NDArray[np.float64]:
    """Largest of d[j], ..., d[j + m - 1] around the circumference, (nu,)."""
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
    first_t = u.shape[1] // 2
    for i in range(strips.g0.size):
        x = strips.first[i] + step * strips.advance + u[now, first_t + i] / strips.pitch[i]
        d = strips.d_window[floor(x) % strips.d.size]
        u_limit[i] = strips.g0[i] - max(a_first * d, a_last * d)


@compiled
def offset(strips, k, passed):
    """Distance of rod ``k`` of the window from the camber line, rods.

    ``passed``: fraction of a pitch that the blade is past the window's first rod.
    """
    return k - passed - strips.partly_covered - (strips.rods_covered - 1) / 2


@compiled
def covered_part(strips, k, passed):
    """Part of rod ``k`` that the footprint covers."""
    covered = (strips.length + 1) / 2 - abs(offset(strips, k, passed))
    return min(max(covered, 0.0), 1.0)


@compiled
def covered_share(strips, k, passed, slid):
    """Shares of a step at which the footprint first covers the centre of rod ``k``, and last.

    0 and 0 where it does not. ``slid``: rods that the footprint passes in the step.
    """
    x, half = offset(strips, k, passed), abs(slid) / 2
    inside = strips.length / 2 - abs(x)
    if inside >= half:
        return 0.0, 1.0
    share = max(half + inside, 0.0) / (2 * half)
    return (0.0, share) if share == 0.0 or (x < 0.0) == (slid > 0.0) else (1.0 - share, 1.0)


@compiled
def covered_middle(strips, k, passed):
    """Distance from the camber line of the middle of the covered part of rod ``k``, rods."""
    x, half = offset(strips, k, passed), strips.length / 2
    return (max(x - 0.5, -half) + min(x + 0.5, half)) / 2


@compiled
def profile_at(tip, s):
    """Profile p (m) at ``s`` (m), and its slope; that of its end for a rod that ends beyond."""
    s = min(max(s, -tip.half), tip.half)
    p = tip.tilt * (s - tip.apex) + tip.curvature * (s * s - tip.apex * tip.apex)
    return p, tip.tilt + 2 * tip.curvature * s


@compiled
def below(tip, depth):
    """Where the profile is less than ``depth`` (m): from and to, m, within the footprint."""
    if depth <= 0.0:
        return tip.apex, tip.apex
    if tip.curvature == 0.0:  # closest at one end
        way = depth / abs(tip.tilt) if tip.tilt != 0.0 else np.inf
        return max(tip.apex - way, -tip.half), min(tip.apex + way, tip.half)
    lowest = -tip.tilt / (2 * tip.curvature)  # of the parabola, inside the footprint or not
    way = np.sqrt((tip.apex - lowest) ** 2 + depth / tip.curvature)
    return max(lowest - way, -tip.half), min(lowest + way, tip.half)
