"""Outlines of patches of six-node facets, and the surface of tetrahedra."""

import numpy as np
from refused import refused

from geometry.base import MeshError
from geometry.root_and_tip import outline_of
from geometry.split import Block, split
from geometry.tetrahedra import exterior, neighbours, outlines


def six_node(corners):
    """Facets with a middle node on each edge, and the edge of each middle node."""
    ends = np.sort(np.array(corners)[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges, edge = np.unique(ends, axis=0, return_inverse=True)
    return np.hstack([corners, 100 + edge.reshape(-1, 3)]), edges


def grid(n, without=()):
    """Facets of n x n squares, two each, and their points; some squares left out."""
    corners = []
    for i in range(n):
        for j in range(n):
            if (i, j) not in without:
                a, b, c, d = (
                    k * (n + 1) + m for k, m in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
                )
                corners += [(a, b, c), (a, c, d)]
    facets, edges = six_node(corners)
    places = np.array([(i, j, 0.0) for i in range(n + 1) for j in range(n + 1)])
    points = np.zeros((100 + len(edges), 3))
    points[: len(places)] = places
    points[100:] = places[edges].mean(axis=1)
    return facets, points


def test_outline_goes_once_around_in_steps_of_half_an_edge():
    facets, points = grid(3)
    (line,) = outlines(facets)
    assert len(line) == len(set(line)) == 24
    steps = np.diff(points[np.append(line, line[0])], axis=0)
    np.testing.assert_allclose(np.abs(steps).sum(axis=1), 0.5, rtol=1e-15)


def test_outline_of_the_tip_is_the_outer_one():
    """A hollow blade: the line around its hole comes later and is shorter."""
    facets, points = grid(3, without=[(1, 1)])
    assert sorted(map(len, outlines(facets))) == [8, 24]
    for order in (facets, facets[::-1]):
        on_border = np.isin(points[outline_of(order, points)], (0, 3)).any(axis=1)
        assert on_border.all()
        assert len(on_border) == 24


def test_outline_that_touches_itself_is_refused():
    facets, _ = grid(4, without=[(1, 1), (2, 2)])
    refused(MeshError, outlines, facets, match="touches itself")


def test_tip_in_two_pieces_is_refused():
    facets, points = grid(3, without=[(1, j) for j in range(3)])
    refused(MeshError, outline_of, facets, points, match="in 2 pieces")


def test_neighbours_share_an_edge():
    """Of a grid of squares: the diagonals, and the sides inside."""
    n = 3
    facets, _ = grid(n)
    one, other = neighbours(facets)
    assert len(one) == n * n + 2 * n * (n - 1)
    shared = [len({*facets[i, :3]} & {*facets[j, :3]}) for i, j in zip(one, other, strict=True)]
    assert set(shared) == {2}
    assert len({frozenset(pair) for pair in zip(one, other, strict=True)}) == len(one)


def test_a_surface_is_closed_and_outside():
    """Every edge of the outer triangles belongs to two of them; two tetrahedra share a face."""
    points = np.array([[0, 0, -1], [0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    cells = Block(np.array([[0, 1, 2, 3], [1, 2, 3, 4]]), np.arange(2))
    triangles = exterior(split(points, [cells]).cells)[:, :3]
    assert len(triangles) == 6 and [1, 2, 3] not in np.sort(triangles).tolist()
    edges = np.sort(
        np.concatenate([triangles[:, pair] for pair in ([0, 1], [1, 2], [0, 2])]), axis=1
    )
    _, count = np.unique(edges, axis=0, return_counts=True)
    assert (count == 2).all()
