"""Contact of the tip with the rods: penetration, Eq. (7), and force, Eq. (17).

The stress of a rod and its wear, Eqs. (9)-(16), are its law's (``scene.laws``).

A step is two moves: the casing brings the rods of its time under the tip, at the displacement of
the step before; then the blade moves. The force of the second move is a mean of Eq. (17) over it,
(1 - w_end) times the mean over the way, plus w_end times the value at its end:

    mean over the way   [psi(end) - psi(start)] / way, psi the elastic energy and plastic work,

so with w_end = 0 the blade pays exactly the work on the rods (a discrete gradient, Gonzalez 1996).
For a force that grows with the penetration the value at the end is at least as much: no w_end
creates energy. Within the step a rod follows the curve of its state before it both ways: the tip
may pass more rods in a step than bear at a time, and those that come while it retreats were never
pressed deeper. Central differences take the value at the end, w_end = 1, as Eq. (20) does.

Rods at the two ends of the footprint carry load in proportion to the part of them that it covers,
at the profile in the middle of that part: the force of a uniform penetration depends neither on nu
nor on where the blade is. (Rods that came and went whole would excite the blade artificially, at
nu Omega.) A rod wears whole, to the deepest reach of the tip over its centre: a step stands for the
interval of its length around the time of its rods, in which the tip goes the way of the step and
slides along. So the errors of wear are of order two in the step, and in 1/nu.

A tip that leans has the penetration w + lean (m / L) at the distance m from its middle, L the
footprint: w the mean of its edges, lean the edge ahead less the edge behind. The lean does work on
the moment, the sum of the rods' forces times their m / L, so a rod bears at one lever m / L all
through a step.
"""

from math import ceil, floor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulate.contact.compiled import FIRST, compiled, records
from simulate.contact.ledger import (
    CASING,
    PLASTIC,
    WORN,
    book_released,
    elastic_energy,
    plastic_work,
    psi,
)
from simulate.contact.strips import (
    Strips,
    apex_of,
    below,
    covered_middle,
    covered_part,
    covered_share,
    leverage,
    offset,
    profile_at,
)

SPARE = 0.05  # of the gap: forces at other strips may lift the tip beyond its forecast
ROD = np.dtype(
    [
        ("part", float),  # of the rod that is covered
        ("stored", float),  # J/m3, elastic energy
        ("at_rest", float),  # m, penetration of a flat tip at w = 0, Eq. (7)
        ("delta_0", float),  # m, penetration at the end of the step, at w = 0
        ("delta_before", float),  # m, the same at the tangential position of the step before
        ("slope", float),  # p'(s)
        ("eps_p", float),  # plastic strain before the blade's move
        ("start", float),  # strain at its start
        ("sigma", float),  # Pa, there
        ("after", float),  # plastic strain that it would yield to there
    ]
)
STRIP = np.dtype(
    [
        ("at", int),  # first rod of the window
        ("passed", float),  # of it that lies behind the window
        ("stored", float),  # J/m3, elastic energy of all rods over their parts
        ("ramp", float),  # share of the casing distortion at the last contact
        ("slid", float),  # rods that the tip passes in the step
        ("moved", float),  # m, half of the tangential displacement in the step
        ("came", float),  # m, by which a casing that moves comes as the tip passes along it
        ("low", int),  # first rod that the tip reaches in the step,
        ("high", int),  # and the first behind it that it does not,
        ("reach", float),  # m, at radial displacements up to this
    ]
)


class Covered(NamedTuple):
    """Rods of each strip at the last step that the tip met any: a window of m + 1 and beside."""

    rods: np.recarray  # (strips, window), ROD
    strips: np.recarray  # (strips,), STRIP
    lever: NDArray[np.float64]  # (strips, window), of each rod's force; (strips, 0) without lean


def nothing_covered(strips: Strips) -> Covered:
    """A tip that has met no rod yet."""
    n = len(strips.g0)
    window = strips.rods_covered + 1 + 2 * strips.partly_covered
    leans = len(strips.rows) == 2
    return Covered(records((n, window), ROD), records(n, STRIP), np.zeros((n, leans * window)))


@compiled
def lifted(strips, covered, i, k, w, lean):
    """Displacement of the tip over rod ``k``, m: where it leans by the lever of the rod."""
    if len(strips.rows) == 1:
        return w
    return w + lean * covered.lever[i, k]


@compiled
def cover(
    strips,
    covered,
    eps_p,
    i,
    step,
    w_before,
    w,
    lean_before,
    lean,
    u_t,
    u_t_before,
    moves,
    energies,
):
    """Find the rods of strip ``i`` under the tip and their penetration, Eq. (7), at w = 0.

    The casing brings them there at ``w_before``, ``lean_before``.

    Parameters
    ----------
    eps_p : (strips, nu), plastic strains
    step : Step
    w_before, w : m, radial displacement over the strip a step before and its forecast
    lean_before, lean : m, the same of the lean
    u_t, u_t_before : m, tangential displacement over the strip now and a step before
    moves : whether the force is that of a move from ``w_before``, or of its end alone
    energies : sums of the ledger, J
    """
    nu = strips.d.size
    x, slid, half = strips.first[i] + step.number * strips.advance, strips.advance, 0.0
    if strips.tangential:
        half = (u_t - u_t_before) / 2
        x += (u_t - 2 * (1 - strips.placed) * half) / strips.pitch[i]
        slid += 2 * half / strips.pitch[i]
    whole = floor(x)
    j = int(whole) % nu  # Eq. (6): the closest rods are those along the radius
    passed = x - whole
    strip = covered.strips[i]
    fresh = book_released(strips, covered, i, j, passed, step.a, energies)
    strip.at, strip.passed, strip.ramp, strip.slid, strip.moved = j, passed, step.a, slid, half
    strip.reach = max(w_before, w) + SPARE * strips.g0[i]
    strip.low, strip.high = rods_reached(strips, strip, i, covered.rods.shape[1])
    supplied = fill(
        strips, covered, eps_p, i, strip.low, strip.high, fresh, w_before, w, lean_before, lean,
        moves,
    )  # fmt: skip
    energies[CASING] += supplied * strips.area[i] * strips.thickness


@compiled
def rods_reached(strips, strip, i, window):
    """First rod of the window that the tip may touch up to ``strip.reach``, and the first behind.

    All of a flat tip's; of another those over which its profile is less than the deepest
    penetration, anywhere on its way in the step.
    """
    tip, pitch, inset = strips.tip, strips.pitch[i], strips.inset[i]
    half = tip.half[i]
    if half == 0.0 or len(strips.rows) == 2 or window > strips.d.size:
        return inset, window - inset
    casing = strip.ramp * (strips.d_window[strip.at] + strips.waves.most)
    depth = casing - strips.g0[i] + strip.reach
    start, end = below(tip, i, depth)
    aside = 0.5 + abs(strip.slid) / 2 + 2 * abs(strip.moved) / pitch  # rods
    middle = -offset(strips, FIRST, strip.passed)
    low, high = inset, window - inset
    if start > -half:
        low = min(max(floor(start / pitch + middle - aside), 0), window)
    if end < half:
        high = max(min(ceil(end / pitch + middle + aside) + 1, window), low)
    return low, high


@compiled
def widen(strips, covered, eps_p, i, w_before, w, lean_before, lean):
    """Take all rods of the window as reached: where forces lift the tip beyond ``reach``."""
    strip, window = covered.strips[i], covered.rods.shape[1]
    for low, high in ((FIRST, strip.low), (strip.high, window)):
        fill(strips, covered, eps_p, i, low, high, FIRST, w_before, w, lean_before, lean, True)
    strip.low, strip.high, strip.reach = 0, window, np.inf


@compiled
def fill(strips, covered, eps_p, i, low, high, fresh, w_before, w, lean_before, lean, moves):
    """Find the rods ``low`` to ``high`` of the window; the energy that they get, J/m3.

    Those from ``fresh`` on the casing has moved; others as of ``cover``.
    """
    strip, nu, profile = covered.strips[i], strips.d.size, strips.tip.half[i] > 0.0
    passed, half, g0, supplied = strip.passed, strip.moved, strips.g0[i], 0.0
    w_from, lean_from = (w_before, lean_before) if moves else (w, lean)
    apex, per_length, leans = apex_of(strips, i, lean), 0.0, len(strips.rows) == 2
    if leans:
        per_length = leverage(strips, i, passed) / strips.length[i]
    j = (strip.at + low) % nu
    for k in range(low, high):
        rod = covered.rods[i, k]
        rod.part = covered_part(strips, i, k, passed)
        if leans:
            covered.lever[i, k] = per_length * covered_middle(strips, i, k, passed)
        rod.at_rest = strip.ramp * strips.d[j] - g0  # delta = -g
        rod.delta_0 = rod.delta_before = rod.at_rest
        if profile:
            middle = strips.pitch[i] * covered_middle(strips, i, k, passed)
            rod.delta_0 -= profile_at(strips.tip, i, middle - 2 * (1 - strips.placed) * half)[0]
            rod.delta_before -= profile_at(strips.tip, i, middle + 2 * strips.placed * half)[0]
            rod.slope = profile_at(strips.tip, i, middle)[1]
        rod.eps_p = eps_p[i, j]
        if apex > -np.inf and strips.pitch[i] * offset(strips, k, passed) < apex:
            # the closest part of the tip has passed the rod, and has worn it before it bears
            rod.eps_p = worn_to(
                strips, covered, i, k, w_from, w, lean_from, lean, 0.5, rod.eps_p, 0.0
            )
        start = lifted(strips, covered, i, k, w_before, lean_before)
        supplied += bring(strips, rod, eps_p[i, j], start, moves, k >= fresh)
        j = j + 1 if j + 1 < nu else 0
    return supplied


@compiled
def bring(strips, rod, eps_p, w_before, moves, fresh):
    """Bring a rod under the tip at ``w_before`` (m): the energy that a ``fresh`` one gets, J/m3."""
    law, start, energy = strips.law, (rod.delta_before + w_before) * (1 / strips.thickness), 0.0
    rod.start, rod.sigma, rod.after = -np.inf, 0.0, rod.eps_p
    if moves:
        rod.start = start
    if rod.part > 0.0 and (moves or fresh):
        sigma, after = 0.0, rod.eps_p
        if start > 0.0:
            sigma, after, _ = law.stress(law.parameters, start, rod.eps_p)
        if moves:
            rod.sigma, rod.after = sigma, after
        if fresh:
            energy = elastic_energy(sigma, start, after) + plastic_work(law, eps_p, after)
    return rod.part * energy


@compiled
def mean_stress(law, rod, eps, w_end):
    """Mean stress of a rod on its way from the strain at the start of the blade's move to ``eps``.

    ``w_end``: weight of the stress at the end.

    Returns
    -------
    float, float, float, float
        Mean stress, Pa; stress (Pa) and plastic strain at the end; slope of the mean, Pa.
    """
    sigma, after, tangent = 0.0, rod.eps_p, 0.0
    if eps > 0.0:
        sigma, after, tangent = law.stress(law.parameters, eps, rod.eps_p)
    way, yielded = eps - rod.start, after - rod.after
    borne = max(eps, rod.eps_p) - max(rod.start, rod.eps_p)  # part of it on which the rod bears
    if way == 0.0 or (yielded == 0.0 and borne == way):
        mean, slope = (rod.sigma + sigma) / 2, tangent / 2
    else:
        # work that sigma all along it would do in excess: without the digits that its parts lose
        excess = (sigma - rod.sigma) / 2 * (borne - yielded)
        if yielded > 0.0:
            excess += sigma * yielded - law.plastic_work(law.parameters, rod.after, after)
        elif yielded < 0.0:
            excess += sigma * yielded + law.plastic_work(law.parameters, after, rod.after)
        per_way = 1 / way
        mean = (sigma * borne - excess) * per_way
        slope = (sigma - mean) * per_way
    return w_end * sigma + (1 - w_end) * mean, sigma, after, w_end * tangent + (1 - w_end) * slope


@compiled
def in_contact(strips, covered, i, w, lean):
    """Whether any rod of strip ``i`` may bear in the step, at ``w``, ``lean`` (m) at its end."""
    strip = covered.strips[i]
    for k in range(np.uint64(strip.low), np.uint64(strip.high)):
        rod = covered.rods[i, k]
        deep = rod.delta_0 + lifted(strips, covered, i, k, w, lean)
        if rod.part > 0.0 and (deep > 0.0 or rod.sigma > 0.0):
            return True
    return False


@compiled
def contact_force(strips, covered, i, w, lean):
    """Force of strip i's rods at ``w``, ``lean`` (m).

    Returns
    -------
    float, float, float, float, float, float
        Radial N, tangential N, moment N (over the footprint, along the lean); slopes, N/m: of the
        radial force with w, with the lean, and of the moment with the lean.
    """
    t_N, t_T, moment, stiffness, crossed, turning = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    strip, per_l = covered.strips[i], 1 / strips.thickness
    for k in range(np.uint64(strip.low), np.uint64(strip.high)):
        rod = covered.rods[i, k]
        eps = (rod.delta_0 + lifted(strips, covered, i, k, w, lean)) * per_l
        if rod.part > 0.0 and (eps > 0.0 or rod.sigma > 0.0):
            mean, _, _, slope = mean_stress(strips.law, rod, eps, strips.w_end[i])
            t_N += rod.part * mean  # Eq. (17), but for A_i
            stiffness += rod.part * slope
            t_T += rod.part * mean * rod.slope
            if len(strips.rows) == 2:
                lever = covered.lever[i, k]
                moment += rod.part * mean * lever
                crossed += rod.part * slope * lever
                turning += rod.part * slope * lever * lever
    area, per_m = strips.area[i], strips.area[i] / strips.thickness  # A_i of Eq. (17)
    of_slopes = stiffness * area / strips.thickness, crossed * per_m, turning * per_m
    return t_N * area, t_T * area, moment * area, *of_slopes


@compiled
def leaning(strips, i, lean_from, lean, share, s):
    """Displacement by the lean at ``s`` (m) from the middle at a ``share`` of the step, m."""
    if len(strips.rows) == 1:
        return 0.0
    way = lean_from + share * (lean - lean_from)
    return way * s / (strips.length[i] * strips.pitch[i])


@compiled
def deepest_reach(strips, covered, i, k, w_from, w, lean_from, lean, first, last):
    """Deepest penetration (m) over the centre of rod ``k``, from ``first`` to ``last`` of the step.

    The tip goes from ``w_from``, ``lean_from`` to ``w``, ``lean`` (m) in the step, and slides by
    ``slid`` rods. A casing that travels, or moves, goes on its way, too, halfway to the place of
    the rod's ``at_rest``.
    """
    strip, tip = covered.strips[i], strips.tip
    approach = strips.waves.approach(strips, strip, k)
    way, at_rest = w - w_from + approach, covered.rods[i, k].at_rest - approach / 2
    if tip.half[i] == 0.0 and len(strips.rows) == 1:
        return at_rest + w_from + max(first * way, last * way)
    slid = strips.pitch[i] * strip.slid
    s = strips.pitch[i] * offset(strips, k, strip.passed) + slid / 2  # at the start
    if tip.curvature[i] > 0.0 and slid != 0.0:  # concave over the step: the summit, if inside
        tilt = tip.tilt - leaning(strips, i, lean_from, lean, 0.5, 1.0)
        summit = -(way / slid + tilt) / (2 * tip.curvature[i])
        first = last = min(max((s - summit) / slid, first), last)
    deep_first = w_from + first * way - profile_at(tip, i, s - first * slid)[0]
    deep_first += leaning(strips, i, lean_from, lean, first, s - first * slid)
    deep_last = w_from + last * way - profile_at(tip, i, s - last * slid)[0]
    deep_last += leaning(strips, i, lean_from, lean, last, s - last * slid)
    return at_rest + max(deep_first, deep_last)


@compiled
def worn_to(strips, covered, i, k, w_from, w, lean_from, lean, share, eps_p, yielded):
    """Plastic strain, from ``eps_p``, to which rod ``k`` wears in the first ``share`` of a step.

    ``yielded``: that to which a flat tip over it brings it at the start of the step, or at its end.
    """
    law, strip = strips.law, covered.strips[i]
    first, last = covered_share(strips, i, k, strip.passed, strip.slid)
    approach = strips.waves.approach(strips, strip, k)
    level = strips.tip.half[i] == 0.0 and len(strips.rows) == 1
    if level and last - first == 1.0 and approach == 0.0:
        return yielded
    if min(last, share) > first:
        eps = deepest_reach(
            strips, covered, i, k, w_from, w, lean_from, lean, first, min(last, share)
        )
        eps *= 1 / strips.thickness
        if eps > eps_p:
            return law.stress(law.parameters, eps, eps_p)[1]
    return eps_p


@compiled
def press(strips, covered, eps_p, i, w, w_from, lean, lean_from, energies):
    """Press the tip to ``w``, ``lean`` (m) into strip i's rods: Eq. (17), wear by Eq. (16).

    The tip comes from ``w_from``, ``lean_from`` (m), for wear.

    Returns
    -------
    float, float, float, float
        Radial and tangential force, N, moment, N, as of ``contact_force``; deepest penetration of a
        rod that bears, m.
    """
    strip, law, nu = covered.strips[i], strips.law, strips.d.size
    j, volume = (strip.at + strip.low) % nu, strips.area[i] * strips.thickness
    per_l = 1 / strips.thickness
    t_N = t_T = moment = deepest = stored = worn = deeper = supplied = 0.0
    first = eps_p[i, j]  # of a footprint all around, which ends on the rod on which it begins
    for k in range(strip.low, strip.high):
        rod, before = covered.rods[i, k], eps_p[i, j] if k < nu else first
        deep = rod.delta_0 + lifted(strips, covered, i, k, w, lean)
        eps, part, after, rod.stored = deep * per_l, rod.part, rod.eps_p, 0.0
        if part > 0.0 and (eps > 0.0 or rod.sigma > 0.0):
            mean, sigma, after, _ = mean_stress(law, rod, eps, strips.w_end[i])
            t_N += part * mean  # Eq. (17), but for A_i
            t_T += part * mean * rod.slope
            if len(strips.rows) == 2:
                moment += part * mean * covered.lever[i, k]
            rod.stored = elastic_energy(sigma, eps, after)
            if sigma > 0.0:
                deepest = max(deepest, deep)
        yielded = max(after, rod.after)
        kept = worn_to(strips, covered, i, k, w_from, w, lean_from, lean, 1.0, eps_p[i, j], yielded)
        wear = plastic_work(law, eps_p[i, j], kept)
        # a rod keeps its yield under its centre: from there it bears next
        if kept != after or k == nu:
            received = rod.stored + plastic_work(law, before, after)
            rod.stored = psi(law, eps, kept) if part > 0.0 and eps > 0.0 else 0.0
            supplied += part * (rod.stored + wear - received)
        deeper += kept - eps_p[i, j]
        eps_p[i, j] = kept  # Eq. (16)
        worn += wear
        supplied += (1 - part) * wear  # it wears whole: the casing pays for the uncovered part
        stored += part * rod.stored
        j = j + 1 if j + 1 < nu else 0
    strip.stored = stored
    # of liner that bears in no step, too (``lengthened``)
    energies[PLASTIC] += worn * volume * strips.lengthened[i]
    energies[WORN] += deeper * volume * strips.lengthened[i]
    energies[CASING] += (supplied + (strips.lengthened[i] - 1) * worn) * volume
    area = strips.area[i]  # A_i of Eq. (17)
    return t_N * area, t_T * area, moment * area, deepest
