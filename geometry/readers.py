"""Readers of mesh files of other programs."""

import re
from collections import Counter
from collections.abc import Callable
from itertools import compress
from pathlib import Path

import meshio
import numpy as np
from meshio.gmsh.common import _gmsh_to_meshio_order
from numpy.typing import NDArray

from geometry.abaqus import read_deck
from geometry.ansys import EXPORT, read_archive
from geometry.base import MeshError, UserError, require, require_file, shown
from geometry.file_mesh import FileMesh, Physics, as_tetrahedra, require_all
from geometry.nastran import read_bulk
from geometry.split import NODES, Block, upright

SECTION = re.compile(rb"^\$(?:End)?(?:Nodes|Elements)\b", re.MULTILINE)
SECTIONS = [[b"$Elements", b"$EndElements"], [b"$Nodes", b"$EndNodes"]]
NAMES = re.compile(rb'^[ \t]*(\d) +(\d+) +"([^"]*)"', re.MULTILINE)  # dimension, number, name
ASCII = re.compile(rb"^\$MeshFormat\s+\S+\s+0\s", re.MULTILINE)
ANEW = {
    ".msh": "save it as MSH 4.1 or 2.2, its groups alone (Mesh.SaveAll 0)",
    ".vtu": "write it as one piece of VTK's format 1.0, without polyhedra",
    ".cdb": EXPORT,
}
SERENDIPITY = {"wedge18": "wedge15", "pyramid14": "pyramid13"}  # in Gmsh's order with meshio 5.3
meshio._mesh.topological_dimension |= {"wedge15": 3, "pyramid13": 3}  # unknown to meshio 5.3
meshio.gmsh.main._readers["4"] = meshio.gmsh._gmsh40  # gmsh writes 4 for version 4.0


def _read_msh(path: Path) -> FileMesh:
    """A mesh of Gmsh, or a deck of cgx; of an ASCII section meshio reads the declared number."""
    data = path.read_bytes()
    if data.lstrip().startswith(b"*"):
        return read_deck(path)
    marks = [*SECTION.finditer(data)]
    named = [mark[0] for mark in marks]
    require(
        (
            sorted([named[:2], named[2:]]) == SECTIONS,
            f"needs one $Nodes and one $Elements, both with their end: {ANEW['.msh']}",
        ),
        (
            b"$PartitionedEntities" not in data,
            "is partitioned: save it whole (in gmsh: Mesh, Unpartition)",
        ),
    )
    mesh = meshio.gmsh.read(path)
    for block in mesh.cells:
        if block.type in SERENDIPITY:
            block.data = _gmsh_to_meshio_order(SERENDIPITY[block.type], block.data)
    first, last = (mark for mark in marks if mark[0].endswith(b"Elements"))
    head, *lines = data[first.end() : last.start()].strip().splitlines()
    if ASCII.search(data):
        _require_all(mesh, len(lines) if len(head.split()) == 1 else int(head.split()[1]))
    _name(mesh, data.partition(b"$EndPhysicalNames")[0])
    return _from_meshio(mesh)


def _read_vtu(path: Path) -> FileMesh:
    """A mesh of VTK; meshio leaves out cells of other kinds, and of all pieces but the last."""
    mesh = meshio.vtu.read(path)
    _require_all(mesh, sum(map(int, re.findall(rb"NumberOfCells=.(\d+)", path.read_bytes()))))
    return _from_meshio(mesh)


def _require_all(mesh: meshio.Mesh, cells: int) -> None:
    require_all("cells", cells, sum(map(len, mesh.cells)), "write it anew, whole")


READERS: dict[str, Callable[[Path], FileMesh]] = {
    ".inp": read_deck,
    ".cdb": read_archive,
    ".bdf": read_bulk,
    ".nas": read_bulk,
    ".fem": read_bulk,
    ".msh": _read_msh,
    ".vtu": _read_vtu,
}
# corners of faces in groups
SHELLS = {"triangle": 3, "triangle6": 3, "quad": 4, "quad8": 4, "quad9": 4}
MOST_VALUES = 1000  # an array with more different values is a field, not groups


def read_mesh_file(path: str | Path) -> FileMesh:
    """Read ``.inp``, ``.cdb``, ``.bdf``, ``.nas``, ``.fem``, ``.msh`` or ``.vtu``.

    Shells, beams and points are only used for groups.

    Raises
    ------
    MeshError
        When the file does not exist, has an unknown format, cannot be read whole, or has solid
        cells that are not read.
    """
    path = Path(path)
    require_file(path, READERS)
    try:
        mesh = READERS[path.suffix.lower()](path)
    except UserError:
        raise
    except Exception as error:  # readers raise various exceptions for damaged files
        anew = ANEW.get(path.suffix, "export it anew")
        raise MeshError(f"cannot be read as {path.suffix} ({shown(error)}): {anew}") from None
    finite = mesh.points.shape[1:] == (3,) and np.isfinite(mesh.points).all()
    require((finite, "each of its nodes must have three finite coordinates"))
    return mesh


def _from_meshio(mesh: meshio.Mesh) -> FileMesh:
    require(
        *(
            (
                np.isin(block.data, np.arange(len(mesh.points))).all(),
                f"a {block.type} names a node that does not exist: is it cut short, or counted "
                "from another number?",
            )
            for block in mesh.cells
        )
    )
    blocks = [block for block in mesh.cells if block.dim == 3]
    groups = _cell_groups(mesh)
    ends = np.cumsum([*map(len, blocks)])
    return as_tetrahedra(
        mesh.points,
        np.arange(len(mesh.points)) + 1,
        [
            Block(_nodes(block, mesh.points), np.arange(end - len(block), end) + 1, block.type)
            for block, end in zip(blocks, ends, strict=True)
        ],
        node_groups={
            group: np.flatnonzero(mask)
            for name, data in mesh.point_data.items()
            for group, mask in _values(name, data).items()
        },
        faces={name: _faces(mesh, members) for name, members in groups.items()},
        physics=_physics(mesh, groups),
    )


def _physics(mesh: meshio.Mesh, groups: dict[str, list[NDArray]]) -> Physics:
    """Parts of the solid cells, which may be of other materials, and arrays that are no groups."""
    solid = [block.dim == 3 for block in mesh.cells]
    cells = sum(len(block) for block in mesh.cells if block.dim == 3)
    parts = {
        f"cells of the part {name}": sum(map(len, compress(members, solid)))
        for name, members in groups.items()
        if not name.startswith("gmsh:")
    }
    data = mesh.point_data | {key: np.concatenate(value) for key, value in mesh.cell_data.items()}
    arrays = {
        f"array {name}": 1
        for name, values in data.items()
        if not name.startswith("gmsh:") and not _values(name, values)
    }
    parts = {name: count for name, count in parts.items() if 0 < count < cells}
    return Physics(left_out=Counter(parts | arrays))


def _nodes(block: meshio.CellBlock, points: NDArray) -> NDArray:
    """Nodes of solid cells in our order; none of a kind that is not read."""
    kind = block.type.rstrip("0123456789")
    if NODES.get(block.data.shape[1], ("", False))[0] != kind:
        return block.data[:, :0]
    return upright(points, block.data)


def _faces(mesh: meshio.Mesh, members: list[NDArray]) -> list[list[int]]:
    """Corner nodes of the triangles and quadrilaterals among ``members``, indices in each block."""
    return [
        face
        for block, chosen in zip(mesh.cells, members, strict=True)
        if block.type in SHELLS
        for face in block.data[chosen, : SHELLS[block.type]].tolist()
    ]


def _cell_groups(mesh: meshio.Mesh) -> dict[str, list[NDArray]]:
    """Indices of the members in each block of cells, by group: sets, physical names, cell data."""
    groups = {
        name: [np.asarray(m, dtype=int) for m in members]
        for name, members in mesh.cell_sets.items()
        if not name.startswith("gmsh:")
    }
    for name, data in mesh.cell_data.items():
        lengths = np.cumsum([len(block) for block in data])[:-1]
        for group, mask in _values(name, np.concatenate(data)).items():
            groups[group] = [np.flatnonzero(part) for part in np.split(mask, lengths)]
    return groups


def _name(mesh: meshio.Mesh, data: bytes) -> None:
    """Add to ``mesh`` the physical groups of its file, whose ``data`` name them, as sets of cells.

    meshio keeps one of several dimensions with the same name, and of those with several groups one.
    """
    given = Counter(name.decode() for *_, name in NAMES.findall(data))
    mesh.cell_sets = {name: of for name, of in mesh.cell_sets.items() if given[name] == 1}
    physical = mesh.cell_data.get("gmsh:physical", [np.zeros(len(b), int) for b in mesh.cells])
    for dim, tag, name in NAMES.findall(data):
        members = [
            np.flatnonzero((tags == int(tag)) & (block.dim == int(dim)))
            for block, tags in zip(mesh.cells, physical, strict=True)
        ]
        others = mesh.cell_sets.get(name := name.decode(), [()] * len(members))
        mesh.cell_sets[name] = [
            np.union1d(np.asarray(of, int), own) for of, own in zip(others, members, strict=True)
        ]


def _values(name: str, data: NDArray) -> dict[str, NDArray]:
    """Groups of an array of whole numbers: ``name`` if all are 0 or 1, else ``name=value``."""
    data, values = np.asarray(data), np.unique(data)
    whole = data.dtype.kind in "iufb" and np.all(data == np.round(data))
    if data.ndim != 1 or not whole or len(values) > MOST_VALUES:
        return {}
    if set(values) == {0, 1}:
        return {name: data == 1}
    return {f"{name}={int(value)}": data == value for value in values}
