"""Topology of ten-node tetrahedra in VTK's order: facets, edges, and checks that they are a solid.

Nodes are the corners 0 to 3, then the middles of the edges (0,1), (1,2), (0,2), (0,3), (1,3),
(2,3).
"""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix

from geometry.base import require

EDGES = np.array([(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)])
# six nodes each, seen from outside: corners anticlockwise, then the middles of the edges after them
FACETS = np.array([(0, 2, 1, 6, 5, 4), (0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 9, 8), (0, 3, 2, 7, 9, 6)])
MIRRORED = np.array([1, 0, 2, 3, 4, 6, 5, 8, 7, 9])  # corners 0 and 1 exchanged
GMSH = np.array([0, 1, 2, 3, 4, 5, 6, 7, 9, 8])  # gmsh's order, with the last two exchanged


def edge_lengths(points: NDArray, cells: NDArray) -> NDArray[np.float64]:
    """Distances (n, 6) of the ends of each edge of ``cells``."""
    ends = points[cells[:, EDGES]]
    return np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=2)


def exterior(cells: NDArray) -> NDArray[np.int64]:
    """Boundary facets (n, 6): those that belong to one cell only.

    Raises
    ------
    MeshError
        When the cells are not one solid: not connected, facets of three cells, edges with two
        middle nodes, or a surface that is not manifold.
    """
    facets = cells[:, FACETS].reshape(-1, 6)
    _, first, which, sharing = np.unique(
        np.sort(facets[:, :3], axis=1),
        axis=0,
        return_index=True,
        return_inverse=True,
        return_counts=True,
    )
    require(
        (
            not np.any(sharing > 2),
            f"{np.sum(sharing > 2)} facets belong to more than two cells: remove cells that "
            f"overlap or stand twice",
        )
    )
    check_middles(np.sort(cells[:, EDGES].reshape(-1, 2), axis=1), cells[:, 4:].ravel())
    pieces = _pieces(np.repeat(np.arange(len(cells)), 4), which.ravel())
    sizes = np.sort(np.bincount(pieces))[::-1]
    require(
        (
            len(sizes) == 1,
            f"the cells are in {len(sizes)} pieces ({sizes[0]} cells in the largest, {sizes[-1]} "
            f"in the smallest): merge coincident nodes, and keep the blade alone",
        )
    )
    outside = facets[first[sharing == 1]]
    # two facets meet at each edge of the surface; four where a solid touches itself
    _, meeting = np.unique(_edges(outside), axis=0, return_counts=True)
    require(
        (
            np.all(meeting == 2),
            f"the surface is not manifold: at {np.sum(meeting != 2)} of its edges more than two "
            f"facets meet; separate the cells that touch there along an edge only",
        )
    )
    return outside


def patches(facets: NDArray) -> NDArray[np.int64]:
    """Number (n,) of the connected patch of each facet; facets of a patch share edges."""
    _, edge = np.unique(_edges(facets), axis=0, return_inverse=True)
    return _pieces(np.repeat(np.arange(len(facets)), 3), edge.ravel())


def neighbours(facets: NDArray) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Numbers (m,) of the two facets at each edge that exactly two of ``facets`` share."""
    _, edge, sharing = np.unique(_edges(facets), axis=0, return_inverse=True, return_counts=True)
    by_edge = np.argsort(edge.ravel(), kind="stable")
    pairs = by_edge[sharing[edge.ravel()[by_edge]] == 2] // 3  # three edges a facet, in order
    return pairs[::2], pairs[1::2]


def outlines(facets: NDArray) -> list[NDArray[np.int64]]:
    """Boundary lines of facets (n, 6): closed lists of nodes in order, with mid-edge nodes.

    Raises
    ------
    MeshError
        When two lines share a node.
    """
    ends = facets[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    _, which, sharing = np.unique(
        np.sort(ends, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    border = sharing[which.ravel()] == 1
    links = zip(*ends[border].T.tolist(), facets[:, 3:].ravel()[border].tolist(), strict=True)
    after = {node: (middle, following) for node, following, middle in links}
    require((len(after) == border.sum(), "the outline of the facets touches itself at a node"))
    lines = []
    while after:
        node, line = next(iter(after)), []
        while node in after:
            middle, following = after.pop(node)
            line += [node, middle]
            node = following
        lines.append(np.array(line))
    return lines


def _edges(facets: NDArray) -> NDArray:
    return np.sort(facets[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)


def _pieces(member: NDArray, shared: NDArray) -> NDArray:
    """Number of the connected component of each member; those with the same ``shared`` connect."""
    n = int(member.max()) + 1
    shape = (n + int(shared.max()) + 1,) * 2
    from scipy.sparse.csgraph import connected_components  # slow, and few jobs need it

    graph = coo_matrix((np.ones(len(member)), (member, n + shared)), shape=shape)
    return connected_components(graph, directed=False)[1][:n]


def check_middles(ends: NDArray, middles: NDArray) -> None:
    """Check that edges with the same ``ends`` (n, 2), in order, have the same middle node (n,).

    Raises
    ------
    MeshError
        When one has two.
    """
    edges, with_middle = (
        len(np.unique(rows, axis=0)) for rows in (ends, np.column_stack([ends, middles]))
    )
    require(
        (
            with_middle == edges,
            f"{with_middle - edges} edges have two middle nodes: merge the coincident nodes",
        )
    )
