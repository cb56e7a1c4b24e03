"""Contact of the interface nodes with their strips of rods: Eqs. (7) and (17).

Strip i has nu rods, rod j centred at theta_j = 2 pi j / nu in the casing frame. A node covers the m
rods whose centres lie within its footprint, m constant, and these share the footprint's area: the
force of a uniform penetration does not depend on nu.
"""

from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d

from simulate.plastic import Plastic, stress


class Strips(NamedTuple):
    """Liner, casing and clearances as the kernel reads them."""

    law: Plastic
    g0: NDArray[np.float64]  # (nodes,), m, clearances
    d: NDArray[np.float64]  # (nu,), m, casing distortion at the rods, inward
    d_window: NDArray[np.float64]  # (nu,), m, largest d over the m rods from rod j on
    first: NDArray[np.float64]  # (nodes,), in [0, nu): first rod under node i at step 0, unrounded
    advance: float  # rods that the blade passes in a step
    m: int  # rods in a footprint
    area: float  # A_j, m2
    thickness: float  # l, m


def rods_in_footprint(footprint: float, radius: float, nu: int) -> int:
    """Whole number of rods nearest to the footprint (m), 0 when it holds less than half a rod."""
    return round(footprint * nu / (2 * np.pi * radius))


def largest_over_window(d: NDArray[np.float64], m: int) -> NDArray[np.float64]:
    """Largest of d[j], ..., d[j + m - 1] around the circumference, (nu,)."""
    return maximum_filter1d(d, m, mode="wrap", origin=-(m // 2))


@numba.njit(error_model="numpy")
def rod_under(strips, i, step):
    """First rod of the footprint of node ``i`` at ``step`` of the round (0 to steps per round)."""
    return int(strips.first[i] + step * strips.advance) % strips.d.size


@numba.njit(error_model="numpy")
def reach(strips, a_first, a_last, first, last, safe):
    """Largest u_r (nodes,), m, that meets no rod from step ``first`` to ``last``, into ``safe``.

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


@numba.njit(error_model="numpy", inline="always")
def contact_forces(strips, u_r, safe, a, step, eps_p, force):
    """Force of every strip on its node at the predicted displacements; wear is updated.

    Parameters
    ----------
    strips : Strips
    u_r : (nodes,) float64, m
        Predicted radial displacements.
    safe : (nodes,) float64, m
        Displacements up to which no rod can be met, of ``reach``; -inf where none is known.
    a : float
        Share of the casing distortion reached.
    step : int
        Step within the round, from 0 to the steps of a round.
    eps_p : (nodes, nu) float64
        Plastic strains, modified in place.
    force : (nodes,) float64, N
        t_N of Eq. (17), modified in place.

    Returns
    -------
    float
        Deepest penetration of a rod that bears, m; 0 without contact.
    """
    deepest = 0.0
    nu = strips.d.size
    for i in range(strips.g0.size):
        force[i] = 0.0
        if u_r[i] <= safe[i]:
            continue
        total = 0.0
        lift = u_r[i] - strips.g0[i]
        j = rod_under(strips, i, step)
        if lift + a * strips.d_window[j] > 0.0:
            for _ in range(strips.m):
                delta = lift + a * strips.d[j]
                if delta > 0.0:
                    sigma, eps_p[i, j] = stress(strips.law, delta / strips.thickness, eps_p[i, j])
                    total += sigma
                    if sigma > 0.0:
                        deepest = max(deepest, delta)
                j = j + 1 if j + 1 < nu else 0
            force[i] = total * strips.area
    return deepest
