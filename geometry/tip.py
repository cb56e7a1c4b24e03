"""Chord and camber line of the tip, from the outline of its facets, and its taper.

The tip is developed in a plane, s = r theta and z, with its mean radius r. The chord joins both
ends of the camber line; the chord fraction xi is 0 and 1 at the extremes of the outline along it.
The line across the chord at xi intersects both sides; the camber line is midway between them.
Between points of the outline r, theta and z are linear.

Taper is the slope s = dr/dz along the chord, that of the casing which it follows. On a casing of
slope s = tan g the outward normal is (cos g, -sin g) in (r, z). What closes a gap measured along
the radius is u_r - s u_z.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.base import require
from geometry.hats import middles
from geometry.outline import enclosed

NEAR_ENDS = np.array([0.01, 0.02, 0.03])  # chord fractions, behind most of a blunt or round edge
TO_END = np.array([3.0, -3.0, 1.0])  # parabolic extrapolation from there to the end of the chord
PLACES = 101  # of the camber line; they include NEAR_ENDS
EDGES = (1 / 16, 15 / 16)  # chord fractions at which gaps and outputs are given
JUDGED = (*EDGES, 1 / 2)  # at which a response is judged: a mode may have a node at one
FOLD = 2e-3  # of the axial length, by which z may go back along a side: at a round edge
LEAST_THICK = 1e-6  # m, where the thickness at equal z vanishes
TURNS = 6  # iterations of the chord's direction; the error falls by edge radius over chord in each
FLAT = 1e-5  # m, from one plane: a tip within was cut by a plane
LEAST_SLOPE = 0.002  # smaller ones count as 0: they change what closes the gap by less than 3 %


@dataclass(frozen=True)
class DevelopedTip:
    """Chord of the developed tip, and its outline."""

    outline: NDArray[np.float64]  # (m, 3): r, theta, z in m and rad, closed, in order
    radius: float  # m, of the development
    theta: float  # rad, mean angle, from which theta is measured to avoid jumps by 2 pi
    chord: NDArray[np.float64]  # (2,), unit vector (s, z), downstream
    low: float  # m along the chord, where xi = 0
    high: float  # m, where xi = 1

    @classmethod
    def of(cls, outline: NDArray[np.float64]) -> Self:
        """Tip with the ``outline`` (m, 3), m: x, y, z of points in order, in either direction.

        Raises
        ------
        MeshError
            When the outline folds over its chord.
        """
        x, y, z = np.asarray(outline, dtype=float).T
        r, middle = np.hypot(x, y), float(np.arctan2(y.mean(), x.mean()))
        theta = np.angle((x + 1j * y) * np.exp(-1j * middle))
        radius = float(r.mean())
        flat = np.column_stack([radius * theta, z])
        chord = _chord(flat)
        along = flat @ chord
        rtz = np.column_stack([r, theta + middle, z])
        return cls(rtz, radius, middle, chord, float(along.min()), float(along.max()))

    def developed(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Coordinates (n, 2), m, along the chord and ahead of it, of ``points`` (n, 3), m."""
        x, y, z = np.asarray(points, dtype=float).T
        theta = np.angle((x + 1j * y) * np.exp(-1j * self.theta))
        flat = np.column_stack([self.radius * theta, z])
        return flat @ np.column_stack([self.chord, [self.chord[1], -self.chord[0]]])

    def xi(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Chord fraction (n,) of ``points`` (n, 3), m."""
        return (self.developed(points)[:, 0] - self.low) / (self.high - self.low)

    def camber_line(self) -> NDArray[np.float64]:
        """Camber line (PLACES, 3): r, theta, z in m and rad, at equally spaced xi from 0 to 1.

        Raises
        ------
        MeshError
            When the outline folds over its chord.
        """
        line = self._sides(np.linspace(0, 1, PLACES)[1:-1]).mean(axis=0)
        return np.vstack([TO_END @ line[:3], line, TO_END @ line[:-4:-1]])

    def pressure_side(self, xi: ArrayLike) -> NDArray[np.float64]:
        """Points (n, 3), r, theta, z, on the side ahead in rotation, at chord fractions in (0, 1).

        Raises
        ------
        MeshError
            When the outline folds over its chord.
        """
        return self._sides(np.asarray(xi))[1]

    def _edges(self) -> list[NDArray[np.float64]]:
        """Both sides of the outline from its least z to its largest, (k, 3)."""
        line = np.roll(self.outline, -int(self.outline[:, 2].argmin()), axis=0)
        last = int(line[:, 2].argmax())
        return [line[: last + 1], np.vstack([line[last:], line[:1]])[::-1]]

    @property
    def has_two_edges(self) -> bool:
        """Whether each circle about the engine axis meets the outline twice, a round edge apart."""
        back = (np.maximum.accumulate(side[:, 2]) - side[:, 2] for side in self._edges())
        ascends = (np.diff(self.camber_line()[:, 2]) > 0).all()
        return bool(ascends) and max(map(np.max, back)) <= FOLD * np.ptp(self.outline[:, 2])

    def at_z(self, z: ArrayLike) -> NDArray[np.float64]:
        """Angles (2, n), rad, of the sides behind and ahead in rotation at axial places ``z``, m.

        Those of the nearest end beyond the outline; (2, 0) of a tip without two edges.
        """
        if not self.has_two_edges:
            return np.empty((2, 0))
        ascending = ((np.maximum.accumulate(side[:, 2]), side[:, 1]) for side in self._edges())
        return np.sort([np.interp(z, *side) for side in ascending], axis=0)

    def across(self, points: NDArray[np.float64]) -> tuple[NDArray, NDArray]:
        """Chord fraction (n,) of the camber line at the same z, and eta (n,), of ``points`` (n, 3).

        eta goes from 0 on the side behind to 1 on the side ahead, at equal z. Beyond its ends the
        camber line goes on straight.

        Raises
        ------
        MeshError
            When the tip has no two edges.
        """
        from scipy.interpolate import make_interp_spline  # a slow import, which few jobs need

        require(
            (
                self.has_two_edges,
                "a circle about the engine axis meets the outline of the tip more than twice, so "
                "that it has no edge behind and ahead; allowed 1",
            ),
            key="interface.across",
        )
        x, y, z = np.asarray(points, dtype=float).T
        theta = np.angle((x + 1j * y) * np.exp(-1j * self.theta)) + self.theta
        behind, ahead = self.at_z(z)
        eta = (theta - behind) / np.maximum(ahead - behind, LEAST_THICK / self.radius)
        xi = make_interp_spline(self.camber_line()[:, 2], np.linspace(0, 1, PLACES), k=1)
        return xi(z), eta

    def camber_height(self) -> float:
        """Mean height of the camber line over its chord; positive if its concave side is ahead.

        The mean over the chord, so that neither half of an S-shaped line decides alone.
        """
        r, theta, z = self._sides(middles(20)).mean(axis=0).T
        line = np.column_stack([r.mean() * theta, z])
        chord = line[-1] - line[0]
        return float(((line - line[0]) @ [-chord[1], chord[0]]).mean() / (chord @ chord))

    def width(self) -> float:
        """Mean thickness over the chord: area within the outline over the square of the chord."""
        area = abs(enclosed(*self.developed(cartesian(self.outline)).T))
        return float(area / (self.high - self.low) ** 2)

    def _sides(self, xi: NDArray) -> NDArray:
        """Both sides (2, n, 3) in r, theta, z: first the one behind in rotation, then the other."""
        s = self.radius * (self.outline[:, 1] - self.theta)
        flat = np.column_stack([s, self.outline[:, 2]])
        return _cross(self.outline, flat, self.chord, xi)


def on_line(line: NDArray[np.float64], xi: ArrayLike) -> NDArray[np.float64]:
    """Points (n, 3), r, theta, z, at chord fractions ``xi`` of a camber ``line`` (places, 3)."""
    stations = np.linspace(0, 1, len(line))
    return np.column_stack([np.interp(xi, stations, column) for column in line.T])


def cartesian(rtz: NDArray[np.float64]) -> NDArray[np.float64]:
    """x, y, z (n, 3), m, of points (n, 3) given by r, theta, z."""
    r, theta, z = rtz.T
    return np.column_stack([r * np.cos(theta), r * np.sin(theta), z])


def slope_of_line(r: NDArray[np.float64], z: NDArray[np.float64]) -> NDArray[np.float64]:
    """Slope dr/dz (places,) of a line of radii ``r`` (places,), m, at ascending ``z``, m."""
    return counted(np.gradient(r, z))


def slope_of_tip(nodes: NDArray[np.float64], line: NDArray[np.float64]) -> NDArray[np.float64]:
    """Slope dr/dz (places,) of a tip with ``nodes`` (n, 3), m, and the camber ``line``.

    A tip that was cut by a plane has the slope of that plane: the radius of its line changes with
    the angle, too, which is no taper.
    """
    centred = nodes - nodes.mean(axis=0)
    normal = np.linalg.svd(centred, full_matrices=False)[2][-1]
    if len(nodes) < 4 or abs(centred @ normal).max() > FLAT:
        return slope_of_line(line[:, 0], line[:, 2])
    theta = line[:, 1].mean()
    outward = normal[:2] @ [np.cos(theta), np.sin(theta)]
    return counted(np.full(len(line), -normal[2] / outward))


def counted(slope: NDArray[np.float64]) -> NDArray[np.float64]:
    """The slope, 0 where it is less than ``LEAST_SLOPE``."""
    return np.where(abs(slope) < LEAST_SLOPE, 0.0, slope)


def _chord(flat: NDArray) -> NDArray:
    """Unit vector (s, z) along the chord of the developed outline (m, 2), downstream."""
    _, _, axes = np.linalg.svd(flat - flat.mean(axis=0), full_matrices=False)
    chord = axes[0]
    for _ in range(TURNS):
        chord = chord * (1 if chord[1] > 0 else -1) / np.linalg.norm(chord)
        first, last = (
            TO_END @ _cross(flat, flat, chord, ends).mean(axis=0)
            for ends in (NEAR_ENDS, 1 - NEAR_ENDS)
        )
        chord = last - first
    return chord / np.linalg.norm(chord)


def _cross(values: NDArray, flat: NDArray, chord: NDArray, stations: NDArray) -> NDArray:
    """Values (2, stations, k) where lines across the chord intersect the outline, behind first."""
    along = flat @ chord
    ahead = flat @ [chord[1], -chord[0]]
    low, high = along.min(), along.max()
    sides = []
    for x in low + stations * (high - low):
        before = along < x
        (i,) = np.nonzero(before != np.roll(before, -1))
        require(
            (
                len(i) == 2,
                f"the outline of the tip folds over its chord: a line across it meets {len(i)} "
                f"sides, not two; give the facets of one plain tip",
            )
        )
        j = (i + 1) % len(along)
        f = (x - along[i]) / (along[j] - along[i])
        order = np.argsort(ahead[i] + f * (ahead[j] - ahead[i]))
        sides.append((values[i] + f[:, None] * (values[j] - values[i]))[order])
    return np.stack(sides, axis=1)
