"""Solid cells of a file as ten-node tetrahedra: bricks, wedges and pyramids are split.

A quadrilateral is cut along the diagonal from its node that stands first in the file, so that the
cells on both sides of it agree (Dompierre and others 1999, How to subdivide pyramids, prisms and
hexahedra into tetrahedra). A cell is the cone from its first node over the triangles of the faces
that do not have that node: a pyramid gives two tetrahedra, a wedge three, a brick six, around the
diagonal from that node. A corner of nearly 180 degrees is flat in a triangle that is cut off there,
and halved by a diagonal from it: such nodes are put first.

Middle nodes of the diagonals come from the cell's own map, which in the middle of a quadrilateral
and of a brick is that of eight and of twenty nodes: a sum over corners and middles of edges, of
places as of displacements. Cells of first order are taken as those of second whose edges are
straight: their quadrilaterals are warped, so that straight diagonals would cost a brick volume.
Nodes within faces and cells (27, 18 and 14 nodes) are left out.
"""

from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix, eye_array, vstack

from geometry.base import MeshError
from geometry.tetrahedra import EDGES, FACETS, check_middles

# weights, of corners and of middles of edges
OF_FACE, OF_BRICK = np.repeat([-1 / 4, 1 / 2], 4), np.repeat([-1 / 4, 1 / 4], [8, 12])


class Kind(NamedTuple):
    """A solid cell: its corners, then the middles of its edges, in VTK's order.

    Corners of the faces are anticlockwise from outside; faces are in the order of Abaqus.
    """

    edges: NDArray
    faces: tuple[tuple[int, ...], ...]

    @property
    def corners(self) -> int:
        """Number of corners."""
        return int(self.edges.max()) + 1


KINDS = {
    "tetra": Kind(EDGES, tuple(map(tuple, FACETS[:, :3].tolist()))),
    "pyramid": Kind(
        np.array([(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)]),
        ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    ),
    "wedge": Kind(
        np.array([(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]),
        ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    ),
    "hexahedron": Kind(
        np.vstack(
            [
                [(0, 1), (1, 2), (2, 3), (3, 0)],
                [(4, 5), (5, 6), (6, 7), (7, 4)],
                [(0, 4), (1, 5), (2, 6), (3, 7)],
            ]
        ),
        ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
    ),
}
# kind, and whether it has the middles of its edges, by the number of its nodes
NODES = {
    4: ("tetra", False),
    10: ("tetra", True),
    5: ("pyramid", False),
    13: ("pyramid", True),
    14: ("pyramid", True),
    6: ("wedge", False),
    15: ("wedge", True),
    18: ("wedge", True),
    8: ("hexahedron", False),
    20: ("hexahedron", True),
    27: ("hexahedron", True),
}
FLAT = 135.0  # degrees, of a corner that is to be cut from
OPPOSITE = np.array([6, 7, 4, 5, 2, 3, 0, 1])  # corners of a brick
TURNED = [3, 4, 5, 0, 1, 2, 9, 10, 11, 6, 7, 8, 12, 13, 14]  # a wedge seen from its other end


class Block(NamedTuple):
    """Solid cells of one kind: nodes (m, k) in VTK's order, rows of points, and their numbers."""

    nodes: NDArray  # of kinds that are not read k may be 0
    numbers: NDArray  # (m,), in the file
    named: str = ""  # its kind, as the file names it

    @property
    def kind(self) -> Kind:
        """Corners, edges and faces."""
        return KINDS[NODES[self.nodes.shape[1]][0]]

    @property
    def second_order(self) -> bool:
        """Whether its edges have middle nodes."""
        return NODES[self.nodes.shape[1]][1]

    @property
    def corners(self) -> NDArray:
        """Corner nodes (m, corners)."""
        return self.nodes[:, : self.kind.corners]

    @property
    def middles(self) -> NDArray:
        """Middle nodes (m, edges) of the edges, of cells of second order."""
        first = self.kind.corners
        return self.nodes[:, first : first + len(self.kind.edges)]

    def faces(self, corners: int) -> NDArray:
        """Faces (m, faces, corners) with so many corners."""
        faces = np.array([face for face in self.kind.faces if len(face) == corners], dtype=int)
        return self.corners[:, faces.reshape(-1, corners)]


class Split(NamedTuple):
    """Ten-node tetrahedra, and their source cells."""

    points: NDArray  # (n, 3), those of the file first
    weights: csr_matrix  # (n, given), of those in the place, and the displacement, of each
    cells: NDArray  # (m, 10)
    numbers: NDArray  # (m,), of the cells of the file
    parents: NDArray  # (k, 4): corners of the edge, twice, or quadrilateral of each new node

    def with_new(self, nodes: NDArray) -> NDArray:
        """A group of nodes of the file, with the new ones whose corners are all in it."""
        inside = np.zeros(len(self.points), dtype=bool)
        inside[nodes] = True
        given = len(self.points) - len(self.parents)
        return np.append(nodes, given + np.flatnonzero(inside[self.parents].all(axis=1)))


class _Edges:
    """Middle nodes of edges by their ends; new nodes stand behind those of the file."""

    def __init__(self, given: int) -> None:
        self.weights = csr_matrix(eye_array(given))  # as of ``Split``
        self.parents = np.empty((0, 4), dtype=int)
        # ends (n, 2), in order, and middle nodes (n,) of all edges
        self.known, self.known_middles = np.empty((0, 2), dtype=int), np.empty(0, dtype=int)

    def know(self, ends: NDArray, middles: NDArray) -> None:
        """Take middle nodes (n,) of edges with ``ends`` (n, 2)."""
        self.known = np.vstack([self.known, np.sort(ends, axis=1)])
        self.known_middles = np.append(self.known_middles, middles)

    def make(self, ends: NDArray, parents: NDArray, nodes: NDArray, weights: NDArray) -> None:
        """Add the middles of edges with ``ends`` (n, 2): sums over ``nodes`` (n, k)."""
        count = self.weights.shape[0]
        self.know(ends, count + np.arange(len(ends)))
        n, k = nodes.shape
        entries = np.tile(weights, n), nodes.ravel(), k * np.arange(n + 1)
        sums = csr_matrix(entries, (n, count))
        self.weights = vstack([self.weights, sums @ self.weights], format="csr")
        self.parents = np.vstack([self.parents, parents])

    def middles(self, ends: NDArray) -> NDArray:
        """Middle nodes (...) of edges with ``ends`` (..., 2)."""
        stored, asked = (
            np.sort(pairs.reshape(-1, 2), axis=1) @ (self.weights.shape[0], 1)
            for pairs in (self.known, ends)
        )
        order = np.argsort(stored)
        place = np.searchsorted(stored, asked, sorter=order)
        return self.known_middles[order[place]].reshape(ends.shape[:-1])


def flat_corners_first(points: NDArray, blocks: Sequence[Block]) -> NDArray[np.int64]:
    """Order (n,) of the ``points`` (n, 3), by the largest angle of a quadrilateral at each.

    Nodes whose angles are all below ``FLAT`` stay behind the others, in the file's order.
    """
    quads = np.vstack([np.empty((0, 4), dtype=int), *(b.faces(4).reshape(-1, 4) for b in blocks)])
    corner = points[quads]
    sides = [np.roll(corner, turn, axis=1) - corner for turn in (-1, 1)]
    lengths = [np.linalg.norm(side, axis=2) for side in sides]
    with np.errstate(divide="ignore", invalid="ignore"):  # of corners that coincide
        cosine = (sides[0] * sides[1]).sum(axis=2) / (lengths[0] * lengths[1])
    smallest = np.zeros(len(points))
    np.fmin.at(smallest, quads, np.where(cosine < np.cos(np.radians(FLAT)), cosine, 0.0))
    return np.argsort(smallest, kind="stable")


def upright(points: NDArray, nodes: NDArray) -> NDArray:
    """Cells (m, k) in our order, of wedges as VTK may have them: their ends exchanged.

    VTK's manual has the first end of a wedge seen from outside, most programs have it from inside.
    """
    if NODES[nodes.shape[1]][0] != "wedge":
        return nodes
    a, b, c, d, e, f = points[nodes[:, :6]].transpose(1, 0, 2)
    along = (d + e + f - a - b - c) * np.cross(b - a, c - a)
    kept = TURNED[: nodes.shape[1]]
    return np.where(along.sum(axis=1)[:, None] < 0, nodes[:, kept], nodes[:, : len(kept)])


def split(points: NDArray, blocks: Sequence[Block]) -> Split:
    """Ten-node tetrahedra of all cells; those that the ``blocks`` have stay as they are.

    Blocks are of one order.

    Raises
    ------
    MeshError
        When an edge has two middle nodes, or a quadrilateral of a cell meets triangles of others.
    """
    edges = _Edges(len(points))
    ends = np.vstack([block.corners[:, block.kind.edges].reshape(-1, 2) for block in blocks])
    if blocks[0].second_order:
        edges.know(ends, np.concatenate([block.middles.ravel() for block in blocks]))
    else:
        ends = np.unique(np.sort(ends, axis=1), axis=0)
        edges.make(ends, ends[:, [0, 0, 1, 1]], ends, np.full(2, 1 / 2))
    if any(block.kind is not KINDS["tetra"] for block in blocks):
        check_middles(edges.known, edges.known_middles)
        _check_quadrilaterals(blocks)
        _cut_quadrilaterals(edges, blocks)
        _cut_bricks(edges, blocks)
    cells = [_ten_nodes(block, edges) for block in blocks]
    return Split(
        points=edges.weights @ points,
        weights=edges.weights,
        cells=np.vstack(cells),
        numbers=np.concatenate(
            [
                np.repeat(block.numbers, len(tetrahedra) // len(block.nodes))
                for block, tetrahedra in zip(blocks, cells, strict=True)
            ]
        ),
        parents=edges.parents,
    )


def _check_quadrilaterals(blocks: Sequence[Block]) -> None:
    """Check that no quadrilateral of a cell lies on triangles of others, which it would cut."""
    by_triangle = _by_corners(blocks, 3)
    if not by_triangle:
        return
    outside = {
        quad: its_cells for quad, its_cells in _by_corners(blocks, 4).items() if len(its_cells) == 1
    }
    for quad, (cell,) in outside.items():
        if crossed := [
            neighbour for three in combinations(quad, 3) for neighbour in by_triangle.get(three, ())
        ]:
            raise MeshError(
                f"a quadrilateral of cell {cell} meets a triangle of cell {crossed[0]}: a brick or "
                "wedge cannot stand on two tetrahedra; set a pyramid between them"
            )


def _by_corners(blocks: Sequence[Block], corners: int) -> dict[tuple[int, ...], list[int]]:
    """Numbers of the cells at each face with so many corners, by these."""
    by_face: dict[tuple[int, ...], list[int]] = {}
    for block in blocks:
        faces = np.sort(block.faces(corners), axis=2)
        for number, faces_of_cell in zip(block.numbers.tolist(), faces.tolist(), strict=True):
            for face in faces_of_cell:
                by_face.setdefault(tuple(face), []).append(number)
    return by_face


def _cut_quadrilaterals(edges: _Edges, blocks: Sequence[Block]) -> None:
    """Add the middles of the diagonals of all quadrilaterals."""
    quads = np.vstack([_from_first(block.faces(4).reshape(-1, 4)) for block in blocks])
    _, first = np.unique(np.sort(quads, axis=1), axis=0, return_index=True)
    quads = quads[first]
    around = edges.middles(np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1))
    edges.make(quads[:, [0, 2]], quads, np.hstack([quads, around]), OF_FACE)


def _cut_bricks(edges: _Edges, blocks: Sequence[Block]) -> None:
    """Add the middles of the diagonals through bricks, from the first of their corners."""
    for corners in (block.corners for block in blocks if block.kind is KINDS["hexahedron"]):
        around = edges.middles(corners[:, KINDS["hexahedron"].edges])
        first = corners.argmin(axis=1)[:, None]
        ends = np.take_along_axis(corners, np.hstack([first, OPPOSITE[first]]), axis=1)
        edges.make(ends, ends[:, [0, 0, 1, 1]], np.hstack([corners, around]), OF_BRICK)


def _from_first(faces: NDArray) -> NDArray:
    """Corners (n, k) of faces, in their order, from the node that stands first in the file."""
    k = faces.shape[1]
    turned = (faces.argmin(axis=1)[:, None] + np.arange(k)) % k
    return np.take_along_axis(faces, turned, axis=1)


def triangles_of(faces: Sequence[Sequence[int]]) -> NDArray[np.int64]:
    """Triangles (m, 3) of faces given by three or four corners, these cut along their diagonal."""
    triangles, quads = (
        np.array([face for face in faces if len(face) == k], dtype=int).reshape(-1, k)
        for k in (3, 4)
    )
    return np.vstack([triangles, _halves(quads)])


def _halves(quads: NDArray) -> NDArray:
    """Both triangles (2n, 3) of each quadrilateral (n, 4)."""
    return _from_first(quads)[:, [(0, 1, 2), (0, 2, 3)]].reshape(-1, 3)


def _ten_nodes(block: Block, edges: _Edges) -> NDArray:
    """Tetrahedra (m, 10) of a block, those of a cell next to each other."""
    if block.kind is KINDS["tetra"] and block.second_order:
        return block.nodes
    corners = _tetrahedra(block)
    return np.hstack([corners, edges.middles(corners[:, EDGES])])


def _tetrahedra(block: Block) -> NDArray:
    """Corners (m, 4) of the tetrahedra of a block, those of a cell next to each other."""
    if block.kind is KINDS["tetra"]:
        return block.corners
    n, first = len(block.nodes), block.corners.min(axis=1)[:, None, None]
    quads = block.faces(4).reshape(-1, 4)
    bases = np.hstack([block.faces(3), _halves(quads).reshape(n, -1, 3)])
    across = ~(bases == first).any(axis=2)  # as many of each cell
    a, b, c = bases[across].T
    return np.column_stack([a, c, b, np.repeat(first.ravel(), len(a) // n)])
