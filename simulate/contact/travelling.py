"""Casing harmonics that travel: d(theta, t) = fixed part + sum of A cos(n (theta - S t) + phase).

S is the speed of a pattern past the casing in the sense of rotation, rad/s; the rods of the liner
stay where they are in the casing, and move in and out with it. S = Omega turns with the blade, as
the orbit of an unbalanced rotor (n = 1) does; time begins with the first revolution.

In each step of contact the distortion is set on the rods near the tip, at the time at which the
scheme takes its rods. Within the step the casing moves on evenly: its way counts where a rod is
worn before or after that time. Displacements that cannot touch follow from the largest of each
harmonic over window and time.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulate.contact.compiled import compiled

SPARE_RODS = 4  # on either side of the window, at which the distortion is set, too
# rows of ``phasor``: at the time of the step's rods, at its end, change
MIDDLE, END, STEP = range(3)


class Waves(NamedTuple):
    """Travelling harmonics as the kernel reads them, and its functions; H of them."""

    begin: Any  # compiled: phases at the start of a revolution
    lower: Any  # compiled: lowers the displacements that meet no rod
    follow: Any  # compiled: sets the distortion of the rods near the tip
    approach: Any  # compiled: how far the casing comes in a step, m
    most: float  # m, the sum of all, anywhere, on its way over a step
    fixed: NDArray[np.float64]  # (nu,), m, distortion without them
    cosine: NDArray[np.float64]  # (H, nu), m, A cos n theta
    sine: NDArray[np.float64]  # (H, nu), m, A sin n theta
    amplitude: NDArray[np.float64]  # (H,), m
    order: NDArray[np.float64]  # (H,)
    phase: NDArray[np.float64]  # (H,), rad
    turn: NDArray[np.float64]  # (H,), rad, n S h
    at: NDArray[np.float64]  # (H,), rad, n S t - phase at the start of the revolution
    phasor: NDArray[np.float64]  # (3, 2, H), cosine and sine of n S t - phase in the step
    way: NDArray[np.float64]  # (nu,), m, by which the casing comes in the step


@compiled
def stands_at_start(strips, steps):
    """A casing that stands."""


@compiled
def stands_below(strips, a_first, a_last, first, last, motion, now):
    """A casing that stands."""


@compiled
def stands_in_step(strips, state, step):
    """A casing that stands."""


@compiled
def no_approach(strips, strip, k):
    """A casing that stands comes by 0 m."""
    return 0.0


def distortion_passed(strips: Any) -> NDArray[np.float64]:
    """Distortion (nu,), m, of each rod as the blade passes it in the first revolution; share 1."""
    waves = strips.waves
    if not waves.order.size:
        return strips.d
    steps = np.arange(strips.d.size) / strips.advance
    phi = np.outer(waves.turn, steps) - waves.phase[:, None]
    return waves.fixed + (waves.cosine * np.cos(phi) + waves.sine * np.sin(phi)).sum(axis=0)


def farthest(strips: Any) -> float:
    """Bound of the inward distortion, m, anywhere and at any time; share 1."""
    waves = strips.waves
    return float(waves.fixed.max() + waves.amplitude.sum() if waves.order.size else strips.d.max())


@compiled
def begin(strips, steps):
    """Phases at the start of a revolution, ``steps`` after the first."""
    waves = strips.waves
    for h in range(waves.order.size):
        waves.at[h] = (steps * waves.turn[h] - waves.phase[h]) % (2 * np.pi)


@compiled
def lower(strips, a_first, a_last, first, last, motion, now):
    """Lower ``motion.free`` by the largest harmonics over the window from step ``first`` to last.

    The cosine of the middle, and as much more as it may change to the ends of the window and of the
    time.
    """
    waves, per_rod, first_t = strips.waves, 2 * np.pi / strips.d.size, strips.first_t
    half = (strips.rods_covered + 1) / 2 + strips.partly_covered + SPARE_RODS  # rods
    number = (first + last) / 2
    for i in range(strips.g0.size):
        rod = strips.first[i] + number * strips.advance + strips.partly_covered
        rod += (strips.rods_covered - 1) / 2
        if strips.tangential:
            rod += motion.u[now, first_t + i] / strips.pitch[i]
        most = 0.0
        for h in range(waves.order.size):
            along = waves.order[h] * per_rod
            middle = along * rod - waves.at[h] - waves.turn[h] * number
            change = along * half
            change += abs(along * strips.advance - waves.turn[h]) * ((last - first) / 2 + 1)
            most += waves.amplitude[h] * min(np.cos(middle) + change, 1.0)
        motion.free[i] -= max(a_first * most, a_last * most)


@compiled
def follow(strips, state, step):
    """Set the distortion of the rods near the tip in a step, and its way in the step."""
    waves, u, nu = strips.waves, state.motion.u, strips.d.size
    first_t, window = strips.first_t, state.covered.rods.shape[1] + 2 * SPARE_RODS
    for h in range(waves.order.size):
        for row, time in ((MIDDLE, step.number - 1 + strips.placed), (END, float(step.number))):
            phase = waves.at[h] + waves.turn[h] * time
            waves.phasor[row, 0, h], waves.phasor[row, 1, h] = np.cos(phase), np.sin(phase)
        # over a step about the time of its rods: 2 sin(turn / 2) times the rate
        half = 2 * np.sin(waves.turn[h] / 2)
        waves.phasor[STEP, 0, h] = -half * waves.phasor[MIDDLE, 1, h]
        waves.phasor[STEP, 1, h] = half * waves.phasor[MIDDLE, 0, h]
    for i in range(strips.g0.size):
        state.covered.strips[i].ramp = np.nan  # every rod has moved since the last contact
        x = strips.first[i] + step.number * strips.advance
        low = high = x
        if strips.tangential:
            low += min(u[step.now, first_t + i], u[step.last, first_t + i]) / strips.pitch[i]
            high += max(u[step.now, first_t + i], u[step.last, first_t + i]) / strips.pitch[i]
        j = int(np.floor(low)) - SPARE_RODS
        count = min(int(np.floor(high)) - int(np.floor(low)) + window, nu)
        for rod in range(j, j + count):
            place(strips, rod % nu, step.a)


@compiled
def place(strips, j, a):
    """Set the distortion of rod ``j`` for the step."""
    waves, phasor = strips.waves, strips.waves.phasor
    d, d_end, way = waves.fixed[j], waves.fixed[j], 0.0
    for h in range(waves.order.size):
        c, s = waves.cosine[h, j], waves.sine[h, j]
        d += c * phasor[MIDDLE, 0, h] + s * phasor[MIDDLE, 1, h]
        d_end += c * phasor[END, 0, h] + s * phasor[END, 1, h]
        way += c * phasor[STEP, 0, h] + s * phasor[STEP, 1, h]
    strips.d[j], strips.d_end[j], waves.way[j] = d, d_end, a * way


@compiled
def approach(strips, strip, k):
    """How far the casing comes in the step at rod ``k`` of the window on a strip, m."""
    return strips.waves.way[(strip.at + k) % strips.d.size]


def waves(
    fixed: NDArray[np.float64],
    harmonics: NDArray[np.float64],
    functions: tuple[Any, ...] = (begin, lower, follow, approach),
) -> Waves:
    """Travelling ``harmonics`` (H, 4) over the ``fixed`` distortion (nu,), m.

    Of each: amplitude, m; order; phase, rad; and the phase n S h, rad, that passes in a step.
    """
    amplitude, order, phase, turn = map(np.ascontiguousarray, harmonics.T)
    angle = order[:, None] * 2 * np.pi * np.arange(len(fixed)) / len(fixed)
    scaled = amplitude[:, None]
    H = len(order)
    return Waves(
        *functions,
        most=float(amplitude @ np.hypot(1, np.sin(turn / 2))),
        fixed=fixed,
        cosine=scaled * np.cos(angle),
        sine=scaled * np.sin(angle),
        amplitude=amplitude,
        order=order,
        phase=phase,
        turn=turn,
        at=np.zeros(H),
        phasor=np.zeros((3, 2, H)),
        way=np.zeros(len(fixed)),
    )


STANDING = waves(
    np.zeros(1),
    np.zeros((0, 4)),
    (stands_at_start, stands_below, stands_in_step, no_approach),
)
