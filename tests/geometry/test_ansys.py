"""Archives of Ansys against our own mesh, and against mapdl-archive's own writer and grid."""

import re

import exports
import numpy as np
import pytest
import pyvista
from mapdl_archive import Archive, save_as_archive
from refused import refused

from geometry.ansys import read_archive
from geometry.base import ROOT, MeshError, MeshWarning
from geometry.blade import Blade
from geometry.file_mesh import FileMaterial
from geometry.mesh import build_mesh

BLADES = ROOT / "workflow/blades"
SOLID = {8: 185, 20: 186}  # by the number of nodes

TITANIUM = [  # in N and mm, as CDWRITE writes them
    "MPTEMP,R5.0, 1, 1,  0.00000000    ,",
    "MPDATA,R5.0, 1,EX  ,       1, 1,  113800.000    ,",
    "MPTEMP,R5.0, 1, 1,  0.00000000    ,",
    "MPDATA,R5.0, 1,PRXY,       1, 1, 0.342000000    ,",
    "MP,DENS,1,4.43E-09 ! as Workbench writes it",
]


@pytest.fixture
def archive(tmp_path, parts):
    """Write the mesh, changed as text; its path."""

    def archive(change=lambda text: text, **keys):
        path = tmp_path / "blade.cdb"
        exports.write_cdb(path, *parts, **keys)
        path.write_text(change(path.read_text()))
        return path

    return archive


def test_nodes_cells_and_components_are_those_written(parts, archive):
    mesh = read_archive(archive())
    np.testing.assert_allclose(mesh.points, parts.points, rtol=1e-13)
    np.testing.assert_array_equal(mesh.cells, parts.cells)
    for name, facets in parts.facets.items():
        np.testing.assert_array_equal(np.sort(mesh.node_groups[name.upper()]), np.unique(facets))


def test_archive_of_another_writer(parts, tmp_path):
    grid = pyvista.UnstructuredGrid({pyvista.CellType.QUADRATIC_TETRA: parts.cells}, parts.points)
    for name, facets in parts.facets.items():
        grid.point_data[name] = np.isin(np.arange(len(parts.points)), facets)
    save_as_archive(tmp_path / "blade.cdb", grid)
    mesh = read_archive(tmp_path / "blade.cdb")
    np.testing.assert_array_equal(mesh.cells, parts.cells)
    np.testing.assert_allclose(mesh.points, parts.points, rtol=1e-12)
    assert {*mesh.node_groups} == {"ROOT", "TIP"}
    np.testing.assert_array_equal(np.sort(mesh.node_groups["TIP"]), np.unique(parts.facets["tip"]))


@pytest.mark.parametrize("count", [8, 20])
def test_bricks_collapsed_to_tetrahedra(count, tmp_path):
    """SOLID185 and SOLID186 with I J K K M M M M, as the grid of mapdl-archive has them."""
    points = np.random.default_rng(0).random((10, 3))
    i, j, k, m, ij, jk, ki, im, jm, km = range(10)
    corners = [i, j, k, k, m, m, m, m]
    middles = [ij, jk, k, ki, m, m, m, m, im, jm, km, km]
    path = tmp_path / "brick.cdb"
    exports.write_cdb(path, points, np.array([(corners + middles)[:count]]), {}, kind=SOLID[count])
    mesh = read_archive(path)
    grid = Archive(path).grid
    (expected,) = grid.cells_dict.values()
    np.testing.assert_array_equal(mesh.cells[:, : expected.shape[1]], expected)
    assert mesh.first_order == (count == 8) and not mesh.made


@pytest.mark.parametrize("kind", [45, 185, 95, 186])
def test_bricks_of_old_and_new_types_are_read(kind, tmp_path):
    points, first_order = np.random.default_rng(0).random((20, 3)), kind in (45, 185)
    cell = np.arange(8 if first_order else 20)
    exports.write_cdb(tmp_path / "a.cdb", points, cell[None], {}, kind=kind)
    mesh = read_archive(tmp_path / "a.cdb")
    assert mesh.made.startswith("1 hexahedron on") and mesh.first_order == first_order


def test_a_brick_collapsed_in_another_way_is_refused(tmp_path):
    exports.write_cdb(
        tmp_path / "a.cdb", np.eye(8, 3), np.array([[0, 0, 2, 3, 4, 4, 6, 7]]), {}, kind=185
    )
    error = refused(MeshError, read_archive, tmp_path / "a.cdb")
    assert "holds 1 cells of another kind" in error.text


def test_faces_of_an_element_component(parts, archive):
    """The root as triangles of MESH200, in a component of elements."""
    facets, number = parts.facets["root"], np.arange(len(parts.points)) * 2 + 5
    first = len(parts.cells) + 1
    rows = [
        "".join(f"{v:9d}" for v in (1, 2, 1, 1, 0, 0, 0, 0, 6, 0, first + i, *number[facet]))
        for i, facet in enumerate(facets)
    ]
    count = len(parts.cells) + len(facets)

    def change(text):
        text = text.replace("ET,1,187", "ET,1,187\nET,2,200\nKEYOP,2,1,5")
        old = f"EBLOCK,19,SOLID,{len(parts.cells):>9},{len(parts.cells):>9}"
        text = text.replace(old, f"EBLOCK,19,SOLID,{count:>9},{count:>9}")
        faces = f"CMBLOCK,SKIN,ELEM,2\n(8i10)\n{first:10d}{-(first + len(facets) - 1):10d}\nFINISH"
        end = f"{-1:9d}\n"
        return text.replace(end, "\n".join([*rows, end])).replace("FINISH", faces)

    mesh = read_archive(archive(change))
    np.testing.assert_array_equal(mesh.cells, parts.cells)
    np.testing.assert_array_equal(mesh.face_groups["SKIN"], facets[:, :3])


FAULTS = {
    "declares 9999 nodes, of which": {"nodes": 9999},
    "holds no NBLOCK": {"change": lambda text: text.replace("NBLOCK", "NBLOK")},
    "holds no EBLOCK of SOLID": {
        "change": lambda text: text.replace("EBLOCK,19,SOLID", "EBLOCK,9")
    },
    "elements, of which": {"change": lambda text: text[: int(0.8 * len(text))]},
    "a node cannot be read ('  4.": {"change": lambda text: text.replace("E+02", "Ex02", 1)},
    "element 1 has type 1, which no ET defines": {
        "change": lambda text: text.replace("ET,1,187", "ET,2,187")
    },
    "an element or component has node 6, which is not there": {
        "change": lambda text: re.sub(r"(CMBLOCK.*\n.*\n).{10}", rf"\g<1>{6:10d}", text)
    },
    "holds 2 NBLOCK": {
        "change": lambda text: text.replace("FINISH", "NBLOCK,6,SOLID,1,1\n(3i9,6e21.13e3)")
    },
    "768 of 768 cells lack middle nodes": {
        "change": lambda text: text.replace("ET,1,187", "ET,1,186")
    },
}


@pytest.mark.parametrize("fault", FAULTS)
def test_damaged_archives_are_refused(fault, archive):
    error = refused(MeshError, read_archive, archive(**FAULTS[fault]))
    assert fault in error.text


def test_cells_of_four_nodes(parts, tmp_path):
    exports.write_cdb(tmp_path / "blade.cdb", parts.points, parts.cells[:, :4], parts.facets)
    mesh = read_archive(tmp_path / "blade.cdb")
    np.testing.assert_array_equal(mesh.cells[:, :4], parts.cells[:, :4])
    assert mesh.first_order


def test_cell_without_a_middle_node_is_refused(parts, archive):
    """Ansys writes 0 where a middle node was taken away."""
    cell = parts.cells[3] * 2 + 5
    line = "".join(f"{v:9d}" for v in cell[:8])
    bare = line[:-9] + f"{0:9d}"
    path = archive(lambda text: text.replace(line, bare))
    refused(MeshError, read_archive, path, match=r"^1 of .* element 4:")


@pytest.mark.parametrize(
    ("unit", "modulus", "density", "shown"),
    [
        ("in", 16.5053e6, 4.1452e-4, "psi and lbf s2/in4"),
        ("m", 1.138e11, 4430, "Pa and kg/m3"),
        ("cm", 1.138e7, 4.43e-5, "N/cm2 and N s2/cm4"),
    ],
)
def test_materials_in_the_units_of_the_length(unit, modulus, density, shown, coarse_blade):
    """The blade's own material, 113.8 GPa and 4430 kg/m3."""
    material = FileMaterial("1", modulus, 0.342, density)
    assert f"read in {shown}: young_modulus_GPa 113.8," in material.described(unit)
    assert not material.differs(coarse_blade.material, unit)


@pytest.mark.parametrize("density", [4430, 7800])
def test_materials_are_shown_and_warned_of(
    density, coarse_blade, archive, tmp_path, capsys, recwarn
):
    """In the unit of the file; the blade's own is taken, of 4430 kg/m3."""
    materials = [line.replace("4.43E-09", f"{density * 1e-12:.3E}") for line in TITANIUM]
    blade = exports.as_meshed(coarse_blade, "blade.cdb")
    build_mesh(blade, tmp_path / "out/blade.msh", archive(materials=materials))
    values = f"young_modulus_GPa 113.8, poisson_ratio 0.342, density_kg_m3 {density}"
    shown = f"material 1 of the file, read in MPa and t/mm3: {values}"
    assert shown in capsys.readouterr().out
    warned = [str(w.message) for w in recwarn if w.category is MeshWarning]
    assert len(warned) == (density != 4430)
    taken = "taken is `material` of the blade: density_kg_m3 4430"
    assert all(text.endswith(taken) for text in warned)


def test_shipped_archive_is_the_coarse_blade(coarse_mesh, tmp_path):
    """The example of geometry/README.md."""
    blade = Blade.load(BLADES / "ansys.yaml")
    summary = build_mesh(blade, tmp_path / "blade.msh", BLADES / blade.file)
    assert summary.volume == pytest.approx(coarse_mesh.summary.volume, rel=1e-6)
    assert summary.cells == coarse_mesh.summary.cells
