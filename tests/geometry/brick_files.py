"""A blade of bricks or wedges in mm, written in the formats of other programs."""

import exports
import meshio
import numpy as np
from bricks import ENDS, Bricks

from geometry.split import KINDS, NODES, TURNED

# kinds by number of nodes
ABAQUS = {8: "C3D8", 20: "C3D20R", 6: "C3D6", 15: "C3D15"}
NASTRAN = {8: "CHEXA", 20: "CHEXA", 6: "CPENTA", 15: "CPENTA"}
MESHIO = {8: "hexahedron", 20: "hexahedron20", 6: "wedge", 15: "wedge15"}
ANSYS = {  # of a brick: I J K K M N O O for a wedge
    8: [*range(8)],
    20: [*range(20)],
    6: [0, 1, 2, 2, 3, 4, 5, 5],
    15: [0, 1, 2, 2, 3, 4, 5, 5, 6, 7, 2, 8, 9, 10, 5, 11, 12, 13, 14, 14],
}


def write_inp(path, points, cells, faces):
    nodes = {name: np.unique(of) for name, of in faces.items()}
    exports.write_inp(path, points, cells, nodes, kind=ABAQUS[cells.shape[1]])


def write_cgx(path, points, cells, faces):
    """As cgx writes: a deck with the name of a mesh of Gmsh, and sides of elements."""
    deck = path.with_suffix(".inp")
    exports.write_inp(deck, points, cells, {}, kind=ABAQUS[cells.shape[1]])
    of_kind = KINDS[NODES[cells.shape[1]][0]]
    sides = {
        tuple(sorted(cell[list(face)])): f"{number}, S{side}"
        for number, cell in enumerate(cells, 1)
        for side, face in enumerate(of_kind.faces, 1)
    }
    lines = [
        line
        for name, of in faces.items()
        for line in (f"*SURFACE, NAME={name}", *(sides[tuple(sorted(face))] for face in of))
    ]
    path.write_text(deck.read_text() + "\n".join(lines) + "\n")


def write_bdf(path, points, cells, faces):
    """Free fields; middle nodes of upright edges stand before those of upper ones."""
    lines = ["BEGIN BULK"]
    lines += [f"GRID,{i},,{x:.12f},{y:.12f},{z:.12f}" for i, (x, y, z) in enumerate(points, 1)]
    corners = KINDS[NODES[cells.shape[1]][0]].corners
    own = cells
    if cells.shape[1] > corners:
        around = corners // 2
        lower, upper = corners + around, corners + 2 * around
        own = np.hstack([cells[:, :lower], cells[:, upper:], cells[:, lower:upper]])
    elements = [(NASTRAN[cells.shape[1]], 1, cell) for cell in own]
    kinds = {3: "CTRIA3", 4: "CQUAD4"}
    elements += [(kinds[len(f)], i, f) for i, of in enumerate(faces.values(), 2) for f in of]
    for number, (kind, group, nodes) in enumerate(elements, 1):
        fields = [kind, number, group, *(np.array(nodes) + 1)]
        rows = [fields[:9], *(["", *fields[i : i + 8]] for i in range(9, len(fields), 8))]
        lines += [",".join(map(str, row)) for row in rows]
    path.write_text("\n".join([*lines, "ENDDATA", ""]))


def write_cdb(path, points, cells, faces):
    nodes = {name: np.unique(of) for name, of in faces.items()}
    order = ANSYS[cells.shape[1]]
    exports.write_cdb(path, points, cells[:, order], nodes, kind={8: 185, 20: 186}[len(order)])


def write_msh(path, points, cells, faces):
    """Groups are triangles or quadrilaterals."""
    mesh = meshio.Mesh(
        points,
        [(MESHIO[cells.shape[1]], cells)]
        + [({3: "triangle", 4: "quad"}[len(of[0])], np.array(of)) for of in faces.values()],
        field_data={name: np.array([i, 2]) for i, name in enumerate(faces, 2)},
    )
    tags = [np.full(len(block), i) for i, block in enumerate(mesh.cells, 1)]
    mesh.cell_data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
    mesh.write(path, file_format="gmsh22", binary=False)


def write_vtu(path, points, cells, faces):
    """Wedges as VTK's manual has them, the other end first; groups are values at nodes."""
    if cells.shape[1] in (6, 15):
        cells = cells[:, TURNED[: cells.shape[1]]]
    at_nodes = {name: np.zeros(len(points), dtype=int) for name in faces}
    for name, of in faces.items():
        at_nodes[name][np.unique(of)] = 1
    meshio.Mesh(points, [(MESHIO[cells.shape[1]], cells)], point_data=at_nodes).write(path)


FORMATS = {  # file: how it is written, root and tip
    "b.inp": (write_inp, "ROOT", "TIP"),
    "b.msh of cgx": (write_cgx, "ROOT", "TIP"),
    "b.bdf": (write_bdf, "nastran:ref=2", "nastran:ref=3"),
    "b.cdb": (write_cdb, "ROOT", "TIP"),
    "b.msh": (write_msh, "root", "tip"),
    "b.vtu": (write_vtu, "root", "tip"),
}

OF_NODES = (write_inp, write_cdb, write_vtu)  # with the middle ones; the others have faces


def to_write(name: str, bricks: Bricks, kind: str, second_order: bool = True) -> tuple:
    """File, writer and all that it takes, of a format."""
    write, *_ = FORMATS[name]
    cells, faces = bricks.cells(kind, second_order), bricks.faces(kind, second_order)
    groups = {end: bricks.on(share, cells) for end, share in ENDS.items()}
    return name.split()[0], write, bricks.points, cells, groups if write in OF_NODES else faces
