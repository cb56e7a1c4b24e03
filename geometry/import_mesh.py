"""Blade from a mesh of another program."""

import warnings
from pathlib import Path

import gmsh
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from geometry.blade import MeshFile
from geometry.frame import to_blade, turned
from geometry.mesh_faces import root_and_tip
from geometry.mesh_file import read_mesh_file
from geometry.project import MeshError, MeshWarning
from geometry.shape import CELL, FACET, Shape, jacobian_ratios
from geometry.tetrahedra import EDGES, GMSH, edge_lengths, exterior

MOST_APART = 4.0  # times; 1.6 on our own meshes
MOST_BENT = 0.5  # of an edge's length: half a circle; below 0.02 on our own meshes
MERGED = 1e-3  # of the median edge; above 0.03 across a thin trailing edge
FLAT = 1e-6  # radius of the sphere within a cell over that around it, 1 of a regular one
FACETED = (
    "cells of first order are taken as ten-node tetrahedra, for four-node ones lock in bending (f1 "
    "some 4 to 11 % high); but their edges stay straight where the blade is curved: export cells "
    "of second order"
)


def import_mesh(source: MeshFile, path: str | Path) -> Shape:
    """Add the mesh at ``path`` to gmsh's model, as ten-node tetrahedra in the blade's frame.

    Nodes that no cell uses are left out. Cells of first order are raised to second, with a
    ``MeshWarning``.

    Raises
    ------
    MeshError
        When the file cannot be read, is not one solid, has cells inside out or flat, nodes that are
        not merged, a corner far from all others or a middle node far from its edge, does not agree
        with ``source.frame``, or has no root or tip, or a tip that is a part of its face.
    """
    mesh = read_mesh_file(path).without_unused()
    if mesh.made:
        print(f"{source.file}: {mesh.made}")
    if mesh.first_order:
        warnings.warn(f"{source.file}: {FACETED}", MeshWarning, stacklevel=2)
    points, cells = to_blade(mesh.points, source), turned(mesh.cells, source)
    _check_bent(points, cells)
    surface = exterior(cells)
    _check_merged(points, cells, np.unique(surface))
    _check_distances(points, cells)
    _add_cells(points, cells)
    _check_orientation(points[cells[:, :4]].mean(axis=1), mesh.numbers)
    root, tip = root_and_tip(source, mesh, points, surface)
    _add_facets(root, tip)
    return Shape(solid=1, root=(1,), tip=(2,), materials=mesh.materials)


def _check_distances(points: NDArray, cells: NDArray) -> None:
    """Check that no corner is much farther from its neighbours than these are from theirs.

    A node that was moved out of the surface stretches its cells without turning them inside out.
    """
    corners, ends = np.unique(cells[:, EDGES], return_inverse=True)
    ends = np.unique(np.sort(ends.reshape(-1, 2), axis=1), axis=0)
    length = np.linalg.norm(np.diff(points[corners[ends]], axis=1)[:, 0], axis=1)
    nearest = np.full(len(corners), np.inf)
    np.minimum.at(nearest, ends, length[:, None])
    neighbours = np.bincount(ends.ravel(), nearest[ends[:, ::-1]].ravel())
    ratio = nearest * np.bincount(ends.ravel()) / neighbours  # over their mean
    worst = int(ratio.argmax())
    if not ratio[worst] <= MOST_APART:
        raise MeshError(
            f"the node at {_place(points[corners[worst]])} mm in the blade's frame is "
            f"{1e3 * nearest[worst]:.3g} mm from its neighbours, {ratio[worst]:.2g} times as far "
            f"as these from theirs (allowed {MOST_APART:g}): correct its coordinates"
        )


def _check_bent(points: NDArray, cells: NDArray) -> None:
    """Check that no edge is bent beyond half a circle: its middle node was moved.

    Out of the surface, where the cell grows with it and is not turned inside out.
    """
    off, bent = _off_middle(points, cells)
    if bent.max() > MOST_BENT and _off_middle(points, cells[:, GMSH])[1].max() <= MOST_BENT:
        raise MeshError(
            "the middle nodes are in gmsh's order, not in that of the format: exchange the last "
            "two nodes of each cell"
        )
    cell, edge = np.unravel_index(bent.argmax(), bent.shape)
    if not bent[cell, edge] <= MOST_BENT:
        raise MeshError(
            f"the node at {_place(points[cells[cell, 4 + edge]])} mm in the blade's frame is "
            f"{1e3 * off[cell, edge]:.3g} mm from the middle of its edge, {bent[cell, edge]:.2g} "
            f"times its length (allowed {MOST_BENT:g}): correct its coordinates"
        )


def _off_middle(points: NDArray, cells: NDArray) -> tuple[NDArray, NDArray]:
    """Distance of each middle node from the middle of its edge: m, and over the edge's length."""
    off = np.linalg.norm(points[cells[:, 4:]] - points[cells[:, EDGES]].mean(axis=2), axis=2)
    length = edge_lengths(points, cells)
    return off, np.divide(off, length, out=np.full_like(off, np.inf), where=length > 0)


def _check_merged(points: NDArray, cells: NDArray, surface: NDArray) -> None:
    """Check that no two nodes of the ``surface`` are at the same place, as on both sides of a cut.

    The cells there are not connected: the blade is too soft, and DOLFINx may abort.
    """
    edge = np.median(edge_lengths(points, cells))
    pairs = KDTree(points[surface]).query_pairs(MERGED * edge, output_type="ndarray")
    if len(pairs):
        raise MeshError(
            f"{len(pairs)} pairs of nodes are not merged, the first at "
            f"{_place(points[surface[pairs[0, 0]]])} mm in the blade's frame: merge coincident "
            "nodes"
        )


def _place(point: NDArray) -> str:
    """Coordinates for messages, mm."""
    return ", ".join(f"{x * 1e3:.1f}" for x in point)


def _add_cells(points: NDArray, cells: NDArray) -> None:
    gmsh.model.addDiscreteEntity(3, 1)
    gmsh.model.mesh.addNodes(3, 1, np.arange(len(points)) + 1, points.ravel())
    gmsh.model.mesh.addElementsByType(
        1, CELL, np.arange(len(cells)) + 1, (cells[:, GMSH] + 1).ravel()
    )


def _check_orientation(middles: NDArray, numbers: NDArray) -> None:
    """Check the smallest Jacobian determinant of each cell, by gmsh's bound on its polynomial.

    ``numbers`` (n,): of the cells of the file.
    """
    cells = np.arange(len(middles)) + 1
    # the bounds of a flat cell would take milliseconds
    solid = np.abs(gmsh.model.mesh.getElementQualities(cells, "gamma")) > FLAT
    ratio = jacobian_ratios() if solid.all() else solid.astype(float)
    if not np.all(ratio > 0):
        worst = int(ratio.argmin())
        raise MeshError(
            f"{np.sum(~(ratio > 0))} of {len(cells)} cells are inside out or flat; the worst "
            f"(Jacobian ratio {ratio[worst]:.2f}) is at {_place(middles[worst])} mm in the blade's "
            f"frame, of cell {numbers[worst]} of the file: repair the mesh"
        )


def _add_facets(root: NDArray, tip: NDArray) -> None:
    for surface, facets in ((1, root), (2, tip)):
        gmsh.model.addDiscreteEntity(2, surface)
        gmsh.model.mesh.addElementsByType(surface, FACET, [], (facets + 1).ravel())
