"""Blade from a mesh of another program."""

import warnings
from pathlib import Path

import gmsh
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from geometry.base import MeshError, MeshWarning, require
from geometry.blade import MeshGeometry
from geometry.file_mesh import FileMesh
from geometry.frame import axes, to_blade, turned
from geometry.jacobians import of_file, of_tetrahedra
from geometry.readers import read_mesh_file
from geometry.root_and_tip import root_and_tip
from geometry.shape import CELL, FACET, Shape
from geometry.tetrahedra import EDGES, GMSH, edge_lengths, exterior

LEAST_AROUND = 80.0  # degrees; 255 on our own meshes, 112 at a sharp edge with 40 degrees of sweep
MOST_BENT = 0.5  # of an edge's length: half a circle; below 0.02 on our own meshes
MERGED = 1e-3  # of the median edge; above 0.03 across a thin trailing edge
MOST_ALONG = 0.24  # of an edge, from its middle to its middle node
STRAIGHTEN = "straighten its edges (`mesh_file.straighten: true`)"
BY_MATRICES = "give the matrices of its program by `full_matrices` (fem/matrices.md)"
FACETED = (
    "cells of first order are taken as ten-node tetrahedra, for four-node ones lock in bending (f1 "
    "some 4 to 11 % high); but their edges stay straight where the blade is curved: export cells "
    "of second order"
)


def import_mesh(source: MeshGeometry, path: str | Path) -> Shape:
    """Add the mesh at ``path`` to gmsh's model, as ten-node tetrahedra in the blade's frame.

    Nodes that no cell uses are left out. Cells of first order are raised to second, with a
    ``MeshWarning``, as is the cost of edges that are straightened.

    Raises
    ------
    MeshError
        When the file cannot be read, has physics that a blade here has not, is not one solid, has
        cells inside out or flat where they are integrated, nodes that are not merged, a corner far
        from all others or a middle node far from that of its edge, does not agree with
        ``source.frame``, or has no root or tip, or a tip that is a part of its face.
    """
    file = read_mesh_file(path)
    file.physics.require_plain()
    mesh = file.without_unused()
    if mesh.made:
        print(f"{source.file}: {mesh.made}")
    if mesh.first_order:
        warnings.warn(f"{source.file}: {FACETED}", MeshWarning, stacklevel=2)
    points, cells = to_blade(mesh.points, source), turned(mesh.cells, source)
    given = np.arange(len(points)) < len(points) - len(mesh.parents)  # nodes of the file
    points = eased(points, cells, mesh.parents)
    _check_order(points, cells)
    if source.straighten:
        points = _straightened(source, points, cells, given)
    _check_bent(points, cells, given)
    surface = exterior(cells)
    _check_merged(points, cells, np.unique(surface))
    _check_needles(points, surface)
    if not source.straighten:
        _check_own_cells(source, file)
    _check_along(points, cells, given)
    _check_cells(source, points, cells, mesh.numbers)
    _add(points, cells, *root_and_tip(source, mesh, points, surface))
    return Shape(solid=1, root=(1,), tip=(2,), physics=mesh.physics)


def eased(points: NDArray, cells: NDArray, parents: NDArray) -> NDArray:
    """The points, the middles of diagonals nearer to the middle between their ends.

    The map of a cell that is no parallelepiped shifts them along the diagonal, which makes
    tetrahedra stiff: f2 of bricks with creases errs by 3.2 %, so by 0.9 %. They keep the shift out
    of their quadrilateral, that is the shape of the surface; and all of it where a cell would be
    turned inside out.
    """
    if not len(parents):
        return points
    found, new = points.copy(), np.arange(len(points) - len(parents), len(points))
    a, b, c, d = points[parents].transpose(1, 0, 2)
    normal = np.cross(c - a, d - b)  # 0 of an edge or the diagonal of a brick
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
    middle = np.where(length > 0, a + c, a + d) / 2
    out = ((points[new] - middle) * normal).sum(axis=1, keepdims=True)
    found[new] = middle + out * normal
    turned_over = cells[~(of_tetrahedra(found, cells).ratios > 0)]
    kept = np.intersect1d(turned_over, new)
    found[kept] = points[kept]
    return found


def _check_needles(points: NDArray, surface: NDArray) -> None:
    """Check the angles of the facets around each corner: a node moved outwards has small ones.

    It stretches its cells without turning them inside out.
    """
    corners = points[surface[:, :3]]
    ahead, behind = (np.roll(corners, turn, axis=1) - corners for turn in (-1, 1))
    turned, along = np.linalg.norm(np.cross(ahead, behind), axis=2), (ahead * behind).sum(axis=2)
    angles = np.degrees(np.arctan2(turned, along))
    around = np.bincount(surface[:, :3].ravel(), angles.ravel())
    nodes = np.unique(surface[:, :3])
    worst = nodes[around[nodes].argmin()]
    require(
        (
            around[worst] >= LEAST_AROUND,
            f"the node at {_place(points[worst])} mm in the blade's frame stands out of the "
            f"surface: the facets around it make {around[worst]:.0f} degrees (allowed from "
            f"{LEAST_AROUND:g}): correct its coordinates, or {BY_MATRICES}",
        )
    )


def _check_order(points: NDArray, cells: NDArray) -> None:
    """Check that the middle nodes are not in gmsh's order."""
    by_vtk, by_gmsh = (
        _off_middle(points, given)[1].max() <= MOST_BENT for given in (cells, cells[:, GMSH])
    )
    require(
        (
            by_vtk or not by_gmsh,
            "the middle nodes are in gmsh's order, not in that of the format: exchange the last "
            "two nodes of each cell",
        )
    )


def _check_bent(points: NDArray, cells: NDArray, given: NDArray) -> None:
    """Check that no edge is bent beyond half a circle: its middle node was moved.

    Out of the surface, where the cell grows with it and is not turned inside out. ``given`` (n,):
    whether a node is of the file; those of diagonals are where they must be.
    """
    off, bent, _ = _off_middle(points, cells)
    bent = np.where(given[cells[:, 4:]], bent, 0.0)
    cell, edge = np.unravel_index(bent.argmax(), bent.shape)
    require(
        (
            bent[cell, edge] <= MOST_BENT,
            f"the node at {_place(points[cells[cell, 4 + edge]])} mm in the blade's frame is "
            f"{1e3 * off[cell, edge]:.3g} mm from the middle of its edge, {bent[cell, edge]:.2g} "
            f"times its length (allowed {MOST_BENT:g}): correct its coordinates, or {STRAIGHTEN}",
        )
    )


def _check_along(points: NDArray, cells: NDArray, given: NDArray) -> None:
    """Check that no middle node of the file is at a quarter of its edge, as at a crack's tip."""
    off = np.where(given[cells[:, 4:]], abs(_off_middle(points, cells)[2] - 0.5), 0.0)
    cell, edge = np.unravel_index(off.argmax(), off.shape)
    require(
        (
            not off[cell, edge] > MOST_ALONG,  # not a number where an edge has no length
            f"the middle node at {_place(points[cells[cell, 4 + edge]])} mm in the blade's frame "
            f"is at {0.5 - off[cell, edge]:.2g} of its edge (allowed {0.5 - MOST_ALONG:g} to 0.5), "
            f"where the cell is flat at a corner: move it to the middle, {STRAIGHTEN}, or "
            f"{BY_MATRICES}",
        )
    )


def _straightened(source: MeshGeometry, points: NDArray, cells: NDArray, given: NDArray) -> NDArray:
    """The points with straight edges of those cells that would be refused; tells what that costs.

    A cell may become one of them when an edge of its neighbour is straightened.
    """
    straight, curved = points.copy(), np.ones(len(points), dtype=bool)
    while True:
        _, bent, along = _off_middle(straight, cells)
        off = (bent > MOST_BENT) | (abs(along - 0.5) > MOST_ALONG)
        refused = (off & given[cells[:, 4:]]).any(axis=1) | ~(
            of_tetrahedra(straight, cells).ratios > 0
        )
        middles, first = np.unique(cells[refused, 4:], return_index=True)
        ends = cells[refused][:, EDGES].reshape(-1, 2)[first]
        ends, middles = ends[curved[middles]], middles[curved[middles]]
        if not len(middles):
            break
        straight[middles], curved[middles] = straight[ends].mean(axis=1), False
    before, after = (of_tetrahedra(p, cells).volumes.sum() for p in (points, straight))
    moved = np.linalg.norm(straight - points, axis=1)
    warnings.warn(
        f"{source.file}: straighten: {np.sum(~curved)} middle nodes moved to the middle of their "
        f"edge, by up to {1e3 * moved.max():.3g} mm; the volume changes by "
        f"{100 * (after / before - 1):+.2g} % (f1 errs by some as much)",
        MeshWarning,
        stacklevel=3,
    )
    return straight


def _off_middle(points: NDArray, cells: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Distance of each middle node from the middle of its edge: m, and over the edge's length.

    The third: where it is along the edge, 0 to 1 from end to end.
    """
    ends = points[cells[:, EDGES]]
    vector = points[cells[:, 4:]] - ends.mean(axis=2)
    off, length = np.linalg.norm(vector, axis=2), edge_lengths(points, cells)
    across = (vector * (ends[:, :, 1] - ends[:, :, 0])).sum(axis=2)
    with np.errstate(divide="ignore", invalid="ignore"):
        return off, np.where(length > 0, off / length, np.inf), 0.5 + across / length**2


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


def _add(points: NDArray, cells: NDArray, root: NDArray, tip: NDArray) -> None:
    """Add the solid 1 and its surfaces 1 and 2, root and tip, to gmsh's model."""
    gmsh.model.addDiscreteEntity(3, 1)
    gmsh.model.mesh.addNodes(3, 1, np.arange(len(points)) + 1, points.ravel())
    gmsh.model.mesh.addElementsByType(
        1, CELL, np.arange(len(cells)) + 1, (cells[:, GMSH] + 1).ravel()
    )
    for surface, facets in ((1, root), (2, tip)):
        gmsh.model.addDiscreteEntity(2, surface)
        gmsh.model.mesh.addElementsByType(surface, FACET, [], (facets + 1).ravel())


def _check_own_cells(source: MeshGeometry, file: FileMesh) -> None:
    """Check the cells of the file by their own shape functions, before they are split."""
    placed = file.points @ axes(source).T
    remedy = "repair it" if file.first_order else f"repair it, or, if it is curved, {STRAIGHTEN}"
    for block in file.blocks:
        _require_positive(
            of_file(file.points, block).ratios,
            placed[block.corners].mean(axis=1),
            block.numbers,
            remedy,
        )


def _check_cells(source: MeshGeometry, points: NDArray, cells: NDArray, numbers: NDArray) -> None:
    """Check our tetrahedra of cells with these ``numbers`` (n,), which are sound as they are."""
    remedy = f"its tetrahedra here are, the cell itself is not: {STRAIGHTEN}, or {BY_MATRICES}"
    _require_positive(
        of_tetrahedra(points, cells).ratios,
        points[cells[:, :4]].mean(axis=1),
        numbers,
        f"repair it, or {BY_MATRICES}" if source.straighten else remedy,
    )


def _require_positive(found: NDArray, middles: NDArray, numbers: NDArray, remedy: str) -> None:
    """Refuse cells of which a Jacobian determinant where they are integrated is not positive.

    ``found`` (n,): smallest over largest; ``middles`` (n, 3), m, in the blade's frame.
    """
    worst = int(found.argmin())
    mirrored = "all are: reverse the order of their nodes, or the axis that is mirrored"
    require(
        (
            np.all(found > 0),
            f"{np.sum(~(found > 0))} of {len(found)} cells are inside out or flat; the worst "
            f"(Jacobian ratio {found[worst]:.2f}, where it is integrated) is at "
            f"{_place(middles[worst])} mm in the blade's frame, of cell {numbers[worst]} of the "
            f"file: {mirrored if np.all(found < 0) else remedy}",
        )
    )
