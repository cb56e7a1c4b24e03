"""A mesh read from a file of another program: points, tetrahedra and named groups."""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from geometry.errors import MeshError
from geometry.file_material import FileMaterial


@dataclass
class FileMesh:
    """A mesh in the unit and axes of its file."""

    points: NDArray[np.float64]  # (n, 3)
    cells: NDArray[np.int64]  # (m, 4) or (m, 10), nodes in VTK's order
    node_groups: dict[str, NDArray] = field(default_factory=dict)  # nodes (k,)
    face_groups: dict[str, NDArray] = field(default_factory=dict)  # corner nodes (k, 3), k may be 0
    materials: tuple[FileMaterial, ...] = ()  # of its cells, where the file names them

    @property
    def facet_nodes(self) -> int:
        """Number of nodes of a facet in the file: three, or six with the mid-edge nodes."""
        return 3 if self.cells.shape[1] == 4 else 6

    @property
    def groups(self) -> set[str]:
        """Names of the groups that hold faces or nodes."""
        return {n for n, faces in self.face_groups.items() if len(faces)} | self.node_groups.keys()

    def without_unused(self) -> "FileMesh":
        """The mesh without the nodes that no tetrahedron uses."""
        used = np.unique(self.cells)
        new = np.full(len(self.points), -1)
        new[used] = np.arange(len(used))
        return replace(
            self,
            points=self.points[used],
            cells=new[self.cells],
            node_groups={n: new[nodes][new[nodes] >= 0] for n, nodes in self.node_groups.items()},
            face_groups={n: new[faces] for n, faces in self.face_groups.items()},
        )


def tetrahedra_of(blocks: list[tuple[str, NDArray]]) -> NDArray[np.int64]:
    """Cells (m, 4) or (m, 10) of all ``blocks``, each with its kind and nodes.

    Raises
    ------
    MeshError
        When they are not tetrahedra of one kind.
    """
    counts = {kind: sum(len(data) for k, data in blocks if k == kind) for kind, _ in blocks}
    if other := set(counts) - {"tetra", "tetra10"}:
        held = ", ".join(f"{counts[kind]} {kind}" for kind in sorted(other))
        raise MeshError(f"holds {held}: only tetrahedra with four or ten nodes are read")
    if len(counts) == 2:
        raise MeshError(
            f"mixes {counts['tetra']} four-node and {counts['tetra10']} ten-node tetrahedra: "
            f"export one kind"
        )
    if not counts:
        raise MeshError("holds no tetrahedra")
    return np.vstack([data for _, data in blocks])
