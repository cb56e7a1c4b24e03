"""Given matrices on the nodes of the mesh that their program read: free nodes, clamp and tip."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix, eye_array, kron

from fem.interface_operator import on_patches
from fem.matrix_files import FileMatrix
from geometry.base import MeshError, about, require
from geometry.blade import MeshFile
from geometry.file_mesh import UNITS
from geometry.frame import rotation, to_blade
from geometry.readers import read_mesh_file
from geometry.root_and_tip import root_and_tip
from geometry.tetrahedra import exterior


class Deck(NamedTuple):
    """The nodes of given matrices, in the blade's frame, m; DoF 3 p + c is of free node p."""

    numbers: NDArray[np.int64]  # (n,), in the files, ascending, of the free nodes
    clamped: NDArray[np.int64]  # in the files, of those nodes of the root that have rows
    coordinates: NDArray[np.float64]  # (n, 3), of the free nodes
    hub_radius: float  # mean of the root's nodes
    points: NDArray[np.float64]  # (p, 3), nodes of the tetrahedra
    tip: NDArray[np.int64]  # (k, 6), its facets, rows of ``points``
    weights: csr_matrix  # (p, n), of the free nodes in the displacement of each point
    turn: NDArray[np.float64] = np.eye(3)  # from the axes of the files
    unit: float = 1.0  # N/m of their unit of stiffness, and kg of that of mass

    def matrix(self, file: FileMatrix) -> csr_matrix:
        """M or K (3 n, 3 n) of the free nodes in the blade's frame, kg or N/m.

        Rows and columns of the root's nodes are left out.

        Raises
        ------
        MeshError
            When rows are not those of the free nodes.
        """
        node, direction = self._rows(file).T
        kept = np.flatnonzero(~np.isin(node, self.clamped))
        kept = kept[np.lexsort([direction[kept], node[kept]])]
        _require_same(np.column_stack([node, direction])[kept], _three_of(self.numbers))
        R = kron(eye_array(len(self.numbers)), self.turn, format="csr")
        return csr_matrix(self.unit * (R @ file.A[kept][:, kept] @ R.T))

    def interface(
        self, patches: int, across: int
    ) -> tuple[csr_matrix, NDArray[np.float64], NDArray[np.float64]]:
        """S (3 across patches, 3 n), camber line and sides, as ``on_patches``.

        Middle nodes of diagonals move as the quadrilateral with eight nodes that they lie in.
        """
        free = np.arange(3 * len(self.points))
        S, camber, sides = on_patches(self.points, self.tip, free, patches, across)
        return csr_matrix(S @ kron(self.weights, eye_array(3))), camber, sides

    def _rows(self, file: FileMatrix) -> NDArray[np.int64]:
        """Node and direction of each row; those that the file names, else by number."""
        if file.rows is not None:
            return file.rows
        n, columns = file.A.shape
        root = self.clamped if n > 3 * len(self.numbers) else self.clamped[:0]
        rows = _three_of(np.sort(np.append(self.numbers, root)))
        require(
            (
                n == columns == len(rows),
                f"{n} rows and {columns} columns, needs {len(rows)} each: rows that the file does "
                "not name must be x, y, z of each node by its number (the row of `nodes`); those "
                "of the root may be left out",
            )
        )
        return rows


def deck_of(source: MeshFile, folder: Path) -> Deck:
    """The nodes of the mesh that ``source`` names.

    Raises
    ------
    geometry.base.errors.MeshError
        When it cannot be read, or has no root or tip.
    """
    with about(folder / source.file):
        file = read_mesh_file(folder / source.file)
        mesh = file.without_unused()
        points = to_blade(mesh.points, source)
        root, tip = root_and_tip(source, mesh, points, exterior(mesh.cells))
    clamped = np.unique(mesh.weights[np.unique(root)].indices)
    free = np.setdiff1d(mesh.weights.indices, clamped)
    free = free[np.argsort(file.node_numbers[free])]
    return Deck(
        numbers=file.node_numbers[free],
        clamped=file.node_numbers[clamped],
        coordinates=to_blade(file.points[free], source),
        hub_radius=float(np.hypot(*points[np.unique(root), :2].T).mean()),
        points=points,
        tip=tip,
        weights=mesh.weights[:, free],
        turn=rotation(source.frame),
        unit=UNITS[source.unit][0] * source.metres,
    )


def _three_of(numbers: NDArray) -> NDArray[np.int64]:
    """Node and direction (3 n, 2) of rows x, y, z of each of the nodes (n,)."""
    return np.column_stack([np.repeat(numbers, 3), np.tile([1, 2, 3], len(numbers))])


def _require_same(rows: NDArray, needed: NDArray) -> None:
    """Refuse ``rows`` of nodes and directions that are not those that are needed."""
    have, need = ({*map(tuple, pairs.tolist())} for pairs in (rows, needed))
    if wrong := (have - need) or (need - have):
        node, direction = min(wrong)
        raise MeshError(
            f"node {node}, direction {direction}, "
            + (
                "has no row: only nodes of the root may be constrained, tied or condensed: "
                "release it"
                if wrong <= need
                else "has a row, and is none of the solid cells: leave out hybrid elements, ties, "
                "couplings and reference points, whose internal and Lagrange nodes these are"
            )
        )
