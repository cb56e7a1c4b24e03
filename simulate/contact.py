"""Contact of the tip with the rods: penetration, Eq. (7), and force, Eq. (17).

The stress of a rod and its wear, Eqs. (9)-(16), are its law's (``simulate.laws``).

Rods at the two ends of the footprint carry load in proportion to the part of them that it covers,
at the profile in the middle of that part: the force of a uniform penetration depends neither on nu
nor on where the blade is. (Rods that came and went whole would excite the blade artificially, at
nu Omega.) A rod wears whole, while the footprint covers its centre: so the length that wears at a
time does not depend on nu either, and the error of nu goes with 1 / nu^2.
"""

from math import floor
from typing import NamedTuple

import numpy as np

from simulate.compiled import compiled, records
from simulate.ledger import CASING, PLASTIC, book_left, psi, rod_energies
from simulate.strips import Strips, closest_passed, covered_middle, covered_part, offset, profile_at

WEARS_FROM = 0.5  # part of a rod that is covered when its centre is


ROD = np.dtype(
    [
        ("part", float),  # of the rod that is covered
        ("stored", float),  # J/m3, elastic energy
        ("eps_p", float),  # plastic strain before the step
        ("delta_0", float),  # m, penetration at w = 0
        ("delta_before", float),  # m, the same at the tangential position of the step before
        ("slope", float),  # p'(s)
    ]
)
STRIP = np.dtype(
    [
        ("at", int),  # first rod of the window
        ("passed", float),  # of it that lies behind the window
        ("stored", float),  # J/m3, elastic energy of all rods over their parts
        ("fresh", int),  # first rod whose casing depth changed since the last step
        ("ramp", float),  # share of the casing distortion at the last contact
    ]
)


class Covered(NamedTuple):
    """Rods of each strip at the last step that the tip met any: a window of m + behind + 1."""

    rods: np.recarray  # (strips, window), ROD
    strips: np.recarray  # (strips,), STRIP


def nothing_covered(strips: Strips) -> Covered:
    """A tip that has met no rod yet."""
    n = len(strips.g0)
    return Covered(records((n, strips.rods_covered + strips.behind + 1), ROD), records(n, STRIP))


@compiled
def cover(strips, covered, eps_p, i, step, w_before, u_t, u_t_before, energies):
    """Find the rods of strip ``i`` under the tip and their penetration, Eq. (7), at w = 0.

    Parameters
    ----------
    eps_p : (strips, nu), plastic strains
    step : Step
    w_before : m, radial displacement over the strip a step before
    u_t, u_t_before : m, tangential displacement over the strip now and a step before
    energies : sums of the ledger, J
    """
    nu, profile = strips.d.size, strips.tip.half > 0.0
    x = strips.first[i] + step.number * strips.advance
    if strips.tangential:
        x += u_t / strips.pitch[i]
    whole = floor(x)
    j = int(whole) % nu  # Eq. (6): the closest rods are those along the radius
    passed = x - whole
    strip, g0 = covered.strips[i], strips.g0[i]
    strip.fresh = book_left(strips, covered, i, j, passed, step.a, energies)
    strip.at, strip.passed, strip.ramp = j, passed, step.a
    for k in range(covered.rods.shape[1]):
        rod = covered.rods[i, k]
        rod.part = covered_part(strips, k, passed)
        rod.eps_p = eps_p[i, j]
        at_rest = step.a * strips.d[j] - g0  # Eq. (7) without the displacement; delta = -g
        rod.delta_0 = rod.delta_before = at_rest
        if profile:
            middle = strips.pitch[i] * covered_middle(strips, k, passed)
            p, rod.slope = profile_at(strips.tip, middle)
            rod.delta_0 = rod.delta_before = at_rest - p
            if strips.tangential:
                p, _ = profile_at(strips.tip, middle + u_t - u_t_before)
                rod.delta_before = at_rest - p
            wear_passed(strips, covered, eps_p, i, j, k, at_rest + w_before, energies)
        j = j + 1 if j + 1 < nu else 0


@compiled
def wear_passed(strips, covered, eps_p, i, j, k, deepest, energies):
    """Wear of rod ``j`` by what of a rounded tip has passed it in the step.

    Else a step would only meet the rods where it ends, and leave ridges between. ``deepest`` is the
    penetration (m) of the closest part of the tip.
    """
    law, s = strips.law, strips.pitch[i] * offset(strips, k, covered.strips[i].passed)
    delta = deepest - closest_passed(strips.tip, s, strips.advance * strips.pitch[i])
    if s < strips.tip.apex and delta > 0.0:
        before = eps_p[i, j]
        _, after, _ = law.stress(law.parameters, delta / strips.thickness, before)
        if after > before:
            covered.rods[i, k].eps_p = eps_p[i, j] = after  # Eq. (16)
            work = law.plastic_work(law.parameters, before, after)
            energies[PLASTIC] += work * strips.area[i] * strips.thickness
            energies[CASING] += work * strips.area[i] * strips.thickness


@compiled
def bearing(strips, covered, i, w):
    """Force of strip i's rods at ``w`` (m): radial N, tangential N, and its slope, N/m."""
    law, t_N, t_T, stiffness = strips.law, 0.0, 0.0, 0.0
    for k in range(covered.rods.shape[1]):
        rod = covered.rods[i, k]
        delta = rod.delta_0 + w  # Eq. (7)
        if delta > 0.0:  # below the unworn surface; Eq. (8) over a worn rod is the law's
            sigma, _, tangent = law.stress(law.parameters, delta / strips.thickness, rod.eps_p)
            t_N += rod.part * sigma  # Eq. (17), but for A_i
            stiffness += rod.part * tangent
            t_T += rod.part * sigma * rod.slope
    area = strips.area[i]  # A_i of Eq. (17)
    return t_N * area, t_T * area, stiffness * area / strips.thickness


@compiled
def press(strips, covered, eps_p, i, w, w_before, energies):
    """Press the tip to ``w`` (m) into the rods of strip ``i``: Eq. (17), wear by Eq. (16).

    The casing brings the rods under the tip first, at ``w_before``; then the blade moves.

    Returns
    -------
    float, float, float
        Radial and tangential force, N; deepest penetration of a rod that bears, m.
    """
    strip, law, l, nu = covered.strips[i], strips.law, strips.thickness, strips.d.size
    j, fresh = strip.at, strip.fresh
    t_N = t_T = deepest = stored = worn = brought = 0.0
    for k in range(covered.rods.shape[1]):
        rod = covered.rods[i, k]
        part, before, elastic = rod.part, rod.eps_p, 0.0
        delta = rod.delta_0 + w  # Eq. (7)
        if delta > 0.0 and part > 0.0:
            sigma, after, _ = law.stress(law.parameters, delta / l, before)  # Eqs. (13)-(16)
            t_N += part * sigma  # Eq. (17), but for A_i
            t_T += part * sigma * rod.slope
            if sigma > 0.0:
                deepest = max(deepest, delta)
            wears = part >= WEARS_FROM
            elastic, work = rod_energies(law, delta / l, sigma, before, after, wears)
            if wears and after > before:
                eps_p[i, j] = after  # Eq. (16)
                if k < nu:  # a footprint all around: its first rod is not counted twice
                    worn += work
                    # a partly covered rod wears whole: the casing pays for the uncovered part
                    brought += (1 - part) * work
        rod.stored = elastic
        stored += part * elastic
        delta = rod.delta_before + w_before
        if k >= fresh and delta > 0.0:
            brought += part * psi(law, delta / l, before)
        j = j + 1 if j + 1 < nu else 0
    strip.stored = stored
    energies[PLASTIC] += worn * strips.area[i] * l
    energies[CASING] += brought * strips.area[i] * l
    return t_N * strips.area[i], t_T * strips.area[i], deepest  # A_i of Eq. (17)
