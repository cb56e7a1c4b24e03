"""Reader of the archive of an Ansys model (``.cdb``), as CDWRITE and Workbench write it.

mapdl-archive reads its blocks, but takes damaged ones in silence: the numbers of nodes and elements
that the blocks declare are checked here, and materials are read. Only blocks of elements in their
SOLID form are read.
"""

import re
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

import numpy as np
from mapdl_archive import Archive
from mapdl_archive.elements import ETYPE_MAP
from numpy.typing import NDArray

from geometry.file_mesh import FileMaterial, FileMesh, Solids, as_tetrahedra, require_all
from geometry.project import MeshError

FACE, BRICK, TETRAHEDRON = 3, 4, 5  # values of ETYPE_MAP, by the number of an element type
MESH200, OF_FACES = 200, (4, 5, 6, 7)  # the type that only meshes, and its KEYOPT(1) of faces
HEADER = 10  # numbers of an element before its nodes
MATERIAL, TYPE, NUMBER = 0, 1, 8  # places among them
# nodes of a brick that are those of another cell, by the number of different corners; VTK's order
COLLAPSED = {
    4: ("tetra", [0, 1, 2, 4, 8, 9, 11, 16, 17, 18]),  # I J K K M M M M
    5: ("pyramid", [0, 1, 2, 3, 4, 8, 9, 10, 11, 16, 17, 18, 19]),  # I J K L M M M M
    6: ("wedge", [0, 1, 2, 4, 5, 6, 8, 9, 11, 12, 13, 15, 16, 17, 18]),  # I J K K M N O O
    8: ("hexahedron", [*range(20)]),
}
TEN = "tetra", [*range(10)]
OTHER, MOST_NODES = "cells of another kind", 20
ABSENT = -1  # row of a middle node that is not there
LABELS = {
    "EX": "young_modulus",
    "PRXY": "poisson_ratio",
    "NUXY": "poisson_ratio",
    "DENS": "density",
}
EXPORT = "export it anew with `CDWRITE,DB`"


class _Element(NamedTuple):
    """An element: numbers of itself, its material and element type, kind of VTK, and nodes."""

    number: int
    material: int
    kind: str
    nodes: NDArray


def read_archive(path: Path) -> FileMesh:
    """Read an archive; names of its components are in capitals.

    Raises
    ------
    MeshError
        When its blocks are missing, damaged or more than one of nodes, a cell lacks a middle node,
        or it has solid elements that are not read.
    """
    lines = path.read_text(encoding="latin-1").splitlines()
    nodes, elements = _declared(lines)
    archive = Archive(path, parse_vtk=False)
    require_all("nodes", nodes, len(archive.nnum), EXPORT)
    require_all("elements", elements, len(archive.elem), EXPORT)
    row = np.full(int(archive.nnum.max()) + 1, ABSENT)
    row[archive.nnum] = np.arange(len(archive.nnum))
    row[0] = ABSENT
    solids, faces = _sorted(archive, row)
    return as_tetrahedra(
        np.asarray(archive.nodes, dtype=float),
        archive.nnum,
        _solids(solids),
        node_groups={
            name.upper(): _rows(numbers, row) for name, numbers in archive.node_components.items()
        },
        faces={
            name.upper(): [faces[i] for i in numbers if i in faces]
            for name, numbers in archive.element_components.items()
        },
        materials=_materials(lines, {element.material for element in solids}),
    )


def _declared(lines: list[str]) -> tuple[int | None, int | None]:
    """Numbers of nodes and of elements that the blocks declare; None where they do not."""
    heads = [line.upper().replace(" ", "").split(",") for line in lines if line[:1] in "NnEe"]
    node_blocks = [head for head in heads if head[0] == "NBLOCK"]
    element_blocks = [head for head in heads if head[0] == "EBLOCK" and "SOLID" in head]
    if not node_blocks or not element_blocks:
        missing = "EBLOCK of SOLID" if node_blocks else "NBLOCK"
        raise MeshError(f"holds no {missing}, its nodes and elements in blocks: {EXPORT}")
    if len(node_blocks) > 1:
        raise MeshError(f"holds {len(node_blocks)} NBLOCK, allowed one: {EXPORT}")
    _require_numbers(lines)
    counts = [_count(head) for head in element_blocks]
    return _count(node_blocks[0]), None if None in counts else sum(counts)


def _count(head: list[str]) -> int | None:
    """Number of entries of a block, the last of its head; None where it is left out or 0."""
    return int(head[4]) or None if len(head) > 4 and head[4].isdigit() else None


def _require_numbers(lines: list[str]) -> None:
    """Refuse other signs than those of numbers in the block of nodes."""
    first = next(i for i, line in enumerate(lines) if line.upper().startswith("NBLOCK")) + 2
    for number, line in enumerate(lines[first:], first + 1):
        if line[:1] not in " 0123456789":  # -1, or the next command
            return
        if strange := re.search(r"[^\d\s.eEdD+-]", line):
            raise MeshError(f"{strange[0]!r} among the coordinates: {EXPORT}", line=number)


def _sorted(archive: Archive, row: NDArray) -> tuple[list[_Element], dict[int, list[int]]]:
    """Solid elements, and corners of faces by their number; others are left out."""
    types = dict(archive.ekey.tolist())
    meshing = {
        key
        for key, number in types.items()
        for option, value in archive.key_option.get(key, ())
        if number == MESH200 and option == 1 and value in OF_FACES
    }
    solids, faces = [], {}
    for values in archive.elem:
        kind, nodes = types.get(int(values[TYPE])), _rows(values[HEADER:], row, absent=0)
        if kind is None:
            raise MeshError(
                f"element {values[NUMBER]} has type {values[TYPE]}, which no ET defines: {EXPORT}"
            )
        category = ETYPE_MAP[kind]
        if category in (BRICK, TETRAHEDRON):
            solids.append(_solid(values, nodes, category))
        elif category == FACE or values[TYPE] in meshing:
            # a triangle has three or six nodes, or those of a quadrilateral with I J K K
            corners = 4 if len(nodes) in (4, 8) and nodes[2] != nodes[3] else 3
            faces[int(values[NUMBER])] = nodes[:corners].tolist()
    return solids, faces


def _rows(numbers: NDArray, row: NDArray, absent: int | None = None) -> NDArray:
    """Rows of nodes; -1 for ``absent``, which stands for a middle node that is not there."""
    rows = row[np.clip(numbers, 0, len(row) - 1)]
    exists = (rows >= 0) & (numbers > 0) & (numbers < len(row))
    if np.any(lost := ~exists & (numbers != absent)):
        raise MeshError(
            f"an element or component has node {numbers[lost][0]}, which is not there: {EXPORT}"
        )
    return rows


def _solid(values: NDArray, nodes: NDArray, category: int) -> _Element:
    """A solid element; without nodes where its corners coincide in a way that is not known."""
    brick = category == BRICK
    corners = len(np.unique(nodes[:8])) if brick else 4
    kind, places = COLLAPSED.get(corners, (OTHER, [])) if brick else TEN
    if len(nodes) == (8 if brick else 4):  # of first order
        places = places[:corners]
    used = np.append(nodes, np.full(MOST_NODES, ABSENT))[places]
    if len(np.unique(used[:corners])) < corners:
        kind, used = OTHER, used[:0]
    return _Element(int(values[NUMBER]), int(values[MATERIAL]), kind, used)


def _solids(elements: list[_Element]) -> list[Solids]:
    """Elements by kind."""
    if lacking := [element for element in elements if ABSENT in element.nodes]:
        raise MeshError(
            f"{len(lacking)} of {len(elements)} cells lack middle nodes, among them element "
            f"{lacking[0].number}: keep the middle nodes of all"
        )
    by_kind: dict[tuple[str, int], list[_Element]] = {}
    for element in elements:
        by_kind.setdefault((element.kind, len(element.nodes)), []).append(element)
    return [
        Solids(
            kind,
            np.array([element.nodes for element in same]),
            np.array([element.number for element in same]),
        )
        for (kind, _), same in sorted(by_kind.items())
    ]


def _materials(lines: list[str], used: set[int]) -> tuple[FileMaterial, ...]:
    """Elastic materials of the solid elements, at the first of their temperatures."""
    values: dict[int, dict[str, float]] = {number: {} for number in sorted(used)}
    for label, number, value in _properties(lines):
        if number in used and label in LABELS:
            values[number].setdefault(LABELS[label], value)
    return tuple(FileMaterial(str(number), **constants) for number, constants in values.items())


def _properties(lines: list[str]) -> Iterator[tuple[str, int, float]]:
    """Label, material and first value of each MP or MPDATA."""
    for line in lines:
        command, *fields = [field.strip() for field in line.partition("!")[0].upper().split(",")]
        if command == "MPDATA" and fields and fields[0].startswith("R"):
            fields = fields[2:]  # without revision and number of values
        if command not in ("MP", "MPDATA") or len(fields) < 3:
            continue
        first = 3 if command == "MPDATA" else 2  # behind the place of the first value
        with suppress(ValueError, IndexError):
            yield fields[0], int(fields[1]), float(fields[first])
