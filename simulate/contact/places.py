"""Places of the strips along the chord, and means over the eighths of the chord.

Strip k of m covers the chord fractions [(k - 1)/m, k/m] and meets the blade at their middle; on an
interface of points it belongs to one point and ends halfway to the next. Outputs are given at chord
fractions or as means over eighths of the chord: they do not depend on the number of strips.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.hats import middles
from rom.model import Rom
from simulate.scene import Casing, Liner

SHARES = 8  # equal parts of the chord, over which outputs are averaged


@dataclass(frozen=True)
class Places:
    """The strips under the tip."""

    ends: NDArray[np.float64]  # (m + 1,), chord fractions
    xi: NDArray[np.float64]  # (m,), chord fractions at which the tip meets each
    radius: NDArray[np.float64]  # (m,), m
    theta: NDArray[np.float64]  # (m,), rad
    width: NDArray[np.float64]  # (m,), m, axial; their sum is the axial length of the tip
    slope: NDArray[np.float64]  # (m,), dr/dz of the casing
    footprint: NDArray[np.float64]  # (m,), m, arc that the tip rubs
    rods: NDArray[np.float64]  # (m,), the same in rods of the liner

    @property
    def secant(self) -> NDArray[np.float64]:
        """1 / cos g (m,) of the normal's angle g to the radius: t_N over the radial force."""
        return np.hypot(1.0, self.slope)


def volume_of(
    depth: NDArray[np.float64], width: NDArray[np.float64], radius: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Volume (...,), m3, of depths (..., m) over strips of ``width``, at ``radius`` (m,); in m."""
    return 2 * np.pi * depth @ (width * radius)


def rods_in_footprint(footprint: Any, radius: Any, nu: int) -> Any:
    """Length of the footprint (m) at ``radius`` (m) in rods."""
    return footprint * nu / (2 * np.pi * radius)


def given_footprint(liner: Liner, rom: Rom) -> float | None:
    """`liner.footprint_m`; None where the tip rubs the arc that it covers: of two edges, always."""
    return liner.footprint_m if rom.across == 1 else None


def mean_footprint(liner: Liner, rom: Rom) -> float:
    """Mean arc (m) that the tip rubs."""
    return given_footprint(liner, rom) or float(rom.arc(middles(SHARES)).mean())


def strip_xi(rom: Rom, strips: int) -> NDArray[np.float64]:
    """Chord fractions at which the tip meets so many strips, or the one strip per point."""
    return rom.xi if rom.of_points else middles(strips)


def strip_places(rom: Rom, liner: Liner, casing: Casing) -> Places:
    """Places of the equal strips; on an interface of points, one strip per point.

    Where the tip rubs the arc that it covers, it is centred at the middle of that.

    Raises
    ------
    rom.model.RomError
        When the arc is not given, and the model does not know it.
    """
    xi, given = strip_xi(rom, liner.m), given_footprint(liner, rom)
    if rom.of_points:
        ends = np.concatenate([[0], (rom.xi[1:] + rom.xi[:-1]) / 2, [1]])
        radius, theta, _ = rom.points.T
    else:
        ends = np.linspace(0, 1, len(xi) + 1)
        radius, theta, _ = rom.line(xi).T
    footprint = rom.arc(xi) if given is None else np.full(len(xi), given)
    if given is None:
        theta = np.interp(xi, np.linspace(0, 1, rom.sides.shape[1]), rom.sides.mean(axis=0))
    width, slope = np.diff(rom.line(ends)[:, 2]), slope_at(rom, casing, xi)
    at = radius if given is None else rom.camber[:, 0].mean()
    rods = rods_in_footprint(footprint, at, liner.nu)
    return Places(ends, xi, radius, theta, width, slope, footprint, rods)


def slope_at(rom: Rom, casing: Casing, xi: NDArray[np.float64]) -> NDArray[np.float64]:
    """Slope dr/dz of the casing at chord fractions ``xi``, of their shape."""
    slope = casing.slope_along(rom.camber, rom.taper)
    return np.interp(xi, np.linspace(0, 1, len(slope)), slope)


def closing_rows(
    rom: Rom, casing: Casing, xi: NDArray[np.float64], leans: bool = False
) -> NDArray[np.float64]:
    """P (k, n): u_r - s u_z = P u at chord fractions ``xi`` (k,), s the slope of the casing.

    Of the tip's middle; where it ``leans``, of the edge ahead less that of the edge behind.
    """
    return rom.closing_rows(xi, casing.slope_along(rom.camber, rom.taper), leans)


def share_weights(ends: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weights (SHARES, m) of the mean over each eighth of the chord.

    Entry (s, i) is the part of eighth s that strip i covers; ``ends`` (m + 1,) of the strips.
    """
    edges = np.linspace(0, 1, SHARES + 1)
    first = np.maximum(edges[:-1, None], ends[None, :-1])
    last = np.minimum(edges[1:, None], ends[None, 1:])
    return np.maximum(last - first, 0) * SHARES


def force_weights(ends: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weights (SHARES, m) of the force on each eighth: the part of each strip that lies in it."""
    return share_weights(ends) / (SHARES * np.diff(ends))


def by_share(wear: NDArray[np.floating], ends: NDArray[np.float64]) -> NDArray[np.float64]:
    """Worn depth (SHARES, nu), m: mean over each eighth of the chord of ``wear`` (m, nu)."""
    return share_weights(ends) @ wear
