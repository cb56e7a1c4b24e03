"""A mesh read from a file of another program: points, tetrahedra, named groups and materials.

Materials are shown, and compared with that of the blade, which is taken.
"""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from geometry.blade import Material
from geometry.project import MeshError

UNITS = {  # of stress (Pa) and of density (kg/m3) by that of length, as programs pair them
    "m": (1.0, 1.0, "Pa and kg/m3"),
    "cm": (1e4, 1e8, "N/cm2 and N s2/cm4"),
    "mm": (1e6, 1e12, "MPa and t/mm3"),
    "in": (6894.757, 1.06869e7, "psi and lbf s2/in4"),
}
APART = 0.01  # relative difference of which is warned


@dataclass(frozen=True)
class FileMaterial:
    """An elastic material in the units of its file; None for what the file does not say."""

    name: str
    young_modulus: float | None = None
    poisson_ratio: float | None = None
    density: float | None = None

    def taken_in(self, unit: str) -> dict[str, float]:
        """Values by the key of ``Material``, if its units go with the file's ``unit`` of length."""
        stress, density, _ = UNITS[unit]
        values = {
            "young_modulus_GPa": self.young_modulus and self.young_modulus * stress * 1e-9,
            "poisson_ratio": self.poisson_ratio,
            "density_kg_m3": self.density and self.density * density,
        }
        return {key: value for key, value in values.items() if value is not None}

    def described(self, unit: str) -> str:
        """The values that the file has, and the units in which they are read."""
        values = ", ".join(f"{key} {value:.5g}" for key, value in self.taken_in(unit).items())
        return (
            f"material {self.name} of the file, read in {UNITS[unit][2]}: {values or 'no values'}"
        )

    def differs(self, material: Material, unit: str) -> list[str]:
        """Keys of ``material``, with its value, where the file says something else."""
        return [
            f"{key} {getattr(material, key):.5g}"
            for key, value in self.taken_in(unit).items()
            if not abs(value - getattr(material, key)) <= APART * abs(getattr(material, key))
        ]


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


def require_all(what: str, declared: int | None, read: int, remedy: str) -> None:
    """Refuse a file of which readers leave out a part of what it declares; None: it does not say.

    Raises
    ------
    MeshError
        When they do.
    """
    if declared not in (None, read):
        raise MeshError(f"declares {declared} {what}, of which {read} are read: {remedy}")


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
