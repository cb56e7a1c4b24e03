"""A mesh in mm, written in the formats of other programs."""

from typing import NamedTuple

import meshio
import numpy as np

from geometry.base import check_settings
from geometry.blade import Blade

# corners 0 and 1 exchanged, for a mirrored cell
MIRRORED = [1, 0, 2, 3, 4, 6, 5, 8, 7, 9]


def groups(mesh: meshio.Mesh) -> dict[str, np.ndarray]:
    """Facets (k, 6) of the physical groups `root` and `tip`."""
    return {
        name: np.vstack(
            [
                block.data[physical == mesh.field_data[name][0]]
                for block, physical in zip(mesh.cells, mesh.cell_data["gmsh:physical"], strict=True)
                if block.type == "triangle6"
            ]
        )
        for name in ("root", "tip")
    }


class Parts(NamedTuple):
    """Points, cells and groups of a mesh to be written."""

    points: np.ndarray  # mm
    cells: np.ndarray
    facets: dict[str, np.ndarray]


def parts(path) -> Parts:
    """Read the parts of ``blade.msh``."""
    mesh = meshio.read(path)
    return Parts(mesh.points * 1e3, mesh.cells_dict["tetra10"], groups(mesh))


def same_facets(found, expected):
    """Facets by the places of their corners: nodes may be numbered anew."""

    def places(parts, name):
        corners = parts.points[parts.facets[name][:, :3]].round(6)
        return {tuple(sorted(map(tuple, facet))) for facet in corners.tolist()}

    return all(places(found, name) == places(expected, name) for name in ("root", "tip"))


def oblique(parts: Parts, fall: float) -> Parts:
    """The blade on a hub that falls by ``fall`` (mm) from inlet to outlet; the tip stays."""
    moved, z = parts.points.copy(), parts.points[:, 2]
    left = (562.4 - np.hypot(*moved[:, :2].T)) / 140
    moved[:, 0] -= fall * left * (z - z.min()) / np.ptp(z)
    return parts._replace(points=moved)


def write_inp(path, points, cells, facets, kind="C3D10"):
    """Node sets; Abaqus numbers the nodes of a cell as VTK does."""
    lines = ["*NODE, NSET=Nall"]
    lines += [f"{i}, {x:.17g}, {y:.17g}, {z:.17g}" for i, (x, y, z) in enumerate(points, 1)]
    lines += [f"*ELEMENT, TYPE={kind}, ELSET=Eall"]
    lines += [", ".join(map(str, [i, *(c + 1)])) for i, c in enumerate(cells, 1)]
    for name, group in facets.items():
        lines += [f"*NSET, NSET={name}", *(f"{i + 1}," for i in np.unique(group))]
    path.write_text("\n".join(lines) + "\n")


def fortran(deck):
    """The text of ``write_inp`` with all coordinates in the numbers of Fortran."""
    nodes, rest = deck.split("*ELEMENT", 1)
    head, *rows = nodes.splitlines()
    places = np.loadtxt(rows, delimiter=",", ndmin=2)[:, 1:]
    numbers = [", ".join(f"{x:.16E}" for x in place).replace("E", "D") for place in places]
    lines = [f"{i}, {place}" for i, place in enumerate(numbers, 1)]
    return "\n".join([head, *lines, "*ELEMENT" + rest])


def write_bdf(path, points, cells, facets):
    """Large field, 16 characters a number; groups are the properties of shells, from 2 on."""
    lines = ["BEGIN BULK"]
    for i, point in enumerate(points, 1):
        x, y, z = (f"{value:.13f}"[:16] for value in point)
        lines += [f"GRID*   {i:16d}{'':16}{x:>16}{y:>16}*", f"*       {z:>16}"]
    for i, c in enumerate(cells + 1, 1):
        lines += [f"CTETRA  {i:8d}{1:8d}" + "".join(f"{n:8d}" for n in c[:6]) + "+"]
        lines += ["+       " + "".join(f"{n:8d}" for n in c[6:])]
    element = len(cells)
    for pid, group in enumerate(facets.values(), 2):
        for f in group + 1:
            element += 1
            lines += [f"CTRIA6  {element:8d}{pid:8d}" + "".join(f"{n:8d}" for n in f)]
    path.write_text("\n".join([*lines, "ENDDATA", ""]))


def write_msh(path, points, cells, facets):
    """MSH 2.2 with physical groups."""
    tags = [np.full(len(cells), 1), *(np.full(len(f), i) for i, f in enumerate(facets.values(), 2))]
    mesh = meshio.Mesh(
        points,
        [("tetra10", cells), *(("triangle6", f) for f in facets.values())],
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data={
            "blade": np.array([1, 3]),
            **{name: np.array([i, 2]) for i, name in enumerate(facets, 2)},
        },
    )
    mesh.write(path, file_format="gmsh22", binary=False)


def write_vtu(path, points, cells, facets):
    """Point data, 1 on the nodes of the group."""
    data = {name: np.zeros(len(points), dtype=np.int32) for name in facets}
    for name, group in facets.items():
        data[name][np.unique(group)] = 1
    meshio.Mesh(points, [("tetra10", cells)], point_data=data).write(path)


def as_meshed(blade, file, root="ROOT", tip="TIP", **keys):
    """Return the settings of ``blade`` with the mesh ``file`` in mm as its geometry."""
    values = blade.model_dump(exclude_unset=True)
    del values["sections"], values["mesh"]
    faces = {
        name: {"group": face} if isinstance(face, str) else {"radius_mm": face}
        for name, face in (("root", root), ("tip", tip))
    }
    values["interface"] = keys.pop("interface", values["interface"])
    values["mesh_file"] = {"file": file, "unit": "mm"} | faces | keys
    return check_settings(Blade, values, "test")


def write_cdb(path, points, cells, facets, materials=(), nodes=None, kind=187):
    """As CDWRITE does: SOLID187 in blocks, node components; numbers of nodes have gaps."""
    number = np.arange(len(points)) * 2 + 5
    lines = ["/COM,ANSYS RELEASE 2024 R2", "/PREP7", f"ET,1,{kind}", *materials]
    lines += [f"NBLOCK,6,SOLID,{number[-1]:>9},{nodes or len(points):>9}", "(3i9,6e21.13e3)"]
    lines += [
        f"{n:9d}{0:9d}{0:9d}" + "".join(f"{x:21.13E}" for x in point)
        for n, point in zip(number, points, strict=True)
    ]
    lines += ["N,R5.3,LOC,       -1,", f"EBLOCK,19,SOLID,{len(cells):>9},{len(cells):>9}", "(19i9)"]
    for i, cell in enumerate(cells, 1):
        values = [1, 1, 1, 1, 0, 0, 0, 0, len(cell), 0, i, *number[cell]]
        lines += _in_lines(values, 19)
    lines += [f"{-1:9d}"]
    for name, group in facets.items():
        of = number[np.unique(group)]
        lines += [f"CMBLOCK,{name.upper():<8},NODE,{len(of):>8}  ! component", "(8i10)"]
        lines += ["".join(f"{n:10d}" for n in of[i : i + 8]) for i in range(0, len(of), 8)]
    path.write_text("\n".join([*lines, "FINISH", ""]))


def _in_lines(values, count):
    return ["".join(f"{v:9d}" for v in values[i : i + count]) for i in range(0, len(values), count)]


FORMATS = {  # how they are written, root and tip
    ".inp": (write_inp, "ROOT", "TIP"),
    ".cdb": (write_cdb, "ROOT", "tip"),
    ".bdf": (write_bdf, "nastran:ref=2", "nastran:ref=3"),
    ".msh": (write_msh, "root", "tip"),
    ".vtu": (write_vtu, "root", "tip"),
}
