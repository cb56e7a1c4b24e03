"""Contact of the tip with the strips of rods: Eqs. (7) and (17).

Strip i has nu rods, rod j centred at theta_j = 2 pi j / nu in the casing frame. Rods at the two
ends of the footprint bear with the part of them that it covers, at the profile in the middle
of that part: the force of a uniform penetration depends neither on nu nor on where the blade is.
(Rods that came and went whole would shake the blade at nu Omega, a sound that no liner makes and
no step likes.) A rod wears whole, while the footprint covers its centre: so the length that wears
at a time does not depend on nu either, and the error of nu goes with 1 / nu^2. A footprint shorter
than a rod is widened to one; where a step passes more rods than it holds, to these: none is jumped
over.

The functions are compiled for a law and a tip: what a scene does not have is not in them.
"""

from functools import cache
from math import floor
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d

from simulate.compiled import compiled, inlined
from simulate.law import Law
from simulate.ledger import CASING, PLASTIC, RELEASED

WEARS_FROM = 0.5  # part of a rod that is covered when its centre is


class Tip(NamedTuple):
    """Profile of the tip, p(s) = tilt (s - apex) + curvature (s^2 - apex^2) >= 0."""

    tilt: float
    curvature: float  # 1/m
    apex: float  # m, where it is closest to the casing: p = 0
    half: float  # m, half of the footprint: |s| <= half


FLAT = Tip(0.0, 0.0, 0.0, 0.0)


class Strips(NamedTuple):
    """Liner, casing, clearances and tip as the kernel reads them."""

    law: Any  # parameters of the law, Pa
    g0: NDArray[np.float64]  # (strips,), m, clearances
    d: NDArray[np.float64]  # (nu,), m, casing distortion at the rods, inward
    d_window: NDArray[np.float64]  # (nu,), m, largest d over the window from rod j, and beside it
    first: NDArray[np.float64]  # (strips,), rods: where the footprint on strip i begins at step 0
    advance: float  # rods that the blade passes in a step
    length: float  # of a footprint, rods
    m: int  # the same, rounded up
    behind: int  # rods behind it that a rounded tip has just left
    area: NDArray[np.float64]  # (strips,), m2, A_j of a rod of each strip
    thickness: float  # l, m
    pitch: NDArray[np.float64]  # (strips,), m, arc from rod to rod
    tip: Tip
    rigid_from: float  # m, penetration from which a rod gives no further; inf where it always does


class Covered(NamedTuple):
    """Rods of each strip at the last step that the tip met any: a window of m + behind + 1."""

    at: NDArray[np.int64]  # (strips,), first rod
    passed: NDArray[np.float64]  # (strips,), of it that lies behind the window
    part: NDArray[np.float64]  # (strips, window), part of each rod that is covered
    stored: NDArray[np.float64]  # (strips, window), J/m3, elastic energy
    loaded: NDArray[np.float64]  # (strips,), J/m3, its sum over the parts
    fresh: NDArray[np.int64]  # (strips,), first of the rods that the casing has moved since
    share: NDArray[np.float64]  # (strips,), share of the casing distortion then
    eps_p: NDArray[np.float64]  # (strips, window), plastic strain before the step
    lift: NDArray[np.float64]  # (strips, window), m, penetration at w = 0
    lift_before: NDArray[np.float64]  # (strips, window), as it was with the displacement before
    slope: NDArray[np.float64]  # (strips, window), p'(s)


def nothing_covered(strips: Strips) -> Covered:
    """A tip that has met no rod yet."""
    nodes = len(strips.g0)
    shape = dict.fromkeys(Covered._fields, (nodes, strips.m + strips.behind + 1)) | dict.fromkeys(
        ("at", "passed", "loaded", "fresh", "share"), (nodes,)
    )
    integer = ("at", "fresh")
    return Covered(
        **{
            name: np.zeros(shape[name], np.int64 if name in integer else np.float64)
            for name in Covered._fields
        }
    )


def rods_in_footprint(footprint: float, radius: float, nu: int) -> float:
    """Length of the footprint (m) in rods."""
    return footprint * nu / (2 * np.pi * radius)


def largest_over_window(d: NDArray[np.float64], m: int) -> NDArray[np.float64]:
    """Largest of d[j], ..., d[j + m - 1] around the circumference, (nu,)."""
    return maximum_filter1d(d, m, mode="wrap", origin=-(m // 2))


@compiled
def rod_under(strips, i, step):
    """First rod of the footprint on strip ``i`` at ``step`` of the round (0 to steps per round)."""
    return int(strips.first[i] + step * strips.advance) % strips.d.size


@compiled
def reach(strips, a_first, a_last, first, last, safe):
    """Largest u_r (strips,), m, that meets no rod from step ``first`` to ``last``, into ``safe``.

    ``a_first`` and ``a_last`` bound the share of the casing distortion. While every u_r stays
    below, no rod needs to be looked at.
    """
    for i in range(strips.g0.size):
        j, end = rod_under(strips, i, first), rod_under(strips, i, last)
        d = strips.d_window[j]
        while j != end:
            j = j + 1 if j + 1 < strips.d.size else 0
            d = max(d, strips.d_window[j])
        safe[i] = strips.g0[i] - max(a_first * d, a_last * d)


@compiled
def reach_displaced(strips, a_first, a_last, step, u, now, safe):
    """As ``reach`` at one ``step``, with the tangential displacements, the second half of ``u``."""
    across = u.shape[1] // 2
    for i in range(strips.g0.size):
        x = strips.first[i] + step * strips.advance + u[now, across + i] / strips.pitch[i]
        d = strips.d_window[floor(x) % strips.d.size]
        safe[i] = strips.g0[i] - max(a_first * d, a_last * d)


@compiled
def offset(strips, k, passed):
    """Distance of rod ``k`` from the camber line, rods; ``passed`` of the first lies behind."""
    return k - passed - strips.behind - (strips.m - 1) / 2


@compiled
def covered_part(strips, k, passed):
    """Part of rod ``k`` that the footprint covers."""
    covered = (strips.length + 1) / 2 - abs(offset(strips, k, passed))
    return min(max(covered, 0.0), 1.0)


@compiled
def covered_middle(strips, k, passed):
    """Distance from the camber line of the middle of what is covered of rod ``k``, rods."""
    x, half = offset(strips, k, passed), strips.length / 2
    return (max(x - 0.5, -half) + min(x + 0.5, half)) / 2


@compiled
def profile_at(tip, s):
    """Profile p (m) at ``s`` (m), and its slope; that of its end for a rod that ends beyond."""
    s = min(max(s, -tip.half), tip.half)
    p = tip.tilt * (s - tip.apex) + tip.curvature * (s * s - tip.apex * tip.apex)
    return p, tip.tilt + 2 * tip.curvature * s


@compiled
def closest_passed(tip, s, swept):
    """The least profile, m, of the part of the tip that has passed ``s`` (m) in a step."""
    if s < tip.apex:
        s = min(s + swept, tip.apex)
    return profile_at(tip, s)[0] if s >= -tip.half else np.inf


@cache
def contact_functions(
    law: type[Law], profile: bool, tangential: bool, ledger: bool
) -> tuple[Any, Any, Any]:
    """Functions ``cover``, ``bearing`` and ``press`` compiled for a law and a tip."""
    stress, plastic_work = inlined(law.stress), inlined(law.plastic_work)

    @compiled
    def cover(strips, covered, eps_p, i, step, a, w_before, u_t, u_t_before, books):
        """Find the rods of strip ``i`` under the tip and their lift; release those left behind.

        A rounded tip also wears what its closest part has passed: else a step would only meet the
        rods where it ends, and leave ridges between.

        Parameters
        ----------
        eps_p : (strips, nu), plastic strains
        step : step of the round
        a : share of the casing distortion reached
        w_before : m, radial displacement over the strip a step before
        u_t, u_t_before : m, tangential displacement over the strip now and a step before
        books : sums of the ledger, J
        """
        last, nu = strips.m + strips.behind, strips.d.size
        x = strips.first[i] + step * strips.advance
        if tangential:
            x += u_t / strips.pitch[i]
        whole = floor(x)
        j = int(whole) % nu
        passed, fresh = x - whole, 0
        if ledger and covered.loaded[i] > 0.0:
            ahead = (j - covered.at[i]) % nu
            if 2 * ahead > nu:  # the tip swings back faster than the blade turns
                ahead -= nu
            left = gained = 0.0
            for k in range(last + 1):
                part = covered_part(strips, k - ahead, passed)
                left += max(covered.part[i, k] - part, 0.0) * covered.stored[i, k]
                gained += max(part - covered.part[i, k], 0.0) * covered.stored[i, k]
            books[RELEASED] += left * strips.area[i] * strips.thickness
            # a rounded tip moves over all its rods, and a casing that grows moves them all
            if not profile and a == covered.share[i] and ahead >= 0:
                met = last + 1 if covered.part[i, last] > 0.0 else last
                fresh = max(met - ahead, 0)
            else:
                gained = left - covered.loaded[i]
            books[CASING] += gained * strips.area[i] * strips.thickness
        covered.at[i], covered.passed[i] = j, passed
        covered.fresh[i], covered.share[i] = fresh, a
        for k in range(last + 1):
            covered.part[i, k] = covered_part(strips, k, passed)
            lift = a * strips.d[j] - strips.g0[i]
            covered.eps_p[i, k] = eps_p[i, j]
            if profile:
                middle = strips.pitch[i] * covered_middle(strips, k, passed)
                p, covered.slope[i, k] = profile_at(strips.tip, middle)
                covered.lift[i, k] = lift - p
                if tangential:
                    p_before, _ = profile_at(strips.tip, middle + u_t - u_t_before)
                    covered.lift_before[i, k] = lift - p_before
                s = strips.pitch[i] * offset(strips, k, passed)
                least = closest_passed(strips.tip, s, strips.advance * strips.pitch[i])
                delta = w_before + lift - least
                if s < strips.tip.apex and delta > 0.0:
                    before = eps_p[i, j]
                    _, after, _ = stress(strips.law, delta / strips.thickness, before)
                    if after > before:
                        covered.eps_p[i, k] = eps_p[i, j] = after
                        if ledger:
                            work = plastic_work(strips.law, before, after)
                            books[PLASTIC] += work * strips.area[i] * strips.thickness
                            books[CASING] += work * strips.area[i] * strips.thickness
            else:
                covered.lift[i, k] = lift
            j = j + 1 if j + 1 < nu else 0

    @compiled
    def bearing(strips, covered, i, w):
        """Force of strip i's rods at ``w`` (m): radial N, tangential N, and its slope, N/m."""
        force = across = slope = 0.0
        for k in range(strips.m + strips.behind + 1):
            delta = covered.lift[i, k] + w
            if delta > 0.0:
                sigma, _, tangent = stress(
                    strips.law, delta / strips.thickness, covered.eps_p[i, k]
                )
                force += covered.part[i, k] * sigma
                slope += covered.part[i, k] * tangent
                if tangential:
                    across += covered.part[i, k] * sigma * covered.slope[i, k]
        return (
            force * strips.area[i],
            across * strips.area[i],
            slope * strips.area[i] / strips.thickness,
        )

    @compiled
    def press(strips, covered, eps_p, i, w, w_before, books):
        """Press the tip to ``w`` (m) into the rods of strip ``i``: wear, energies, force.

        The casing brings the rods under the tip first, at ``w_before``; then the blade moves. What
        it has not moved since the last step still stores what it stored. It also wears what of a
        rod lies beside the tip. A rod whose centre is not covered yields like one that wears, and
        comes back: what that takes is stored.

        Returns
        -------
        float, float, float
            Radial and tangential force, N; deepest penetration of a rod that bears, m.
        """
        l, j, nu, fresh = strips.thickness, covered.at[i], strips.d.size, covered.fresh[i]
        force = across = stored = worn = brought = deepest = 0.0
        for k in range(strips.m + strips.behind + 1):
            part, before, elastic = covered.part[i, k], covered.eps_p[i, k], 0.0
            delta = covered.lift[i, k] + w
            if delta > 0.0 and part > 0.0:
                sigma, after, _ = stress(strips.law, delta / l, before)
                force += part * sigma
                if tangential:
                    across += part * sigma * covered.slope[i, k]
                if sigma > 0.0:
                    deepest = max(deepest, delta)
                if ledger:
                    elastic = sigma * (delta / l - after) / 2
                if after > before:
                    work = plastic_work(strips.law, before, after) if ledger else 0.0
                    if part < WEARS_FROM:
                        elastic += work
                    else:
                        eps_p[i, j] = after
                        if k < nu:  # the last rod is the first where they go all around
                            worn += work
                            brought += (1 - part) * work
            if ledger:
                stored += part * elastic
                covered.stored[i, k] = elastic
            if ledger and k >= fresh:
                delta = (covered.lift_before[i, k] if tangential else covered.lift[i, k]) + w_before
                if delta > 0.0:
                    sigma, after, _ = stress(strips.law, delta / l, before)
                    brought += part * sigma * (delta / l - after) / 2
                    if after > before:
                        brought += part * plastic_work(strips.law, before, after)
            j = j + 1 if j + 1 < nu else 0
        if ledger:
            covered.loaded[i] = stored
            books[PLASTIC] += worn * strips.area[i] * l
            books[CASING] += brought * strips.area[i] * l
        return force * strips.area[i], across * strips.area[i], deepest

    return cover, bearing, press
