"""Readers of mesh files of other programs."""

import re
from collections import Counter
from collections.abc import Callable
from io import StringIO
from pathlib import Path

import meshio
import numpy as np
from meshio.nastran._nastran import read_buffer
from numpy.typing import NDArray

from geometry.abaqus import read_deck
from geometry.ansys import read_archive
from geometry.errors import MeshError
from geometry.file_mesh import FileMesh, tetrahedra_of
from geometry.text_file import read_text

GRID = re.compile(r"^GRID\*?(?: *,| +) *(\d+)", re.MULTILINE)
FORTRAN = re.compile(r"(\d|\.)[dD]([+-]?\d)")  # an exponent


def _read_nastran(path: Path) -> meshio.Mesh:
    """A deck of Nastran; meshio reads no exponents of Fortran, nor refuses equal nodes."""
    text = read_text(path, most=None, errors="replace")
    for node, count in Counter(GRID.findall(text)).most_common(1):
        if count > 1:
            raise MeshError(f"node {node} is defined {count} times: number the nodes anew")
    return read_buffer(StringIO(FORTRAN.sub(r"\1E\2", text)))


READERS: dict[str, Callable[[Path], FileMesh | meshio.Mesh]] = {
    ".inp": read_deck,
    ".cdb": read_archive,
    ".bdf": _read_nastran,
    ".nas": _read_nastran,
    ".fem": _read_nastran,
    ".msh": meshio.gmsh.read,
    ".vtu": meshio.vtu.read,
}
TRIANGLES = ("triangle", "triangle6")
MOST_VALUES = 1000  # an array with more different values is a field, not groups


def read_mesh_file(path: str | Path) -> FileMesh:
    """Read ``.inp``, ``.cdb``, ``.bdf``, ``.nas``, ``.fem``, ``.msh`` or ``.vtu``.

    Shells, beams and points are only used for groups.

    Raises
    ------
    MeshError
        When the file does not exist, has an unknown format, cannot be read, or has solid cells
        other than tetrahedra.
    """
    path = Path(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise MeshError(f"suffix {path.suffix or 'missing'}: known are {', '.join(READERS)}")
    if not path.is_file():
        raise MeshError("there is no such file")
    try:
        mesh = reader(path)
        mesh = mesh if isinstance(mesh, FileMesh) else _of_meshio(mesh)
    except MeshError:
        raise
    except Exception as error:  # readers raise various exceptions for damaged files
        what = " ".join(f"{type(error).__name__} {error}".split())
        raise MeshError(f"cannot be read as {path.suffix} ({what})") from None
    if mesh.points.ndim != 2 or mesh.points.shape[1] != 3 or not np.isfinite(mesh.points).all():
        raise MeshError("each of its nodes must have three finite coordinates")
    return mesh


def _of_meshio(mesh: meshio.Mesh) -> FileMesh:
    _check_coordinate_systems(mesh)
    node_groups, face_groups = {}, {}
    for name, data in mesh.point_data.items():
        node_groups |= {n: np.flatnonzero(m) for n, m in _values(name, data).items()}
    for name, members in _cell_groups(mesh).items():
        faces = [
            block.data[chosen, :3]
            for block, chosen in zip(mesh.cells, members, strict=True)
            if block.type in TRIANGLES
        ]
        face_groups[name] = np.vstack([np.empty((0, 3), dtype=int), *faces])
    cells = tetrahedra_of([(b.type, b.data) for b in mesh.cells if b.dim == 3])
    return FileMesh(mesh.points, cells, node_groups, face_groups)


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
    for name, (tag, _) in mesh.field_data.items():
        physical = groups.get(f"gmsh:physical={tag}") or groups.get("gmsh:physical")
        if physical:
            groups.setdefault(name, physical)
    return groups


def _values(name: str, data: NDArray) -> dict[str, NDArray]:
    """Groups of an array of whole numbers: ``name`` if all are 0 or 1, else ``name=value``."""
    data = np.asarray(data)
    if data.ndim != 1 or data.dtype.kind not in "iufb" or np.any(data != np.round(data)):
        return {}
    values = np.unique(data)
    if len(values) > MOST_VALUES:
        return {}
    if set(values) == {0, 1}:
        return {name: data == 1}
    return {f"{name}={int(value)}": data == value for value in values}


def _check_coordinate_systems(mesh: meshio.Mesh) -> None:
    """Refuse Nastran's CP field, which meshio keeps as the reference of a node but ignores."""
    if np.any(mesh.point_data.pop("nastran:ref", 0)):
        raise MeshError("gives its nodes in coordinate systems (CP): export them in the basic one")
