"""Six-node triangles: shape functions, and the triangle that contains a place.

Nodes are the corners 0 to 2, then the middles of the edges (0,1), (1,2), (2,0), as in VTK and gmsh.
"""

import numpy as np
from numpy.typing import NDArray

NEWTON = 20  # iterations; three or four are enough for nearly straight sides
TURNED = np.array([0, 2, 1, 5, 4, 3])  # nodes of the facet with reversed normal


def shape_functions(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Values (n, 6) at ``x`` (n, 2) in the triangle with corners (0, 0), (1, 0), (0, 1)."""
    a, b = x.T
    c = 1 - a - b
    return np.column_stack(
        [c * (2 * c - 1), a * (2 * a - 1), b * (2 * b - 1), 4 * a * c, 4 * a * b, 4 * b * c]
    )


def shape_gradients(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Gradients (n, 6, 2) of the shape functions with respect to ``x`` (n, 2)."""
    a, b = x.T
    c, zero = 1 - a - b, np.zeros_like(a)
    along = [1 - 4 * c, 4 * a - 1, zero, 4 * (c - a), 4 * b, -4 * b]
    across = [1 - 4 * c, zero, 4 * b - 1, -4 * a, 4 * a, 4 * (c - b)]
    return np.stack([along, across]).transpose(2, 1, 0)


def normals(facets: NDArray[np.int64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Normals (k, 3) of ``facets`` (k, 3 or 6) by their corners, twice as long as the area, m2."""
    a, b, c = points[facets[:, :3]].transpose(1, 0, 2)
    return np.cross(b - a, c - a)


def outward(facets: NDArray[np.int64], points: NDArray[np.float64]) -> NDArray[np.int64]:
    """The facets (k, 6) of a tip, all oriented with normals radially outward."""
    middle = points[facets[:, 0]] + points[facets[:, 1]] + points[facets[:, 2]]
    inward = (normals(facets, points)[:, :2] * middle[:, :2]).sum(axis=1) < 0
    return np.where(inward[:, None], facets[:, TURNED], facets)


def nearest_facet(
    corners: NDArray[np.float64], place: NDArray[np.float64]
) -> tuple[int, NDArray[np.float64]]:
    """Facet that contains ``place`` (2,), and its local coordinates there (2,).

    ``corners`` (k, 6, 2): nodes of the facets in a plane. Without such a facet, the one with the
    smallest violation of the local bounds.
    """
    x = np.full((len(corners), 2), 1 / 3)
    for _ in range(NEWTON):
        off = np.einsum("kn,knd->kd", shape_functions(x), corners) - place
        jacobian = np.einsum("kne,knd->kde", shape_gradients(x), corners)
        x = np.clip(x - np.linalg.solve(jacobian, off[..., None])[..., 0], -3, 4)
    outside = np.maximum(np.maximum(-x.min(axis=1), x.sum(axis=1) - 1), 0)
    facet = int(outside.argmin())
    return facet, x[facet]
