"""Bricks with corners of nearly 180 degrees on a smooth outline, in mm: an elliptic blade."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from geometry.split import KINDS, OF_BRICK, Block, split

CHORD, THICKNESS, STAGGER = 40.0, 4.0, (30.0, 45.0)  # mm, degrees at hub and tip
HUB, SPAN, LAYERS = 200.0, 80.0, 8
TOP = 1  # place of the upper face of a brick among its faces

type Map = Callable[[np.ndarray, np.ndarray], np.ndarray]  # s, t to (n, 2) on the unit disc


class Section(NamedTuple):
    """Quadrilaterals of a section by their corners (m, 4, 2), anticlockwise, on the unit disc."""

    corners: np.ndarray

    @classmethod
    def of(cls, cells, place: Map) -> "Section":
        s, t = np.array(cells, dtype=float).reshape(-1, 2).T
        return cls(place(s, t).reshape(-1, 4, 2))

    @property
    def middles(self) -> np.ndarray:
        """Middles (m, 4, 2) of the edges; on the outline half an arc of the ellipse from both."""
        ends = np.stack([self.corners, np.roll(self.corners, -1, axis=1)], axis=2)
        middles = ends.mean(axis=2)
        outside = (abs(np.linalg.norm(ends, axis=3) - 1) < 1e-9).all(axis=2)
        middles[outside] = np.reshape([half_way(pair) for pair in ends[outside]], (-1, 2))
        return middles


def half_way(ends: np.ndarray) -> np.ndarray:
    """The place on the circle that halves the arc of the ellipse."""
    first, last = np.unwrap(np.arctan2(*ends.T[::-1]))
    angle = np.linspace(first, last, 2001)
    steps = np.hypot(*np.diff([CHORD * np.cos(angle), THICKNESS * np.sin(angle)]))
    arc = np.append(0.0, np.cumsum(steps))
    at = np.interp(arc[-1] / 2, arc, angle)
    return np.array([np.cos(at), np.sin(at)])


def disc_of_square(s, t):
    """The square -1 to 1 on the disc: its corners lie on the circle."""
    return np.column_stack([s * np.sqrt(1 - t**2 / 2), t * np.sqrt(1 - s**2 / 2)])


def h_block(along: int = 12, across: int = 2, place: Map = disc_of_square) -> Section:
    """One block whose four corners are creases of the outline."""
    s, t = np.linspace(-1, 1, along + 1), np.linspace(-1, 1, across + 1)
    return Section.of(
        [
            [(s[i], t[j]), (s[i + 1], t[j]), (s[i + 1], t[j + 1]), (s[i], t[j + 1])]
            for i in range(along)
            for j in range(across)
        ],
        place,
    )


def plate(along: int = 12, across: int = 2) -> Section:
    """The same block within the disc: a twisted plate."""
    return Section(0.7 * h_block(along, across, lambda s, t: np.column_stack([s, t])).corners)


def fan(along: int = 12) -> Section:
    """Two rows between cosine-spaced places, that end in one kite at each edge."""
    s = np.arange(along + 1.0)
    rows = [
        [(s[i], t), (s[i + 1], t), (s[i + 1], t + 1), (s[i], t + 1)]
        for i in range(1, along - 1)
        for t in (-1, 0)
    ]
    first, last = s[1], s[-2]
    kites = [
        [(0.0, 0.0), (first, -1.0), (first, 0.0), (first, 1.0)],
        [(s[-1], 0.0), (last, 1.0), (last, 0.0), (last, -1.0)],
    ]

    return Section.of(
        [*kites, *rows],
        lambda s, t: np.column_stack([-np.cos(np.pi * s / along), np.sin(np.pi * s / along) * t]),
    )


class Blade(NamedTuple):
    """Points, mm, cells of second order in VTK's order, and nodes of root and tip."""

    points: np.ndarray
    cells: np.ndarray
    groups: dict[str, np.ndarray]


def raised(section: Section, layers: int = LAYERS) -> Blade:
    """Twenty-node bricks over the section, twisted along the span."""
    places = []
    for quad, middles in zip(
        section.corners[:, ::-1], section.middles[:, [2, 1, 0, 3]], strict=True
    ):
        for low in range(0, 2 * layers, 2):
            for at, level in ((quad, low), (quad, low + 2), (middles, low), (middles, low + 2)):
                places += [(*place, level) for place in at]
            places += [(*place, low + 1) for place in quad]
    unique, cells = np.unique(np.round(places, 9), axis=0, return_inverse=True)
    along, across, level = unique.T
    share = level / (2 * layers)
    angle = np.radians(STAGGER[0] + (STAGGER[1] - STAGGER[0]) * share)
    z, y = CHORD / 2 * along, THICKNESS / 2 * across
    points = np.column_stack(
        [
            HUB + SPAN * share,
            y * np.cos(angle) - z * np.sin(angle),
            y * np.sin(angle) + z * np.cos(angle),
        ]
    )
    groups = {"root": np.flatnonzero(level == 0), "tip": np.flatnonzero(level == 2 * layers)}
    return Blade(points, cells.reshape(-1, KINDS["hexahedron"].corners + 12), groups)


class Mixed(NamedTuple):
    """Cells by meshio's name, of second order, on common points, mm."""

    points: np.ndarray
    cells: list[tuple[str, np.ndarray]]
    groups: dict[str, np.ndarray]


def with_pyramids(blade: Blade) -> Mixed:
    """Bricks below, tetrahedra above, and between them a layer of pyramids around a middle node.

    Its upper faces are two tetrahedra, cut as those above.
    """
    level = blade.points[blade.cells[:, :8], 0].mean(axis=1)
    between = np.unique(level.round(6))[LAYERS // 2]
    below, layer, above = (
        blade.cells[chosen]
        for chosen in (level < between - 1e-3, abs(level - between) < 1e-3, level > between + 1e-3)
    )
    upper = split(blade.points, [Block(above, np.arange(len(above)))])
    points, middles = [*upper.points], {}
    for block in (layer, upper.cells):
        kind = KINDS["hexahedron" if block is layer else "tetra"]
        ends = block[:, kind.edges].reshape(-1, 2)
        places = block[:, kind.corners : kind.corners + len(kind.edges)].ravel()
        middles |= {frozenset(pair): node for pair, node in zip(ends.tolist(), places, strict=True)}

    def whole(kind: str, corners: list[int]) -> list[int]:
        """The cell with the middles of its edges."""
        found = [*corners]
        for a, b in np.array(corners)[KINDS[kind].edges].tolist():
            if frozenset((a, b)) not in middles:
                middles[frozenset((a, b))] = len(points)
                points.append((points[a] + points[b]) / 2)
            found.append(middles[frozenset((a, b))])
        return found

    pyramids, tetrahedra = [], upper.cells.tolist()
    for cell in layer.tolist():
        centre = len(points)
        points.append(np.append(OF_BRICK[:8], OF_BRICK[8:]) @ blade.points[cell])
        for place, face in enumerate(KINDS["hexahedron"].faces):
            base = [cell[i] for i in face][::-1]  # seen from the middle
            if place != TOP:
                pyramids.append(whole("pyramid", [*base, centre]))
            else:
                turned = np.roll(base, -int(np.argmin(base))).tolist()
                for a, b, c in (turned[:3], [turned[0], *turned[2:]]):
                    tetrahedra.append(whole("tetra", [a, b, c, centre]))
    cells = [("hexahedron20", below), ("pyramid13", pyramids), ("tetra10", tetrahedra)]
    return Mixed(np.array(points), [(kind, np.array(of)) for kind, of in cells], blade.groups)
