"""A casing that moves: its modes are columns beside those of the blade.

Of a pair of n diameters the casing moves outward by a cos(n phi) + b sin(n phi), phi in the casing.
The kernel marches the pair in the frame of the blade in the middle of each step, theta = phi -
Omega t, in which the rods stand still over the step,

    p = a cos(n Omega t) + b sin(n Omega t),    q = -a sin(n Omega t) + b cos(n Omega t).

At the start of a step both coordinates of p and q turn by n Omega h: what is turned are velocities
in the standing frame, in which the damping acts. Within the step they are modes as those of the
blade, whose rows take the casing from the tip: u is *tip less casing*. Turning changes u without
moving the blade, as the liner does that the casing brings under the tip, and is its work.

The casing takes all of the contact force: of a casing with slope s its radial part and -s times
that along the axis; and its tangential part, where there is one.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from simulate.contact import travelling
from simulate.contact.compiled import compiled, compiled_sums
from simulate.contact.ledger import ON_CASING
from simulate.contact.places import Places
from simulate.contact.travelling import STANDING, Waves
from simulate.marching import piecewise_exact
from simulate.marching.modal import Motion, Scheme
from simulate.scene.casing_modes import CasingMode
from simulate.scene.damping import Ratios

LONGEST_FOOTPRINT = 0.1  # n L / (2 R): half the phase of a mode over the arc L of one row
PER_LOBE, FINE = 64, 1.3e-3  # places around the casing in a period of the highest order; to 0.13 %
FEWER = 8  # of these places are looked at first: one in so many
BETWEEN = 1 / np.cos(np.pi * FEWER / PER_LOBE)  # the largest between these over that at them
type Rows = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]


class Turning(NamedTuple):
    """Columns of the casing, as the kernel reads them."""

    columns: tuple[int, int]  # first of them, and the one after the last
    pairs: NDArray[np.int64]  # (pairs,), first column of each
    sine: NDArray[np.float64]  # (pairs,), of n Omega h
    versine: NDArray[np.float64]  # (pairs,), 1 - cos(n Omega h)
    rows: NDArray[np.float64]  # (pairs, 2, rows), interface rows of each


@compiled_sums
def turn(scheme, motion, last):
    """Turn the pairs to the frame of a step that begins at turn ``last``, and displace its rows."""
    x, y, u, turning = motion.x, motion.y, motion.u, scheme.turning
    motion.came[:] = 0.0
    for p in range(turning.pairs.size):
        k, sine, versine = turning.pairs[p], turning.sine[p], turning.versine[p]
        x_p, x_q, y_p, y_q = x[last, k], x[last, k + 1], y[last, k], y[last, k + 1]
        # by the changes: the sum of squares is kept to their round-off
        way_p, way_q = sine * x_q - versine * x_p, -sine * x_p - versine * x_q
        x[last, k], x[last, k + 1] = x_p + way_p, x_q + way_q
        y[last, k] = y_p + (sine * y_q - versine * y_p)
        y[last, k + 1] = y_q - (sine * y_p + versine * y_q)
        for row in range(u.shape[1]):
            came = turning.rows[p, 0, row] * way_p + turning.rows[p, 1, row] * way_q
            u[last, row] += came
            motion.came[row] += came


@compiled
def book(scheme, strips, state, step):
    """Book the work of the contact forces on the casing."""
    motion, columns = state.motion, scheme.turning.columns
    for k in range(columns[0], columns[1]):
        way = motion.x[step.now, k] - motion.x[step.last, k]
        state.energies[ON_CASING] -= motion.modal[k] * way


@compiled
def follow(strips, state, step):
    """A casing that comes as the tip passes along it: each rod has moved since the last contact."""
    for i in range(strips.g0.size):
        strip = state.covered.strips[i]
        strip.ramp, strip.came = np.nan, state.motion.came[i]


@compiled
def follow_both(strips, state, step):
    """The same of a casing that travels, too."""
    travelling.follow(strips, state, step)
    follow(strips, state, step)


@compiled
def approach(strips, strip, k):
    """How far the casing comes in the step, m."""
    return strip.came


@compiled
def approach_both(strips, strip, k):
    """The same of a casing that travels, too."""
    return travelling.approach(strips, strip, k) + strip.came


@dataclass(frozen=True)
class Moving:
    """Modes of the casing as columns, c of them: two of each pair, one of each of order 0."""

    order: NDArray[np.int64]  # (c,), nodal diameters
    twin: NDArray[np.bool_]  # (c,), whether it is the second of a pair
    omega: NDArray[np.float64]  # (c,), rad/s
    zeta: NDArray[np.float64]  # (c,), damping ratios
    radial: NDArray[np.float64]  # (c,), kg^-1/2, radial motion by a coordinate of 1
    rows: Rows  # (m, c) each: closing, tangential and of the lean, as those of the blade

    def beside(
        self, rows: Rows, omega: NDArray[np.float64], zeta: Ratios
    ) -> tuple[Rows, NDArray[np.float64], Ratios]:
        """``rows``, frequencies and damping of the blade with those of the casing after them."""
        if not self.order.size:
            return rows, omega, zeta
        closing, along, lean = map(np.hstack, zip(rows, self.rows, strict=True))
        zetas = np.concatenate([np.full(omega.size, zeta), self.zeta])
        return (closing, along, lean), np.concatenate([omega, self.omega]), zetas

    def turned(self, scheme: Scheme, first: int, angle: float) -> Scheme:
        """``scheme``, whose columns from ``first`` on turn by n times an ``angle``, rad, a step."""
        if not self.order.size:
            return scheme
        pairs, angles = first + np.flatnonzero(self.twin) - 1, self.order[self.twin] * angle
        turning = Turning(
            columns=(first, first + self.order.size),
            pairs=pairs,
            sine=np.sin(angles),
            versine=2 * np.sin(angles / 2) ** 2,
            rows=np.stack([scheme.Phi.T[pairs], scheme.Phi.T[pairs + 1]], axis=1),
        )
        return scheme._replace(turn=turn, book=book, turning=turning)

    def time_constant(self, Omega: float) -> float:
        """Longest time constant of the modes, revolutions at ``Omega``; inf without damping."""
        with np.errstate(divide="ignore"):
            return float((Omega / (2 * np.pi * self.zeta * self.omega)).max(initial=0.0))

    def under(self, waves: Waves) -> Waves:
        """Harmonics of the casing, as the kernel meets them on one that moves."""
        if not self.order.size:
            return waves
        if waves is STANDING:
            return waves._replace(follow=follow, approach=approach)
        return waves._replace(follow=follow_both, approach=approach_both)

    def energies(self, h: float, motion: Motion, now: int, first: int) -> tuple[float, float]:
        """Kinetic and elastic energy, J, at turn ``now``; its columns begin at ``first``."""
        x, y = (z[[now], first : first + self.order.size] for z in (motion.x, motion.y))
        x, v = piecewise_exact.motion_of(self.omega, self.zeta, h, x, y)
        return float(v @ v) / 2, float((self.omega * x) @ (self.omega * x)) / 2


def moving_casing(modes: Sequence[CasingMode], places: Places, along: bool, leans: bool) -> Moving:
    """The ``modes`` of a casing under strips at ``places``.

    ``along``: with rows of the tangential motion; ``leans``: with rows of the lean, where the edges
    of the tip lie half a footprint from the middle.
    """
    both = [(mode, twin) for mode in modes for twin in range(1 + (mode.order > 0))]
    values = [
        (mode.order, twin, 2 * np.pi * mode.frequency_Hz, mode.damping_ratio, *mode.phi)
        for mode, twin in both
    ]
    order, twin, omega, zeta, radial, of_sine, axial = np.reshape(values, (-1, 7)).T
    half, quarter = leans * places.footprint / places.radius / 2, np.pi / 2 * twin
    outward = radial - places.slope[:, None] * axial
    middle, ahead, behind = (
        order * (places.theta + side * half)[:, None] - quarter for side in (0, 1, -1)
    )
    ahead, behind = -outward * np.cos(ahead), -outward * np.cos(behind)
    m = len(places.xi)
    tangential, lean = (-of_sine * np.sin(middle))[: m * along], (ahead - behind)[: m * leans]
    rows = (ahead + behind) / 2, tangential, lean
    return Moving(order.astype(int), twin > 0, omega, zeta, radial, rows)


@dataclass
class CasingMotion:
    """Radial motion of the casing over a run."""

    moving: Moving
    around: NDArray[np.float64]  # (c, angles), m, radial motion by a coordinate of 1
    squares: NDArray[np.float64]  # (c, modes), of the radial values of each mode
    kept: deque[NDArray[np.float64]]  # (samples, c), coordinates in each of the last revolutions
    largest: float = 0.0  # m, anywhere and at any time

    @classmethod
    def room(cls, moving: Moving, rounds: int) -> Self | None:
        """Before the first revolution, of which the last ``rounds`` are kept; None: it is rigid."""
        if not moving.order.size:
            return None
        order, radial, quarter = (
            of[:, None] for of in (moving.order, moving.radial, np.pi / 2 * moving.twin)
        )
        phi = np.linspace(0, 2 * np.pi, PER_LOBE * max(int(order.max()), 1), endpoint=False)
        mode = np.cumsum(~moving.twin)[:, None]
        squares = radial**2 * (mode == np.arange(1, mode.max() + 1))
        around = np.asarray(radial * np.cos(order * phi - quarter), float)
        return cls(moving, around, squares, deque(maxlen=rounds))

    def add(self, x: NDArray[np.float64]) -> None:
        """Add a revolution, or its part: coordinates (samples, c) after steps evenly apart."""
        self.kept.append(x.copy())
        most = np.sqrt((x * x) @ self.squares).sum(axis=1)  # were all at their largest in one place
        near = x[most > self.largest * (1 + FINE)]
        if len(near):  # at some of the angles first: between them no sum of waves is much farther
            far = np.abs(near @ self.around[:, ::FEWER]).max(axis=1)
            near = near[far * BETWEEN > max(far.max(), self.largest)]
            self.largest = float(np.abs(near @ self.around).max(initial=self.largest))

    def spectrum(self) -> NDArray[np.float64]:
        """Amplitudes (modes, bins), m, anywhere around the casing, over the revolutions kept.

        In the frame of the casing, of waves that go with the rotor and against it, together. Bins
        as of ``signals.spectrum``.
        """
        moving, x = self.moving, np.stack(self.kept)
        first = np.flatnonzero(~moving.twin)
        order, numbers = moving.order[first], np.arange(1, x.shape[1] + 1)
        # of the blade, half a step ahead of the frame they are in: the same phase at all times
        theta = 2 * np.pi * numbers[:, None] / x.shape[1]
        z = (x[..., first] + 1j * (order > 0) * x[..., first + (order > 0)]) * moving.radial[first]
        z = (z * np.exp(1j * order * theta)).reshape(-1, len(first))
        waves, bins = np.abs(np.fft.fft(z, axis=0).T) / len(z), np.arange(len(z) // 2 + 1)
        against = waves[:, -bins] * (2 * bins % len(z) > 0)  # where it is another bin
        return waves[:, bins] + against
