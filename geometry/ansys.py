"""Reader of the archive of an Ansys model (``.cdb``), as CDWRITE and Workbench write it.

mapdl-archive reads its elements and components, but takes damaged blocks in silence: the numbers
that the blocks declare are checked here, and nodes and materials are read; of nodes in blocks of
three fields it would lose the third coordinate. Only blocks of elements in their SOLID form are
read.
"""

import re
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

import numpy as np
from mapdl_archive import Archive
from mapdl_archive.elements import ETYPE_MAP
from numpy.typing import NDArray

from geometry.base import MeshError, number, require
from geometry.file_mesh import FileMaterial, FileMesh, Physics, agree, as_tetrahedra, require_all
from geometry.split import Block

FACE, BRICK, TETRAHEDRON = 3, 4, 5  # values of ETYPE_MAP, by the number of an element type
# the type that only meshes, and what it is by its KEYOPT(1)
MESH200 = 200
MESHING = dict.fromkeys((4, 5, 6, 7), FACE) | {8: TETRAHEDRON, 9: TETRAHEDRON, 10: BRICK, 11: BRICK}
MASS21 = 21
HEADER = 10  # numbers of an element before its nodes
MATERIAL, TYPE, SYSTEM, NUMBER = 0, 1, 4, 8  # places among them
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
LARGEST = 10**8  # number of a node
FORMAT = re.compile(r"\((\d*)i(\d+),(\d+)e(\d+)\.\d+(?:e\d+)?\)")  # of a block of nodes
# TB of elastic laws; with others, as of plasticity, a material may be isotropic
NOT_ISOTROPIC = re.compile(r"ANEL|HYPER|MOON|OGDEN|ELAS.*(ORTH|AEL)")
COMMAND = re.compile(r"[A-Z]\w*")
# commands that are read, and those that only frame them
TAKEN = {
    *("NBLOCK", "EBLOCK", "CMBLOCK", "ET", "KEYOPT", "KEYOP", "ETBLOCK", "N", "FINISH", "CMEDIT"),
    *("MP", "MPDATA", "MPTEMP", "NUMOFF"),
}
EXPORT = "export it anew with `CDWRITE,DB`"


class _Element(NamedTuple):
    """An element: numbers of itself, its material and element type, kind of VTK, and nodes."""

    number: int
    material: int
    turned: bool  # in a coordinate system of its own
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
    numbers, points = _nodes(lines)
    archive = Archive(path, parse_vtk=False)
    require_all("nodes", nodes, len(numbers), EXPORT)
    require_all("elements", elements, len(archive.elem), EXPORT)
    most = int(numbers.max())
    require(
        (most <= LARGEST, f"has node {most}, allowed up to {LARGEST}: NUMCMP, NODE, and export")
    )
    row = np.full(most + 1, ABSENT)
    row[numbers] = np.arange(len(numbers))
    row[0] = ABSENT
    solids, faces, others = _sorted(archive, row)
    return as_tetrahedra(
        points,
        numbers,
        _solids(solids),
        node_groups={
            name.upper(): _rows(numbers, row) for name, numbers in archive.node_components.items()
        },
        faces={
            name.upper(): [faces[i] for i in numbers if i in faces]
            for name, numbers in archive.element_components.items()
        },
        physics=_physics(lines, solids, others),
    )


def _declared(lines: list[str]) -> tuple[int | None, int | None]:
    """Numbers of nodes and of elements that the blocks declare; None where they do not."""
    heads = [line.upper().replace(" ", "").split(",") for line in lines if line[:1] in "NnEe"]
    node_blocks = [head for head in heads if head[0] == "NBLOCK"]
    element_blocks = [head for head in heads if head[0] == "EBLOCK" and "SOLID" in head]
    missing = "EBLOCK of SOLID" if node_blocks else "NBLOCK"
    require(
        (
            node_blocks and element_blocks,
            f"holds no {missing}, its nodes and elements in blocks: {EXPORT}",
        ),
        (len(node_blocks) < 2, f"holds {len(node_blocks)} NBLOCK, allowed one: {EXPORT}"),
    )
    counts = [_count(head) for head in element_blocks]
    return _count(node_blocks[0]), None if None in counts else sum(counts)


def _count(head: list[str]) -> int | None:
    """Number of entries of a block, the last of its head; None where it is left out or 0."""
    return int(head[4]) or None if len(head) > 4 and head[4].isdigit() else None


def _nodes(lines: list[str]) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Numbers (n,) and coordinates (n, 3) of the block of nodes, by the format in its second line.

    A line may lack coordinates at its end, which are 0.
    """
    head = next(i for i, line in enumerate(lines) if line.upper().startswith("NBLOCK"))
    fields = FORMAT.fullmatch("".join("".join(lines[head + 1 : head + 2]).lower().split()))
    require(
        (
            fields and int(fields[3]) >= 3,
            f"its nodes have no format that is read, as (3i9,6e21.13e3): {EXPORT}",
        ),
        line=head + 2,
    )
    whole, wide, count, width = (int(field or 1) for field in fields.groups())
    begin, numbers, points = whole * wide, [], []
    for place, line in enumerate(lines[head + 2 :], head + 3):
        if line[:1] not in " 0123456789" or line[:wide].strip() == "-1":  # or the next command
            break
        starts = range(begin, begin + 3 * width, width)
        try:
            if len(line.rstrip()) > begin + count * width:
                raise ValueError("it is longer than the format of its block")
            numbers.append(int(line[:wide]))
            points.append(
                [number(text) if (text := line[i : i + width]).strip() else 0.0 for i in starts]
            )
        except ValueError as error:
            raise MeshError(f"a node cannot be read ({error}): {EXPORT}", line=place) from None
    require((numbers, f"its block of nodes is empty: {EXPORT}"), line=head + 1)
    return np.array(numbers), np.array(points)


def _sorted(
    archive: Archive, row: NDArray
) -> tuple[list[_Element], dict[int, list[int]], Counter[str]]:
    """Solid elements, corners of faces by their number, and how many others there are by kind."""
    types = dict(archive.ekey.tolist())
    categories = {key: ETYPE_MAP[kind] for key, kind in types.items()} | {
        key: MESHING[value]
        for key, kind in types.items()
        for option, value in archive.key_option.get(key, ())
        if kind == MESH200 and option == 1 and value in MESHING
    }
    solids, faces, others = [], {}, Counter()
    for values in archive.elem:
        key, nodes = int(values[TYPE]), _rows(values[HEADER:], row, absent=0)
        require(
            (
                key in types,
                f"element {values[NUMBER]} has type {key}, which no ET defines: {EXPORT}",
            )
        )
        category = categories[key]
        if category in (BRICK, TETRAHEDRON):
            solids.append(_solid(values, nodes, category))
        elif category == FACE:
            # a triangle has three or six nodes, or those of a quadrilateral with I J K K
            corners = 4 if len(nodes) in (4, 8) and nodes[2] != nodes[3] else 3
            faces[int(values[NUMBER])] = nodes[:corners].tolist()
        others["MASS21" if types[key] == MASS21 else f"elements of type {types[key]}"] += (
            category not in (BRICK, TETRAHEDRON)
        )
    return solids, faces, others


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
    return _Element(
        number=int(values[NUMBER]),
        material=int(values[MATERIAL]),
        turned=bool(values[SYSTEM]),
        kind=kind,
        nodes=used,
    )


def _solids(elements: list[_Element]) -> list[Block]:
    """Elements by kind."""
    if lacking := [element for element in elements if ABSENT in element.nodes]:
        raise MeshError(
            f"{len(lacking)} of {len(elements)} cells lack middle nodes, among them element "
            f"{lacking[0].number}: keep the middle nodes of all"
        )
    kinds = sorted({(element.kind, len(element.nodes)) for element in elements})
    by_kind = [[e for e in elements if (e.kind, len(e.nodes)) == kind] for kind in kinds]
    return [
        Block(
            np.array([element.nodes for element in same]),
            np.array([element.number for element in same]),
            same[0].kind,
        )
        for same in by_kind
    ]


def _physics(lines: list[str], solids: list[_Element], others: Counter[str]) -> Physics:
    """Materials of the solid elements, at the first of their temperatures, and what is not read."""
    commands = [line.partition("!")[0].upper().split(",") for line in lines if line[:1].isalpha()]
    named = Counter(
        command for command, *_ in commands if COMMAND.fullmatch(command) and command not in TAKEN
    )
    values: dict[int, dict[str, float]] = {}
    for label, material, value in _properties(lines):
        values.setdefault(material, {}).setdefault(label, value)
    laws = {
        fields[1].strip(): f"TB,{fields[0].strip()}"
        for command, *fields in commands
        if command == "TB" and len(fields) > 1 and NOT_ISOTROPIC.search(",".join(fields))
    }
    require((not named["EN"], f"has elements outside its blocks, {named['EN']} EN: {EXPORT}"))
    of_cells = Counter(element.material for element in solids)
    turned = {element.material for element in solids if element.turned}
    materials = []
    for key, cells in sorted(of_cells.items()):
        constants = values.get(key, {})
        faults = [laws.get(str(key), ""), _not_isotropic(constants), "ESYS" * (key in turned)]
        known = {LABELS[label]: x for label, x in constants.items() if label in LABELS}
        materials.append(
            FileMaterial(str(key), **known, cells=cells, other=" and ".join(filter(None, faults)))
        )
    masses = Counter({"MASS21": others.pop("MASS21", 0)})
    return Physics(tuple(materials), +masses, +others + named)


def _not_isotropic(values: dict[str, float]) -> str:
    """Labels of a material whose values are not those of an isotropic one."""
    E, nu = values.get("EX", 0.0), values.get("PRXY", values.get("NUXY"))
    isotropic = {"E": E} | ({} if nu is None else {"N": nu, "P": nu, "G": E / (2 + 2 * nu)})
    return " ".join(
        label
        for label, value in values.items()
        if re.fullmatch(r"(E|G|NU|PR)[XYZ]+", label)
        and not agree(value, isotropic.get(label[0], value))
    )


def _properties(lines: list[str]) -> Iterator[tuple[str, int, float]]:
    """Label, material and first value of each MP or MPDATA."""
    for line in lines:
        command, *fields = [field.strip() for field in line.partition("!")[0].upper().split(",")]
        if command == "MPDATA" and fields and fields[0].startswith("R"):
            fields = fields[2:]  # without revision and number of values
        first = 3 if command == "MPDATA" else 2  # behind the place of the first value
        if command in ("MP", "MPDATA") and len(fields) > 2:
            with suppress(ValueError, IndexError):
                yield fields[0], int(fields[1]), number(fields[first])
