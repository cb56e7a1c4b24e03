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
With a slope of the S-N line they are counted each (``damage``).
"""

from collections.abc import Mapping
from math import inf, sqrt
from typing import Any

import numpy as np
import rainflow
from numpy.linalg import norm
from numpy.typing import NDArray

from geometry.base import known
from geometry.blade import Fatigue

MEGA = 1e6
TURNS = 3  # from an instant to the farthest one
LEAST = 1.0  # Pa, the alternating stress of a blade at rest
ENDURED = 1e7  # cycles of the endurance
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
    return norm(sigma @ FIVE.T.astype(sigma.dtype), axis=-1)


def mean_and_half(
    one: NDArray[np.float64], other: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean stress, with its sign, and alternating stress (nodes,) of two tensors (nodes, 6)."""
    mean = (one + other) / 2
    return np.copysign(von_mises(mean), mean[:, :3].sum(axis=1)), von_mises((one - other) / 2)


def largest_change(five: NDArray[np.float64]) -> NDArray[np.int64]:
    """The two instants (2, nodes) of the largest change of a stress.

    ``five`` (nodes, 5, times): its components of ``FIVE``. From five instants, at which one of them
    is largest, each goes on to that farthest from it, and so on. On a line or an ellipse no change
    is larger than that found; of motions of five frequencies less than one node in 100 has one that
    is larger, by 2 % at most.
    """
    square, nodes = (five**2).sum(axis=1), np.arange(len(five))[:, None]
    at = five.swapaxes(1, 2)
    one = five.argmax(axis=2)
    for _ in range(TURNS):
        away = square[:, None] - 2 * at[nodes, one] @ five  # squares of distances, but for a sum
        one, other = away.argmax(axis=2), one
    change = norm(at[nodes, one] - at[nodes, other], axis=-1)
    best = nodes[:, 0], change.argmax(axis=1)
    return np.stack([one[best], other[best]])


def uniaxial(sigma: NDArray[np.float64]) -> NDArray[np.float64]:
    """A stress with a sign over time (times,), Pa, of ``sigma`` (times, 6) of one node.

    The part of the five components along their largest change, whose range is so twice the
    alternating stress; tension is positive. It is moved by a constant to the mean stress midway.
    """
    five = sigma @ FIVE.T
    ends = largest_change(five.T[None])[:, 0]
    half, (mean, _) = np.diff(sigma[ends], axis=0)[0] / 2, mean_and_half(*sigma[ends][:, None])
    along = FIVE @ half * np.copysign(1 / max(von_mises(half), LEAST), half[:3].sum())
    signal = five @ along
    return signal - signal[ends].mean() + mean


def damage(signal: NDArray[np.float64], fatigue: Fatigue) -> float:
    """Miner's damage of a ``signal`` (times,), Pa, as of ``uniaxial``; it cracks at 1.

    By rainflow (ASTM E1049), a half cycle as half of one. A cycle of amplitude S and mean m takes
    1/N, N = ``ENDURED`` (S_a(m)/S)^k, S_a the line of ``allowed`` and k ``slope_k``: one slope,
    also below the endurance (elementary rule of Miner). None takes more than all.
    """
    cycles = ((span / 2, mean, n) for span, mean, n, *_ in rainflow.extract_cycles(signal) if span)
    S, mean, counts = np.array([*cycles]).reshape(-1, 3).T
    ratio = np.divide(S, limit := allowed(mean, fatigue), out=np.full_like(S, inf), where=limit > 0)
    shares = ratio ** known(fatigue.slope_k, "slope_k") / ENDURED
    return float(counts @ np.minimum(shares, 1.0))


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


def numbers(mean: Any, alternating: Any, fatigue: Fatigue | None) -> dict[str, Any]:
    """Stresses, Pa, and their margin where there is a strength, by name."""
    left = {"margin": margin(mean, alternating, fatigue)} if fatigue else {}
    return {"mean_stress": mean, "alternating": alternating, **left}


def reserve(numbers: Mapping[str, Any]) -> Any:
    """What is least where a motion is worst: the margin, else the alternating stress, negative.

    So too where there is no margin left, that is 0.
    """
    left = numbers.get("margin", 0.0)
    return np.where(np.greater(left, 0.0), left, -numbers["alternating"])
