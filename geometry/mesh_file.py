"""Mesh files of other programs: points, tetrahedra and named groups, as the file has them."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import meshio
import numpy as np
from numpy.typing import NDArray

from geometry.abaqus import read_deck
from geometry.errors import MeshError

TRIANGLES = ("triangle", "triangle6")
MOST_VALUES = 1000  # an array with more values is a field, not a grouping


@dataclass
class FileMesh:
    """A mesh as its file has it, in the file's unit and axes."""

    points: NDArray[np.float64]  # (n, 3)
    cells: NDArray[np.int64]  # (m, 4) or (m, 10), nodes in VTK's order
    node_groups: dict[str, NDArray] = field(default_factory=dict)  # nodes (k,)
    face_groups: dict[str, NDArray] = field(default_factory=dict)  # corner nodes (k, 3)
    cell_groups: set[str] = field(default_factory=set)  # names of what holds no faces

    @property
    def facet_nodes(self) -> int:
        """Nodes that a facet has in the file: three, or six with the middles of its edges."""
        return 3 if self.cells.shape[1] == 4 else 6

    def without_unused(self) -> "FileMesh":
        """The mesh without the nodes that no tetrahedron uses."""
        used = np.unique(self.cells)
        new = np.full(len(self.points), -1)
        new[used] = np.arange(len(used))
        return FileMesh(
            points=self.points[used],
            cells=new[self.cells],
            node_groups={n: new[nodes][new[nodes] >= 0] for n, nodes in self.node_groups.items()},
            face_groups={n: new[faces] for n, faces in self.face_groups.items()},
            cell_groups=self.cell_groups,
        )


def read_mesh_file(path: str | Path) -> FileMesh:
    """Read ``.inp``, ``.bdf``, ``.nas``, ``.fem``, ``.msh`` or ``.vtu``.

    Shells, beams and points are only read as groups.

    Raises
    ------
    MeshError
        When there is no such file or format, or it cannot be read, or holds other solid cells.
    """
    path = Path(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise MeshError(f"suffix {path.suffix or 'missing'}: known are {', '.join(READERS)}")
    if not path.is_file():
        raise MeshError("there is no such file")
    try:
        mesh = reader(path)
    except MeshError:
        raise
    except Exception as error:  # the readers raise whatever a damaged file leads them to
        what = " ".join(f"{type(error).__name__} {error}".split())
        raise MeshError(f"cannot be read as {path.suffix} ({what})") from None
    if mesh.points.ndim != 2 or mesh.points.shape[1] != 3 or not np.isfinite(mesh.points).all():
        raise MeshError("its nodes have not three finite coordinates each")
    return mesh


def _of_abaqus(path: Path) -> FileMesh:
    deck = read_deck(path)
    triangles = {name: faces for name, faces in deck.faces.items() if len(faces)}
    return FileMesh(
        points=deck.points,
        cells=_tetrahedra(deck.cells),
        node_groups=deck.nodes,
        face_groups=triangles,
        cell_groups=set(deck.faces) - set(triangles),
    )


def _of_meshio(read: Callable[[Path], meshio.Mesh]) -> Callable[[Path], FileMesh]:
    def convert(path: Path) -> FileMesh:
        mesh = read(path)
        _check_coordinate_systems(mesh)
        cells = [(b.type, b.data) for b in mesh.cells if b.dim == 3]
        found = FileMesh(mesh.points, _tetrahedra(cells))
        for name, data in mesh.point_data.items():
            found.node_groups |= {n: np.flatnonzero(m) for n, m in _values(name, data).items()}
        for name, members in _cell_groups(mesh).items():
            faces = [
                block.data[chosen, :3]
                for block, chosen in zip(mesh.cells, members, strict=True)
                if block.type in TRIANGLES
            ]
            faces = np.vstack([np.empty((0, 3), dtype=int), *faces])
            if len(faces):
                found.face_groups[name] = faces
            else:
                found.cell_groups.add(name)
        return found

    return convert


def _tetrahedra(blocks: list[tuple[str, NDArray]]) -> NDArray[np.int64]:
    """All cells, which must be of one kind."""
    counts = Counter()
    for kind, data in blocks:
        counts[kind] += len(data)
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


def _cell_groups(mesh: meshio.Mesh) -> dict[str, list[NDArray]]:
    """Members of each block of cells, as indices: sets, physical names, integer cell data."""
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
    """Groups that an array of whole numbers makes: ``name`` where 0 or 1, else ``name=value``."""
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
    """Nastran's CP field, which meshio keeps as the reference of a node and does not apply."""
    if np.any(mesh.point_data.pop("nastran:ref", 0)):
        raise MeshError("gives its nodes in coordinate systems (CP): export them in the basic one")


READERS: dict[str, Callable[[Path], FileMesh]] = {
    ".inp": _of_abaqus,
    ".bdf": _of_meshio(meshio.nastran.read),
    ".nas": _of_meshio(meshio.nastran.read),
    ".fem": _of_meshio(meshio.nastran.read),
    ".msh": _of_meshio(meshio.gmsh.read),
    ".vtu": _of_meshio(meshio.vtu.read),
}
