"""Where the strips are along the chord, and the eighths of it that outputs are told of.

Strip k of m is the share [(k - 1)/m, k/m] of the chord, and its place amid it; on an interface of
points it belongs to one point, up to halfway to the next. Outputs are of places and of equal shares
of the chord, so that they mean the same on any number of strips.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.hats import middles
from rom.model import Rom

SHARES = 8  # equal ones of the chord


@dataclass(frozen=True)
class Places:
    """The strips under the tip."""

    ends: NDArray[np.float64]  # (m + 1,), chord fractions
    xi: NDArray[np.float64]  # (m,), chord fractions of what meets each
    radius: NDArray[np.float64]  # (m,), m
    theta: NDArray[np.float64]  # (m,), rad
    width: NDArray[np.float64]  # (m,), m, axial: their sum is the tip's length along the axis


def strip_places(rom: Rom, strips: int) -> Places:
    """Places of so many strips under the blade's tip."""
    if rom.of_points:
        xi, ends = rom.xi, np.concatenate([[0], (rom.xi[1:] + rom.xi[:-1]) / 2, [1]])
        radius, theta, _ = rom.points.T
    else:
        xi, ends = middles(strips), np.linspace(0, 1, strips + 1)
        radius, theta, _ = rom.line(xi).T
    return Places(ends, xi, radius, theta, width=np.diff(rom.line(ends)[:, 2]))


def share_weights(ends: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weights (SHARES, m): the part of each share of the chord that each strip takes.

    ``ends`` (m + 1,) are the strips'. Of a depth they make the mean over each share.
    """
    edges = np.linspace(0, 1, SHARES + 1)
    first = np.maximum(edges[:-1, None], ends[None, :-1])
    last = np.minimum(edges[1:, None], ends[None, 1:])
    return np.maximum(last - first, 0) * SHARES


def force_weights(ends: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weights (SHARES, m): the part of each strip, and so of its force, in each share."""
    return share_weights(ends) / (SHARES * np.diff(ends))


def by_share(wear: NDArray[np.float64], ends: NDArray[np.float64]) -> NDArray[np.float64]:
    """Worn depth (SHARES, nu), m, mean over equal shares of the chord, of strips' (m, nu)."""
    return share_weights(ends) @ wear
