"""A mesh read from a file of another program: points, tetrahedra, named groups, and its physics.

That is what the file says of the blade besides its mesh: materials, masses, and what is not read.
Materials are shown, and compared with that of the blade, which is taken.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from geometry.base import require
from geometry.blade import Material
from geometry.frame import box
from geometry.split import NODES, Block, flat_corners_first, split, triangles_of

UNITS = {  # of stress (Pa) and of density (kg/m3) by that of length, as programs pair them
    "m": (1.0, 1.0, "Pa and kg/m3"),
    "cm": (1e4, 1e8, "N/cm2 and N s2/cm4"),
    "mm": (1e6, 1e12, "MPa and t/mm3"),
    "in": (6894.757, 1.06869e7, "psi and lbf s2/in4"),
}
APART = 0.01  # relative difference of which is warned


def listed(counts: Counter[str]) -> str:
    """How many there are of each kind, those of which there are any."""
    return ", ".join(f"{count} {kind}" for kind, count in sorted(counts.items()) if count)


def agree(one: float, other: float) -> bool:
    """Whether two values of a material are the same within ``APART``."""
    return abs(one - other) <= APART * abs(other)


@dataclass(frozen=True)
class FileMaterial:
    """An elastic material in the units of its file; None for values that the file does not give."""

    name: str
    young_modulus: float | None = None
    poisson_ratio: float | None = None
    density: float | None = None
    cells: int = 0  # solid cells that are of it; 0 where the file does not say
    other: str = ""  # the card by which it is not isotropic, or has an orientation

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
            if not agree(value, getattr(material, key))
        ]

    def same_as(self, other: "FileMaterial") -> bool:
        """Whether the file gives all values of both, and they are the same."""
        one, two = self.taken_in("m"), other.taken_in("m")
        return len(one) == len(two) == 3 and all(agree(one[key], two[key]) for key in one)


@dataclass(frozen=True)
class Physics:
    """What a file says besides its mesh."""

    materials: tuple[FileMaterial, ...] = ()  # of its solid cells
    masses: Counter[str] = field(default_factory=Counter)  # point masses by their card
    left_out: Counter[str] = field(default_factory=Counter)  # cards and elements that are not read

    @property
    def described(self) -> str:
        """What is not taken of the file, with its number; empty where that is nothing."""
        return listed(self.masses + self.left_out)

    def require_plain(self) -> None:
        """Refuse physics that the model of a meshed blade does not have.

        Raises
        ------
        MeshError
            When the cells have materials of different values, one that is not isotropic or has an
            orientation, or there are point masses.
        """
        faults = [f"material {m.name} with {m.other}" for m in self.materials if m.other]
        if any(not material.same_as(self.materials[0]) for material in self.materials[1:]):
            named = ", ".join(
                f"{m.name} of {m.cells} cells" if m.cells else m.name for m in self.materials
            )
            faults.insert(0, f"{len(self.materials)} materials ({named})")
        if self.masses:
            faults.append(f"point masses ({listed(self.masses)})")
        require(
            (
                not faults,
                f"has {' and '.join(faults)}; a blade of `mesh_file` is of one isotropic material "
                "without masses: give the matrices of its program by `full_matrices` "
                "(fem/matrices.md), which have all of that, or a file without it",
            )
        )


@dataclass
class FileMesh:
    """A mesh in the unit and axes of its file, as tetrahedra."""

    points: NDArray[np.float64]  # (n, 3)
    cells: NDArray[np.int64]  # (m, 10), nodes in VTK's order
    numbers: NDArray[np.int64]  # (m,), of the cells of the file that they are of
    node_numbers: NDArray[np.int64]  # (given,), of the nodes of the file
    weights: csr_matrix  # (n, given), of the nodes of the file in the place of each point
    parents: NDArray[np.int64]  # (k, 4), nodes, of the last k points, as of ``Split``
    blocks: tuple[Block, ...] = ()  # cells of the file, on the first of the points
    node_groups: dict[str, NDArray] = field(default_factory=dict)  # nodes (k,)
    face_groups: dict[str, NDArray] = field(default_factory=dict)  # corner nodes (k, 3), k may be 0
    physics: Physics = field(default_factory=Physics)
    first_order: bool = False  # its cells have no middle nodes in the file
    made: str = ""  # source of its tetrahedra, where the file has other cells

    @property
    def groups(self) -> set[str]:
        """Names of the groups that hold faces or nodes."""
        return {n for n, faces in self.face_groups.items() if len(faces)} | self.node_groups.keys()

    @property
    def described(self) -> str:
        """Its cells, box and groups, in the unit and the axes of the file."""
        used = self.without_unused()
        groups = [
            *(f"{name} ({len(group)} nodes)" for name, group in used.node_groups.items()),
            *(
                f"{name} ({len(group)} faces)"
                for name, group in used.face_groups.items()
                if len(group)
            ),
        ]
        return (
            f"{self.made or f'{len(used.cells)} tetrahedra on {len(used.points)} nodes'}; "
            f"{box(used.points)}; groups: {', '.join(groups) or 'none'}"
        )

    def without_unused(self) -> "FileMesh":
        """The mesh without the nodes that no tetrahedron uses."""
        used = np.unique(self.cells)
        new = np.full(len(self.points), -1)
        new[used] = np.arange(len(used))
        return replace(
            self,
            points=self.points[used],
            weights=self.weights[used],
            parents=new[self.parents],
            blocks=(),
            cells=new[self.cells],
            node_groups={n: new[nodes][new[nodes] >= 0] for n, nodes in self.node_groups.items()},
            face_groups={n: new[faces] for n, faces in self.face_groups.items()},
        )


def as_tetrahedra(
    points: NDArray[np.float64],
    node_numbers: NDArray[np.int64],
    solids: Sequence[Block],
    node_groups: Mapping[str, NDArray],
    faces: Mapping[str, Sequence[Sequence[int]]],
    physics: Physics,
) -> FileMesh:
    """The mesh of all solid cells, as tetrahedra (``geometry.split``).

    Nodes at flat corners of quadrilaterals are put before all others: the split cuts from them.
    ``points`` (given, 3) and ``node_numbers`` (given,) are those of the file; ``faces``: corners of
    triangles and quadrilaterals by group.

    Raises
    ------
    MeshError
        When there are none, some of other kinds, or of first and of second order; as ``split``.
    """
    blocks = _blocks(solids)
    order = flat_corners_first(points, blocks)
    place = np.argsort(order)
    blocks = [block._replace(nodes=place[block.nodes]) for block in blocks]
    tetrahedra = split(points[order], blocks)
    made = ""
    if any(block.corners.shape[1] != 4 for block in blocks):
        given = len(np.unique(np.concatenate([block.nodes.ravel() for block in blocks])))
        made = (
            f"{_held(solids)} on {given} nodes, split into {len(tetrahedra.cells)} ten-node "
            f"tetrahedra on {len(np.unique(tetrahedra.cells))} nodes"
        )
    return FileMesh(
        points=tetrahedra.points,
        cells=tetrahedra.cells,
        numbers=tetrahedra.numbers,
        node_numbers=node_numbers[order],
        weights=tetrahedra.weights,
        parents=tetrahedra.parents,
        blocks=tuple(blocks),
        node_groups={
            name: tetrahedra.with_new(place[nodes]) for name, nodes in node_groups.items()
        },
        face_groups={
            name: triangles_of([place[list(face)] for face in corners])
            for name, corners in faces.items()
        },
        physics=physics,
        first_order=not blocks[0].second_order,
        made=made,
    )


def _blocks(solids: Sequence[Block]) -> list[Block]:
    blocks = [cells for cells in solids if len(cells.nodes)]
    other = [cells for cells in solids if cells.nodes.shape[1] not in NODES]
    require(
        (
            blocks,
            "holds no tetrahedra, bricks, wedges or pyramids, at most faces and lines: export the "
            "cells of the volume too (of gmsh those of a physical volume are saved)",
        ),
        (
            not other,
            f"holds {_held(other)}: read are tetrahedra, bricks, wedges and pyramids of first or "
            "second order (of VTK its quadratic cells, not those of Lagrange or Bezier)",
        ),
    )
    require(
        (
            len({block.second_order for block in blocks}) == 1,
            f"mixes cells of first and second order, {_held(solids)}: export one order",
        )
    )
    return blocks


def _held(solids: Sequence[Block]) -> str:
    """How many cells of each kind."""
    counts = (Counter({cells.named: len(cells.nodes)}) for cells in solids)
    return listed(sum(counts, Counter()))


def require_all(what: str, declared: int | None, read: int, remedy: str) -> None:
    """Refuse a file whose readers leave out declared parts; None: it declares no number.

    Raises
    ------
    MeshError
        When they do.
    """
    require(
        (
            declared in (None, read),
            f"declares {declared} {what}, of which {read} are read: {remedy}",
        )
    )
