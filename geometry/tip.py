"""Where the interface nodes belong on a tip given by its outline: camber line or pressure side.

The tip is developed, s = r theta against z. Its chord joins both ends of the camber line; stations
stand amid equal shares of it. The line across the chord at a station meets the two sides; the
camber line is midway between them. Between points of the outline r, theta and z are linear.
"""

import numpy as np
from numpy.typing import NDArray

from geometry.errors import MeshError

NEAR_ENDS = np.array([0.01, 0.02, 0.03])  # chord fractions, past most of a blunt or round edge
TO_END = np.array([3.0, -3.0, 1.0])  # extrapolates a parabola from them to the end of the chord
STATIONS = 20  # of the mean height
TURNS = 6  # of the chord's direction; a turn leaves an error of edge radius over chord


def camber_points(outline: NDArray, n: int) -> NDArray[np.float64]:
    """Points (n, 3), m, on the camber line, leading edge first, of an ``outline`` (m, 3), m.

    The outline is closed and in order, either way round; its last point is not its first.

    Raises
    ------
    MeshError
        When the outline folds over its chord.
    """
    return _cartesian(_sides(outline, n).mean(axis=0))


def pressure_points(outline: NDArray, n: int) -> NDArray[np.float64]:
    """Points (n, 3), m, on the side ahead in rotation; otherwise as ``camber_points``.

    Raises
    ------
    MeshError
        When the outline folds over its chord.
    """
    return _cartesian(_sides(outline, n)[1])


def camber_height(outline: NDArray) -> float:
    """Mean height of the camber line over its chord; positive where its hollow side is ahead.

    A mean over the chord, so that an S-shaped line does not count by one of its halves.
    """
    r, theta, z = _sides(outline, STATIONS).mean(axis=0).T
    line = np.column_stack([r.mean() * theta, z])
    chord = line[-1] - line[0]
    return float(((line - line[0]) @ [-chord[1], chord[0]]).mean() / (chord @ chord))


def _sides(outline: NDArray, n: int) -> NDArray:
    """Both sides (2, n, 3) in r, theta, z: the one behind in rotation, then the one ahead."""
    x, y, z = np.asarray(outline, dtype=float).T
    r = np.hypot(x, y)
    middle = np.arctan2(y.mean(), x.mean())  # theta is counted from here: no jump by 2 pi
    theta = np.angle((x + 1j * y) * np.exp(-1j * middle))
    flat = np.column_stack([r.mean() * theta, z])
    stations = (np.arange(n) + 0.5) / n
    return _cross(np.column_stack([r, theta + middle, z]), flat, _chord(flat), stations)


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
    """Values (2, stations, k) where the lines across the chord meet the outline; behind first."""
    along = flat @ chord
    ahead = flat @ [chord[1], -chord[0]]
    low, high = along.min(), along.max()
    sides = []
    for x in low + stations * (high - low):
        before = along < x
        (i,) = np.nonzero(before != np.roll(before, -1))
        if len(i) != 2:
            raise MeshError(
                f"the outline of the tip folds over its chord: a line across it meets {len(i)} "
                f"sides, not two; give interface.points_mm"
            )
        j = (i + 1) % len(along)
        f = (x - along[i]) / (along[j] - along[i])
        order = np.argsort(ahead[i] + f * (ahead[j] - ahead[i]))
        sides.append((values[i] + f[:, None] * (values[j] - values[i]))[order])
    return np.stack(sides, axis=1)


def _cartesian(points: NDArray) -> NDArray:
    r, theta, z = points.T
    return np.column_stack([r * np.cos(theta), r * np.sin(theta), z])
