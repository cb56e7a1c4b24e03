"""Jacobian determinants of solid cells at the points at which they are integrated."""

from typing import NamedTuple

import gmsh
import numpy as np
from meshio.gmsh.common import _meshio_to_gmsh_order
from numpy.typing import NDArray

import basix

from geometry.split import NODES, Block

FAMILIES = {
    "tetra": "Tetrahedron",
    "pyramid": "Pyramid",
    "wedge": "Prism",
    "hexahedron": "Hexahedron",
}
DEGREE = 4  # of the quadrature of our tetrahedra: exact for the tangent on straight-sided ones
FLAT = 1e-7  # determinant of a flat cell, over the cubed size of it
AT_ONCE = 20_000  # cells


class Determinants(NamedTuple):
    """Determinants of cells, and volumes in the cubed unit of their points."""

    ratios: NDArray[np.float64]  # (m,), smallest over largest; 0 of a flat cell
    volumes: NDArray[np.float64]  # (m,)


def of_file(points: NDArray, block: Block) -> Determinants:
    """Determinants of a file's cells by their own shape functions, without nodes within faces.

    At the Gauss points that are exact for a matrix of stiffness of straight cells: two along an
    edge of first order, three of second. A session of gmsh, whose functions these are, is open.
    """
    kind, second = NODES[block.nodes.shape[1]]
    nodes = np.hstack([block.corners, block.middles]) if second else block.corners
    number = gmsh.model.mesh.getElementType(FAMILIES[kind], 1 + second, True)
    order = _meshio_to_gmsh_order(f"{kind}{nodes.shape[1]}" if second else kind, nodes)
    local, weights = gmsh.model.mesh.getIntegrationPoints(number, f"Gauss{5 if second else 3}")
    return _determinants(points, order, number, local, weights)


def of_tetrahedra(points: NDArray, cells: NDArray) -> Determinants:
    """Determinants of ten-node tetrahedra (m, 10), in VTK's order, where we integrate them."""
    number = gmsh.model.mesh.getElementType("Tetrahedron", 2)
    local, weights = map(np.asarray, basix.make_quadrature(basix.CellType.tetrahedron, DEGREE))
    order = _meshio_to_gmsh_order("tetra10", cells)
    return _determinants(points, order, number, local.ravel(), weights)


def _determinants(
    points: NDArray, cells: NDArray, number: int, local: NDArray, weights: NDArray
) -> Determinants:
    """Those of ``cells`` (m, k) of gmsh's type ``number`` at ``local`` coordinates (3 p,)."""
    _, values, _ = gmsh.model.mesh.getBasisFunctions(number, local, "GradLagrange")
    gradients = values.reshape(len(weights), cells.shape[1], 3)
    parts = np.array_split(cells, len(cells) // AT_ONCE + 1)
    found = np.vstack(
        [
            np.linalg.det(np.einsum("pka,mkx->mpax", gradients, points[part], optimize=True))
            for part in parts
        ]
    )
    smallest, largest = found.min(axis=1), abs(found).max(axis=1)
    size = np.ptp(points[cells], axis=1).max(axis=1)
    solid = largest > FLAT * size**3
    ratios = np.divide(smallest, largest, out=np.zeros_like(largest), where=solid)
    return Determinants(ratios, found @ weights)
