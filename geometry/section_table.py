"""Reader of a table of section coordinates: both sides of each section, cut and resampled.

The table is CSV: a header ``section,x,y,z``, then the points of the closed outline of each section
in order, in either direction; lines that begin with # are comments. Rounded edges are a fraction of
a millimetre thick, and their loft would intersect itself: each section is therefore cut across its
chord close to both ends.
"""

import warnings
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import Akima1DInterpolator
from scipy.spatial.distance import pdist, squareform

from geometry.base import MeshError, MeshWarning, csv_rows, numbers, require, shown, unquoted
from geometry.blade import SectionTable
from geometry.frame import to_blade
from geometry.outline import check_line, check_outline, enclosed

HEADER = ["section", "x", "y", "z"]
THINNEST = 5e-3  # of the chord; tips of fans have 2e-2
FEWEST_POINTS, MOST_POINTS = 16, 4000  # of a section
LONGEST_NAME = 100  # characters
STATIONS = 17  # of a side between its cuts; twice as many change the volume by 1e-4
APART = 1e-4  # m, least radial distance between two sections
DENSE = 4000  # points of a side from which the stations are interpolated


@dataclass(frozen=True)
class CutSection:
    """One section between its cuts, in the blade's frame, m; leading edge first."""

    name: str
    suction: NDArray[np.float64]  # (STATIONS, 3), the side behind in rotation
    pressure: NDArray[np.float64]  # (STATIONS, 3)
    removed: float  # share of its area that the cuts remove

    @property
    def edges(self) -> NDArray[np.float64]:
        """Thickness (2,), m, of the blunt leading and trailing edge."""
        return np.linalg.norm((self.pressure - self.suction)[[0, -1]], axis=1)

    @property
    def apart(self) -> NDArray[np.float64]:
        """Largest difference (2,), m, between both sides at one z: of x, and of the radius."""
        (x, y, z), (other_x, other_y, other_z) = self.suction.T, self.pressure.T
        pairs = (x, other_x), (np.hypot(x, y), np.hypot(other_x, other_y))
        both = (z > other_z[0]) & (z < other_z[-1])
        return np.array([abs(np.interp(z, other_z, b) - a)[both].max() for a, b in pairs])


def read_sections(table: SectionTable, path: str | Path) -> list[CutSection]:
    """Sections of a table, hub to tip.

    Raises
    ------
    MeshError
        When a line cannot be read, a section has too few points or crosses itself or the next.
    """
    with unquoted(path):
        outlines = _read(path)
    placed = to_blade(np.vstack(list(outlines.values())), table)
    ends = np.cumsum([len(points) for points in outlines.values()])[:-1]
    cut = [
        _cut(f"section {name}", points, table.edge_cut_percent / 100)
        for name, points in zip(outlines, np.split(placed, ends), strict=True)
    ]
    _check_order(cut)
    cut.sort(key=_radius)
    _check_crossing(cut)
    edges = [(s.suction[[0, -1]] + s.pressure[[0, -1]]) / 2 for s in cut]
    check_line([s.name for s in cut], np.array(edges), np.array([_radius(s) for s in cut]))
    _warn_of_polar(table, cut)
    return cut


def describe_cut(sections: list[CutSection]) -> str:
    """Lengths and areas that the cut of the edges leaves and takes, in one line.

    It takes mass and hardly stiffness: f1 rises by half of the share of the area (measured:
    0.3 to 0.4 of it on rotor 37).
    """
    low, high = (1e3 * f([f(section.edges) for section in sections]) for f in (np.min, np.max))
    removed = 100 * max(section.removed for section in sections)
    return (
        f"the cut edges are {low:.2g} to {high:.2g} mm thick; the cut takes up to {removed:.2g} % "
        f"of a section's area, which raises f1 by some half of that"
    )


def _warn_of_polar(table: SectionTable, sections: list[CutSection]) -> None:
    """Warn where `radial` is the same on both sides of each section, nearer than the radius.

    So it is where the columns are a radius, an angle and z, and where planes cut the sections.
    """
    radial, radius = np.max([section.apart for section in sections], axis=0)
    if radial <= radius:
        warnings.warn(
            f"{table.file}: `radial` is the same on both sides of each section: right where planes "
            "cut them; if the columns are a radius, an angle and z, give x, y, z",
            MeshWarning,
            stacklevel=5,
        )


def _radius(section: CutSection) -> float:
    """Mean radius, m."""
    return float(_radii(section).mean())


def _check_order(sections: list[CutSection]) -> None:
    """Check that the sections follow one another from hub to tip, or from tip to hub."""
    rises = np.diff([_radius(section) for section in sections])
    up = np.sum(rises > 0) >= len(rises) / 2
    first = int(np.argmax((rises > 0) != up))
    require(
        (
            np.all((rises > 0) == up),
            f"{sections[first + 1].name} lies {'inside' if up else 'outside'} "
            f"{sections[first].name}, other than all before: give the sections in order, hub to "
            "tip, and check its radius",
        )
    )


def _read(path: str | Path) -> dict[str, NDArray[np.float64]]:
    """Outlines by name, in the file's unit and axes."""
    outlines: dict[str, list[list[float]]] = {}
    (number, header), *rows = list(csv_rows(path)) or [(1, [])]
    require((header == HEADER, f"the header must be {','.join(HEADER)}"), line=number)
    for line, (name, *values) in rows:
        named = name.isprintable() and len(name) <= LONGEST_NAME
        require((named, f"section {shown(name)}: is no name"), line=line)
        outlines.setdefault(name, []).append(numbers(values, HEADER[1:], line))
    require(
        (len(outlines) > 1, f"{len(outlines)} section(s); needs two or more, hub to tip"),
        *(
            (
                FEWEST_POINTS <= len(points) <= MOST_POINTS,
                f"section {name} has {len(points)} points; needs {FEWEST_POINTS} or more, and "
                f"{MOST_POINTS} at most",
            )
            for name, points in outlines.items()
        ),
    )
    return {name: np.array(points) for name, points in outlines.items()}


def _cut(name: str, outline: NDArray, share: float) -> CutSection:
    """Both sides between the cuts, at ``share`` of the chord from its ends.

    The chord joins the two points with the largest distance. Stations are denser near the cuts,
    where the sides are most curved.
    """
    suction, pressure = _sides(name, outline)
    nearness = (1 - np.cos(np.linspace(0, np.pi, STATIONS))) / 2
    stations = share + (1 - 2 * share) * nearness
    sides = [_at_stations(name, side, stations) for side in (suction, pressure)]
    kept = np.vstack([sides[0], sides[1][::-1]])  # both areas are seen along the radius
    removed = 1 - abs(enclosed(*kept[:, 1:].T) / enclosed(*outline[:, 1:].T))
    cut = CutSection(name, *sides, float(removed))
    along = suction[-1] - suction[0]
    ahead = np.cross([1.0, 0, 0], along) * -1.0
    thickness = (cut.pressure - cut.suction) @ ahead / np.linalg.norm(ahead)
    require(
        (
            thickness.max() >= THINNEST * np.linalg.norm(along),
            f"it is {100 * thickness.max() / np.linalg.norm(along):.2g} % of its chord thick "
            f"(allowed from {100 * THINNEST:g} %): are its columns x, y, z, all in one unit?",
        ),
        (
            thickness.min() > 0,
            f"its sides cross at {100 * stations[thickness.argmin()]:.0f} % of the chord; give "
            "the points of its outline in order",
        ),
        key=name,
    )
    return cut


def _sides(name: str, outline: NDArray) -> tuple[NDArray, NDArray]:
    """Suction and pressure side, each from the leading to the trailing end of the chord."""
    outline = outline[np.linalg.norm(np.roll(outline, -1, axis=0) - outline, axis=1) > 0]
    require(
        (
            len(outline) >= FEWEST_POINTS,
            f"{name} has {len(outline)} different points; needs {FEWEST_POINTS}",
        )
    )
    check_outline(name, outline)
    gaps = squareform(pdist(outline))
    first, last = np.unravel_index(gaps.argmax(), gaps.shape)
    if outline[first, 2] > outline[last, 2]:
        first, last = last, first
    n = len(outline)
    if enclosed(outline[:, 2], outline[:, 1]) < 0:  # clockwise: pressure side first
        outline, first, last = outline[::-1], n - 1 - first, n - 1 - last
    outline, last = np.roll(outline, -first, axis=0), (last - first) % n
    return outline[: last + 1], np.vstack([outline[last:], outline[:1]])[::-1]


def _at_stations(name: str, side: NDArray, stations: NDArray) -> NDArray:
    """Points of a side at chord fractions; modified Akima splines do not overshoot at corners."""
    steps = np.linalg.norm(np.diff(side, axis=0), axis=1)
    fewest = FEWEST_POINTS // 4
    require((len(side) >= fewest, f"a side has {len(side)} points; needs {fewest}"), key=name)
    arc = np.concatenate([[0], np.cumsum(steps)])
    curve = Akima1DInterpolator(arc, side, method="makima")
    samples = np.linspace(0, arc[-1], DENSE)
    chord = side[-1] - side[0]
    along = (curve(samples) - side[0]) @ chord / (chord @ chord)
    between = (along > stations[0]) & (along < stations[-1])
    if np.any(np.diff(along[between]) <= 0):
        fold = along[between][np.diff(along[between]).argmin()]
        raise MeshError(
            f"a side folds back at {100 * fold:.0f} % of the chord; give the points of its "
            "outline in order",
            key=name,
        )
    return curve(np.interp(stations, along, samples))


def _radii(section: CutSection) -> NDArray[np.float64]:
    """Radius (2, STATIONS), m, of the points of both sides."""
    points = np.stack([section.suction, section.pressure])
    return np.hypot(points[..., 0], points[..., 1])


def _check_crossing(sections: list[CutSection]) -> None:
    for low, high in pairwise(sections):
        rise = (_radii(high) - _radii(low)).min(axis=0)
        require(
            (
                rise.min() >= APART,
                f"{high.name} lies {1e3 * rise.min():.3g} mm outside {low.name} at "
                f"station {rise.argmin() + 1} of {STATIONS}; sections must not cross or meet "
                f"(allowed from {1e3 * APART:g} mm)",
            )
        )
