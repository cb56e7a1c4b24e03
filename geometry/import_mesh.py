"""Blade from a mesh of tetrahedra of another program."""

import warnings
from pathlib import Path

import gmsh
import numpy as np
from numpy.linalg import det
from numpy.typing import NDArray

from geometry.blade import MeshFile
from geometry.errors import MeshError, MeshWarning
from geometry.frame import rotation, to_blade
from geometry.mesh_faces import root_and_tip
from geometry.mesh_file import FileMesh, read_mesh_file
from geometry.shape import Shape
from geometry.tetrahedra import GMSH, MIRRORED, exterior, raised

TETRAHEDRON, TRIANGLE = 11, 9  # gmsh's ten- and six-node types
WHY_RAISED = (
    "four-node tetrahedra lock in bending (f1 some 4 to 11 % high): raised to ten nodes, but their "
    "edges stay straight where the blade is curved; export ten-node tetrahedra"
)


def import_mesh(source: MeshFile, path: str | Path) -> Shape:
    """Add the mesh at ``path`` to gmsh's model, as ten-node tetrahedra in the blade's frame.

    Nodes that no tetrahedron uses are left out. Four-node tetrahedra are raised to second order,
    with a ``MeshWarning``.

    Raises
    ------
    MeshError
        When the file cannot be read, is not one solid of tetrahedra, has cells inside out, does not
        agree with ``source.frame``, or has no root or tip.
    """
    mesh = read_mesh_file(path).without_unused()
    points, cells = _second_order(mesh, to_blade(mesh.points, source), source)
    _add_cells(points, cells)
    _check_orientation(points[cells[:, :4]].mean(axis=1))
    root, tip = root_and_tip(source, mesh, points, exterior(cells))
    _add_facets(root, tip)
    return Shape(solid=1, root=(1,), tip=(2,))


def _second_order(mesh: FileMesh, points: NDArray, source: MeshFile) -> tuple[NDArray, NDArray]:
    """Points and ten-node cells; reordered for a left-handed frame, which mirrors the cells."""
    cells = mesh.cells
    if mesh.facet_nodes == 3:
        warnings.warn(f"{source.file}: {WHY_RAISED}", MeshWarning, stacklevel=3)
        points, cells = raised(points, cells)
    return points, cells if det(rotation(source.frame)) > 0 else cells[:, MIRRORED]


def _add_cells(points: NDArray, cells: NDArray) -> None:
    gmsh.model.addDiscreteEntity(3, 1)
    gmsh.model.mesh.addNodes(3, 1, np.arange(len(points)) + 1, points.ravel())
    gmsh.model.mesh.addElementsByType(
        1, TETRAHEDRON, np.arange(len(cells)) + 1, (cells[:, GMSH] + 1).ravel()
    )


def _check_orientation(middles: NDArray) -> None:
    """Check the smallest Jacobian determinant of each cell, by gmsh's bound on its polynomial."""
    cells = np.arange(len(middles)) + 1
    smallest = np.array(gmsh.model.mesh.getElementQualities(cells, "minDetJac"))
    largest = np.array(gmsh.model.mesh.getElementQualities(cells, "maxDetJac"))
    ratio = smallest / np.maximum(np.abs(smallest), np.abs(largest))
    if np.any(ratio <= 0):
        worst = int(ratio.argmin())
        at = ", ".join(f"{x * 1e3:.1f}" for x in middles[worst])
        raise MeshError(
            f"{np.sum(ratio <= 0)} of {len(cells)} cells are inside out; the worst (Jacobian ratio "
            f"{ratio[worst]:.2f}) is at {at} mm in the blade's frame: repair the mesh"
        )


def _add_facets(root: NDArray, tip: NDArray) -> None:
    for surface, facets in ((1, root), (2, tip)):
        gmsh.model.addDiscreteEntity(2, surface)
        gmsh.model.mesh.addElementsByType(surface, TRIANGLE, [], (facets + 1).ravel())
