"""Mean and alternating stress of a motion, and their margin to the strength of the material.

The cycle of a node is its largest change of stress: of all pairs of instants, the two whose
difference has the largest von Mises stress. Half of that is the alternating stress. The mean stress
is the von Mises stress of the tensor midway, with the sign of its trace. Where the components are
proportional, or of one frequency and in phase, these are the stresses of Manson and McKnight
(Mechanical Fatigue of Metals, 1973). They take half the range of each component, which has no sign:
of components in antiphase, as in torsion seen along the principal directions, the von Mises stress
of the half-ranges is too small, there by the factor sqrt(3). The largest change has no such fault,
and is the same in all axes.

Several frequencies make cycles of several sizes: all are counted as the largest, on the safe side.
"""

from math import sqrt

import numpy as np
from numpy.linalg import norm
from numpy.typing import NDArray

from geometry.blade import Fatigue

MEGA = 1e6
TURNS = 3  # from an instant to the farthest one
LEAST = 1.0  # Pa, the alternating stress of a blade at rest
# The von Mises stress sqrt(3/2 s : s), s the deviator, is the length of these five components of
# (xx, yy, zz, xy, yz, xz).
FIVE = sqrt(3) * np.array(
    [
        [1 / sqrt(3), -0.5 / sqrt(3), -0.5 / sqrt(3), 0, 0, 0],
        [0, 0.5, -0.5, 0, 0, 0],
        [0, 0, 0, 1, 0, 0],
        [0, 0, 0, 0, 1, 0],
        [0, 0, 0, 0, 0, 1],
    ]
)


def von_mises(sigma: NDArray[np.float64]) -> NDArray[np.float64]:
    """Von Mises stress (...) of ``sigma`` (..., 6): xx, yy, zz, xy, yz, xz."""
    return norm(sigma @ FIVE.T, axis=-1)


def largest_cycle(
    sigma: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean stress, with its sign, and alternating stress (nodes,) of ``sigma`` (times, nodes, 6).

    From five instants, at which one of the components of ``FIVE`` is largest, each goes on to that
    farthest from it, and so on. On a line or an ellipse no change is larger than that found; of
    motions of five frequencies less than one node in 100 has one that is larger, by 2 % at most
    (``tests/fem/test_fatigue.py``).
    """
    five = np.ascontiguousarray((sigma @ FIVE.T).transpose(1, 2, 0))  # times last, for speed
    square, nodes = (five**2).sum(axis=1), np.arange(len(five))[:, None]
    at = five.swapaxes(1, 2)
    one = five.argmax(axis=2)
    for _ in range(TURNS):
        away = square[:, None] - 2 * at[nodes, one] @ five  # squares of distances, but for a sum
        one, other = away.argmax(axis=2), one
    change = norm(at[nodes, one] - at[nodes, other], axis=-1)
    best = nodes[:, 0], change.argmax(axis=1)
    one, other = one[best], other[best]
    ends = sigma[one, best[0]], sigma[other, best[0]]
    mean, half = (ends[0] + ends[1]) / 2, (ends[0] - ends[1]) / 2
    return np.copysign(von_mises(mean), mean[:, :3].sum(axis=1)), von_mises(half)


def allowed(mean: NDArray[np.float64], fatigue: Fatigue) -> NDArray[np.float64]:
    """Alternating stress that the material endures at a ``mean`` stress, any shape, Pa.

    By the line of ``fatigue`` for tension; compression earns no credit. Mean and alternating stress
    together stay below yield.
    """
    S_e, S_y, S_u = (
        MEGA * limit for limit in (fatigue.endurance_MPa, fatigue.yield_MPa, fatigue.ultimate_MPa)
    )
    tension = np.maximum(mean, 0.0)
    lowered = {
        "goodman": tension / S_u,
        "gerber": (tension / S_u) ** 2,
        "soderberg": tension / S_y,
    }[fatigue.line]
    return np.maximum(np.minimum(S_e * (1 - lowered), S_y - np.abs(mean)), 0.0)


def margin(
    mean: NDArray[np.float64], alternating: NDArray[np.float64], fatigue: Fatigue
) -> NDArray[np.float64]:
    """Factor by which the alternating stress may grow at this mean stress; below 1 it cracks."""
    return allowed(mean, fatigue) / np.maximum(alternating, LEAST)
