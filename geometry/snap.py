"""Interface nodes on a mesh that is as it is: each place takes the nearest node of the tip."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from geometry.errors import MeshError
from geometry.interface import InterfaceNodes

ALONG = 0.5  # of the spacing of the places, how far a node may be off; so no two are one
OFF = 0.1  # of the spacing, how far a place may be off the tip


def snapped(places: NDArray, points: NDArray, nodes: NDArray, tip: NDArray) -> InterfaceNodes:
    """Of ``nodes``, on the tip's facets (k, 6), those nearest to ``places`` (n, 3), m.

    Raises
    ------
    MeshError
        When a place is off the tip, or the nearest node is half the spacing of the places away.
    """
    distance, nearest = cKDTree(points[nodes]).query(places)
    spacing = np.linalg.norm(np.diff(places, axis=0), axis=1).min()
    normals = _normals(points, tip)[nodes[nearest]]
    height = np.abs(np.einsum("ij,ij->i", places - points[nodes[nearest]], normals))
    _refuse(height > OFF * spacing, height, f"off the tip; allowed {OFF * spacing * 1e3:.3g} mm")
    _refuse(
        distance >= ALONG * spacing,
        distance,
        f"off the nearest node of the tip, half their spacing of {spacing * 1e3:.3g} mm or more: "
        f"refine the tip, or ask for fewer nodes",
    )
    return InterfaceNodes(points=points[nodes[nearest]])


def _normals(points: NDArray, facets: NDArray) -> NDArray:
    """Unit normal at each node (n, 3) of flat facets; zero elsewhere."""
    a, b, c = (points[facets[:, i]] for i in range(3))
    normals = np.zeros_like(points)
    np.add.at(normals, facets, np.cross(b - a, c - a)[:, None])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return normals / np.where(length > 0, length, 1)


def _refuse(wrong: NDArray, off: NDArray, where: str) -> None:
    if np.any(wrong):
        numbers = ", ".join(str(i + 1) for i in np.flatnonzero(wrong))
        raise MeshError(f"interface nodes {numbers}: up to {off.max() * 1e3:.3g} mm {where}")
