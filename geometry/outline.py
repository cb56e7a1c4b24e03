"""Area of outlines; checks of sections as a table gives them: whole, in line along the blade.

Outlines are to be without gaps and spikes. Each check names the section that is at fault; without
the checks the mesh fails, or the blade is another one.
"""

import numpy as np
from numpy.typing import NDArray

from geometry.base import require

MOST_GAP = 0.15  # of the chord, between two points; blunt edges are thinner
ALONE = 2.5  # times the next longest step: a gap, not the spacing of the points
SPIKE = 3e-3  # of the chord, least height of a spike
TURNED = 0.2  # rad, least turn of the outline at a spike; back in both neighbours
BESIDE = 0.25  # of the chord, that an edge may be beside the line between its neighbours


def enclosed(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Area within the outline of points (n,) in a plane; below 0 if it turns from b to a.

    >>> float(enclosed(np.array([0.0, 2.0, 2.0, 0.0]), np.array([0.0, 0.0, 1.0, 1.0])))
    2.0
    """
    return (a @ np.roll(b, -1) - b @ np.roll(a, -1)) / 2


def check_outline(name: str, outline: NDArray[np.float64]) -> None:
    """Check that an outline (n, 3) has no gap and no spike.

    Raises
    ------
    MeshError
        When it has one; the message has the number of its point in the section.
    """
    chord = float(np.linalg.norm(np.ptp(outline, axis=0)))
    steps = np.roll(outline, -1, axis=0) - outline
    lengths = np.linalg.norm(steps, axis=1)
    longest, gap = np.argsort(lengths)[-2:]
    heights, directions = _heights(outline), steps / np.where(lengths > 0, lengths, np.inf)[:, None]
    spikes = (heights > SPIKE * chord) & _is_spike(directions - np.roll(directions, 1, axis=0))
    worst = int(np.argmax(heights * spikes))
    require(
        (
            lengths[gap] <= max(MOST_GAP * chord, ALONE * lengths[longest]),
            f"a gap of {1e3 * lengths[gap]:.3g} mm after its point {gap + 1} of "
            f"{len(outline)}, where others are {1e3 * lengths[longest]:.3g} mm apart at most: "
            "is the file cut short?",
        ),
        (
            not np.any(spikes),
            f"its point {worst + 1} of {len(outline)} stands {1e3 * heights[worst]:.3g} mm "
            "beside its neighbours: correct its coordinates",
        ),
        key=name,
    )


def check_line(names: list[str], edges: NDArray[np.float64], radii: NDArray[np.float64]) -> None:
    """Check that the edges of each section lie near the line between those of its neighbours.

    Parameters
    ----------
    names : of the sections, hub to tip
    edges : (sections, 2, 3), m, leading and trailing edge
    radii : (sections,), m

    Raises
    ------
    MeshError
        When one does not; the message names the section without which the others would.
    """
    off = _offset(edges, radii)
    kept = [np.delete(np.arange(len(names)), i) for i in range(len(names))]
    without = [_offset(edges[rest], radii[rest]) for rest in kept]
    alone = len(names) > 3 and min(without) <= BESIDE
    what = names[int(np.argmin(without))] if alone else f"one of {names[0]} to {names[-1]}"
    require(
        (
            off <= BESIDE,
            f"an edge lies {100 * off:.0f} % of the chord beside the line between its neighbours "
            f"(allowed {100 * BESIDE:.0f} %): is the section shifted, turned or scaled?",
        ),
        key=what,
    )


def _offset(edges: NDArray, radii: NDArray) -> float:
    """Largest distance of an edge from the line between its neighbours, over the chord."""
    if len(edges) < 3:
        return 0.0
    share = ((radii[1:-1] - radii[:-2]) / (radii[2:] - radii[:-2]))[:, None, None]
    between = (1 - share) * edges[:-2] + share * edges[2:]
    chords = np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1)
    off = np.linalg.norm(edges[1:-1] - between, axis=2).max(axis=1)
    return float((off / np.median(chords)).max())


def _heights(outline: NDArray) -> NDArray:
    """Distance (n,) of each point from the line through its neighbours."""
    before, after = np.roll(outline, 1, axis=0), np.roll(outline, -1, axis=0)
    along = after - before
    length = np.linalg.norm(along, axis=1)
    across = np.linalg.norm(np.cross(outline - before, along), axis=1)
    return across / np.where(length > 0, length, np.inf)


def _is_spike(turns: NDArray) -> NDArray[np.bool_]:
    """Whether the outline turns at a point (n,), and back again at both neighbours.

    ``turns`` (n, 3): change of its direction at each point.
    """
    size = np.linalg.norm(turns, axis=1)
    back = np.ones(len(turns), dtype=bool)
    for neighbour in (1, -1):
        product = np.sum(turns * np.roll(turns, neighbour, axis=0), axis=1)
        its_size = np.roll(size, neighbour)
        back &= (product < -0.5 * size * its_size) & (its_size > size / 4)
    return back & (size > TURNED)
