"""Files as people have them: read for all they say, or what is left out is said.

`cases/` has three small meshes of an own blade. Frequencies are those of CalculiX 2.20 on the same
cells, from `tests/fem/calculix.py` where no other source is named.
"""

import lzma
import re
import subprocess
from pathlib import Path

import calculix
import gmsh
import meshio
import numpy as np
import pytest
from refused import refused
from scipy.sparse.linalg import eigsh

from fem.assemble import assemble
from fem.elsewhere import read_matrices
from geometry.base import MeshError, MeshWarning, check_settings
from geometry.blade import Blade
from geometry.elsewhere import MatricesElsewhere
from geometry.mesh import build_mesh
from geometry.readers import read_mesh_file
from geometry.shape import session

HERE = Path(__file__).parent
TITANIUM = {"young_modulus_GPa": 113.8, "poisson_ratio": 0.342, "density_kg_m3": 4430}
STEEL = {"young_modulus_GPa": 210, "poisson_ratio": 0.3, "density_kg_m3": 7850}
PLAIN = "*MATERIAL, NAME=TI\n*ELASTIC\n113800., 0.342\n*DENSITY\n4.43E-9\n"
OTHER = "*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n*DENSITY\n7.85E-9\n"
ALL = "*SOLID SECTION, ELSET=EALL, MATERIAL={}\n"
HALVES = "*ELSET, ELSET=INNER, GENERATE\n1, 288\n*ELSET, ELSET=OUTER, GENERATE\n289, 576\n"
CRYSTAL = "*ELASTIC, TYPE=ORTHO\n25e4, 16e4, 25e4, 16e4, 16e4, 25e4, 11.8e4, 11.8e4\n11.8e4, 293.\n"
CRYSTAL += "*DENSITY\n8.6E-9\n"


def case(name):
    return lzma.decompress((HERE / "cases" / f"{name}.xz").read_bytes()).decode()


@pytest.fixture(scope="module")
def mesh():
    """The mesh of case 01 to 03, without materials."""
    return case("n00.inp")


@pytest.fixture
def meshed(tmp_path):
    """Write a text as a file, and build its blade."""

    def meshed(name, text, material=TITANIUM, **keys):
        (tmp_path / name).write_text(text)
        ends = {end: {"group": end.upper()} for end in ("root", "tip")}
        values = {
            "mesh_file": {"file": name, "unit": "mm"} | ends | keys,
            "material": material,
            "max_speed_rad_s": 600,
            "interface": {"patches": 4},
        }
        blade = check_settings(Blade, values, "blade")
        return (
            blade,
            tmp_path / "blade.msh",
            build_mesh(blade, tmp_path / "blade.msh", tmp_path / name),
        )

    return meshed


def frequencies(blade, mesh, count=3):
    """Frequencies at rest, Hz."""
    found = assemble(blade, "case", mesh, [0.0])
    squared = eigsh(found.K[0], count, M=found.M, sigma=0)[0]
    return np.sqrt(squared) / (2 * np.pi)


def nastran(text, cards):
    """The deck of case 01 in free fields of Nastran; elements from 289 on have property 2."""
    lines, kind = ["SOL 103", "CEND", "TITLE = own", "BEGIN BULK"], ""
    for line in text.splitlines():
        if line.startswith("*"):
            kind = line.split(",")[0]
        elif kind == "*NODE":
            number, *place = line.split(",")
            lines.append(f"GRID,{number.strip()},," + ",".join(x.strip()[:20] for x in place))
        elif kind == "*ELEMENT":
            number, *nodes = (int(x) for x in line.split(","))
            of = 1 if number < 289 else 2
            row = [*map(str, nodes)]
            lines.append(f"CTETRA,{number},{of}," + ",".join(row[:6]))
            lines.append("," + ",".join(row[6:]))
    return "\n".join([*lines, *cards, "ENDDATA", ""])


def ansys(commands, second=2, system=0):
    """The deck of case 04 with a material from element 289 on, and commands before its blocks."""
    lines, number = [], 0
    for line in case("n13c.cdb").splitlines():
        if re.match(r"( +\d+){19}$", line):
            number += 1
            fields = [int(line[i : i + 9]) for i in range(0, len(line), 9)]
            fields[0] = second if number > 288 else 1
            fields[4] = system
            line = "".join(f"{x:9d}" for x in fields)
        lines.append(line)
    return "\n".join(lines).replace("ET,1,187", f"ET,1,187\n{commands}") + "\n"


RADII = {"root": {"radius_mm": 200.2}, "tip": {"radius_mm": 279}}
WRITERS = {  # of the deck of case 01 with something else; root and tip where it has no groups
    "a.inp": (lambda text, cards: text + cards, {}),
    "a.bdf": (nastran, RADII),
    "a.cdb": (lambda _, keys: ansys(**keys), {}),
}
MP = "MP,EX,1,113800\nMP,NUXY,1,0.342\nMP,DENS,1,4.43E-9\n"
MP2 = MP.replace(",1,", ",2,").replace("113800", "210000")
MAT1 = ["PSOLID,1,1", "PSOLID,2,1", "MAT1,1,113800.,,.342,4.43-9"]
REFUSED = {
    "two materials": (
        "a.inp",
        HALVES + PLAIN + OTHER + "*SOLID SECTION, ELSET=INNER, MATERIAL=STEEL\n"
        "*SOLID SECTION, ELSET=OUTER, MATERIAL=TI\n",
        "2 materials (STEEL of 288 cells, TI of 288 cells)",
    ),
    "two of Nastran": (
        "a.bdf",
        ["PSOLID,1,1", "PSOLID,2,7", *MAT1[2:], "MAT1,7,2.1+5,,.3,7.85-9"],
        "2 materials (1 of 288 cells, 7 of 288 cells)",
    ),
    "two of Ansys": ("a.cdb", {"commands": MP + MP2}, "2 materials (1 of 288 cells, 2 of 288"),
    "cells without a section": (
        "a.inp",
        HALVES + PLAIN + "*SOLID SECTION, ELSET=INNER, MATERIAL=TI\n",
        "2 materials (TI of 288 cells, none of 288 cells)",
    ),
    "a crystal": (
        "a.inp",
        f"*MATERIAL, NAME=SX\n{CRYSTAL}*ORIENTATION, NAME=OR\n1., 0., 0., 0., 1., 0.\n"
        "*SOLID SECTION, ELSET=EALL, MATERIAL=SX, ORIENTATION=OR\n",
        "material SX with ELASTIC, TYPE=ORTHO and ORIENTATION",
    ),
    "a crystal of Nastran": (
        "a.bdf",
        ["PSOLID,1,1", "PSOLID,2,1", "MAT9,1,2.5+5,1.6+5,1.6+5"],
        "material 1 with ELASTIC, TYPE=MAT9",
    ),
    "axes of a section": ("a.bdf", ["PSOLID,1,1,3", "PSOLID,2,1,3", *MAT1[2:]], "CORDM"),
    "a crystal of Ansys": (
        "a.cdb",
        {"commands": MP + "MP,EZ,1,90000\n", "second": 1},
        "material 1 with EZ",
    ),
    "a table of Ansys": (
        "a.cdb",
        {"commands": MP + "TB,ANEL,1,1\n", "second": 1},
        "material 1 with TB,ANEL",
    ),
    "a turned system": ("a.cdb", {"commands": MP, "second": 1, "system": 11}, "with ESYS"),
    "rubber": (
        "a.inp",
        "*MATERIAL, NAME=R\n*HYPERELASTIC, NEO HOOKE\n1., 0.\n" + ALL.format("R"),
        "material R with HYPERELASTIC",
    ),
    "layers": (
        "a.inp",
        PLAIN + "*SOLID SECTION, ELSET=EALL, MATERIAL=TI, COMPOSITE\n",
        "material TI with COMPOSITE",
    ),
    "masses": (
        "a.inp",
        "*ELEMENT, TYPE=MASS, ELSET=M\n9000, 5\n9001, 6\n*MASS, ELSET=M\n2e-6\n"
        + PLAIN
        + ALL.format("TI"),
        "point masses (2 MASS)",
    ),
    "layers of Nastran": ("a.bdf", ["PCOMPS,1", "PCOMPS,2", MAT1[2]], "with PCOMPS"),
    "an elastic table of Ansys": (
        "a.cdb",
        {
            "commands": "TB,ELASTIC,1,1,2,ISOT\nTBDATA,1,113800.,0.342\nTB,ELASTIC,2,1,2,ISOT\n"
            "TBDATA,1,210000.,0.3\nMP,DENS,1,4.43E-9\nMP,DENS,2,4.43E-9\n"
        },
        "2 materials",
    ),
    "materials without sections": ("a.inp", PLAIN + OTHER, "2 materials (TI, STEEL)"),
    "mass along a surface": ("a.bdf", [*MAT1, "NSML1,1,PSOLID,2.-6,1"], "point masses (1 NSML1)"),
    "masses of Nastran": ("a.bdf", [*MAT1, "CONM2,9000,5,,2.-7"], "point masses (1 CONM2)"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_physics_that_a_blade_has_not_is_refused(name, mesh, meshed):
    """Of case 01, f1 was 650.81 Hz for all, where CalculiX gives 821.75, 516.47 and 578.41."""
    file, what, words = REFUSED[name]
    write, ends = WRITERS[file]
    error = refused(MeshError, meshed, file, write(mesh, what), **ends)
    assert words in error.text and "full_matrices" in error.text


@pytest.mark.skipif(calculix.CCX is None, reason="ccx is not here (calculix-ccx)")
@pytest.mark.parametrize("name", ["two materials", "a crystal", "masses"])
def test_matrices_of_calculix_have_that_physics(name, mesh, tmp_path):
    """The way through that the refusal names: f1 is the one that ccx prints for the same deck."""
    deck = mesh + REFUSED[name][1]
    clamped = "*BOUNDARY\nROOT, 1, 3\n*STEP\n*FREQUENCY{}\n3\n*END STEP\n"
    for job, solver in (("rest", ", SOLVER=MATRIXSTORAGE"), ("printed", "")):
        (tmp_path / f"{job}.inp").write_text(deck + clamped.format(solver))
        subprocess.run([calculix.CCX, "-i", job], cwd=tmp_path, capture_output=True, check=True)
    (tmp_path / "a.inp").write_text(deck)
    ends = {end: {"group": end.upper()} for end in ("root", "tip")}
    files = {"M": "rest.mas", "K": {0.0: "rest.sti"}}
    given = {"full_matrices": files | {"mesh_file": {"file": "a.inp", "unit": "mm"} | ends}}
    blade = check_settings(
        MatricesElsewhere, given | {"patches": 4, "max_speed_rad_s": 600}, "blade"
    )
    found = read_matrices(blade, "given", tmp_path)
    f1 = np.sqrt(eigsh(found.K[0], 1, M=found.M, sigma=0)[0][0]) / (2 * np.pi)
    printed = re.search(r"^ +1 +\S+ +\S+ +(\S+)", (tmp_path / "printed.dat").read_text(), re.M)[1]
    assert f1 == pytest.approx(float(printed), rel=1e-5)
    assert abs(f1 / 650.81 - 1) > 0.03  # of the mesh alone, in titanium


def test_masses_of_ansys_are_refused(meshed):
    text = ansys("ET,2,21\n", second=1)
    block = text.index("EBLOCK")
    row = "".join(f"{x:9d}" for x in (1, 2, 1, 1, 0, 0, 0, 0, 1, 0, 9000, 5))
    end = text.index("CMBLOCK")
    head = text[block:end].rstrip().removesuffix("-1").rstrip().replace("576,576", "577,577")
    error = refused(MeshError, meshed, "a.cdb", f"{text[:block]}{head}\n{row}\n{text[end:]}")
    assert "point masses (1 MASS21)" in error.text


def test_a_deck_of_another_metal_is_warned_of(mesh, meshed):
    """f1 is that of the material of the blade's file; CalculiX 659.45 Hz with that of the deck."""
    deck = mesh + OTHER + ALL.format("STEEL")
    with pytest.warns(MeshWarning, match="material STEEL .* 210.*taken is `material`"):
        meshed("n01steel.inp", deck)
    blade, path, _ = meshed("n01steel.inp", deck, material=STEEL)
    assert frequencies(blade, path, 1)[0] == pytest.approx(659.45, rel=1e-3)


def test_what_is_left_out_of_a_deck_is_said(mesh, meshed, capsys):
    cards = "*ELEMENT, TYPE=SPRINGA\n9000, 5, 6\n*STEP\n*BOUNDARY\nROOT, 1, 3\n*CLOAD\n5, 1, 2.\n"
    meshed("a.inp", mesh + PLAIN + ALL.format("TI") + cards)
    told = capsys.readouterr().out
    assert "without 1 BOUNDARY, 1 CLOAD, 1 SPRINGA, 1 STEP" in told
    assert "material TI of the file" in told and "young_modulus_GPa 113.8" in told


def test_materials_of_the_same_values_are_one(mesh, meshed):
    """As programs write them, one a part."""
    two = PLAIN + PLAIN.replace("NAME=TI", "NAME=TI_2").replace("113800", "113900")
    sections = "".join(
        f"*SOLID SECTION, ELSET={elset}, MATERIAL={name}\n"
        for elset, name in (("INNER", "TI"), ("OUTER", "TI_2"))
    )
    _, _, summary = meshed("a.inp", mesh + HALVES + two + sections)
    assert summary.cells == 576


def test_parts_and_fields_of_other_formats_are_said(mesh, meshed, tmp_path, capsys):
    (tmp_path / "a.inp").write_text(mesh)
    read = read_mesh_file(tmp_path / "a.inp")
    groups = {"root": "ROOT", "tip": "TIP"}
    ends = {
        own: np.isin(np.arange(len(read.points)), read.node_groups[name]) * 1
        for own, name in groups.items()
    }
    meshio.Mesh(
        read.points,
        [("tetra10", read.cells)],
        point_data=ends | {"temperature": np.linspace(300.5, 500.5, len(read.points))},
        cell_data={"material": [np.repeat([1, 2], 288)]},
    ).write(tmp_path / "a.vtu")
    said = read_mesh_file(tmp_path / "a.vtu").physics.described
    assert "1 array temperature" in said
    assert "288 cells of the part material=1, 288 cells of the part material=2" in said


@pytest.mark.parametrize("count", [3, 6])  # short lines: zeros
def test_nodes_of_three_fields_have_three_coordinates(count, meshed):
    """As Workbench writes them; mapdl-archive reads z as 0."""
    text = case("n13c.cdb").replace("(1i9,3e20.9e3)", f"(1i9,{count}e20.9e3)")
    _, _, summary = meshed("n13c.cdb", text)
    assert summary.cells == 576
    assert 1e9 * summary.volume == pytest.approx(9363.09, abs=0.005)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda t: t.replace("(1i9,3e20.9e3)", "(1i9,2e20.9e3)"), "no format that is read"),
        (lambda t: t.replace("-1.853733731E+001\n", "-1.853733731E+001 4.0E+000\n", 1), "longer"),
        (lambda t: t.replace("7.545172332E+000", "7.545172332F+000", 1), "is no number"),
    ],
)
def test_nodes_of_ansys_are_read_as_their_format_says(change, words, tmp_path):
    (tmp_path / "a.cdb").write_text(change(case("n13c.cdb")))
    assert words in refused(MeshError, read_mesh_file, tmp_path / "a.cdb").text


def test_root_and_tip_are_lists_of_groups(meshed):
    """Clamped at two flanks of a dovetail; one alone gives 614.89 Hz."""
    blade, path, _ = meshed(
        "d.inp", case("d81union.inp"), root={"group": ["FLANK1", "flank2"]}, tip={"group": ["TIP"]}
    )
    np.testing.assert_allclose(frequencies(blade, path), [622.16, 2574.19, 2883.53], rtol=1e-3)


def test_an_unknown_group_of_a_list_is_named(meshed):
    error = refused(
        MeshError, meshed, "d.inp", case("d81union.inp"), root={"group": ["FLANK1", "FLANK3"]}
    )
    assert (error.key, error.value) == ("root.group", "FLANK3")


def test_bricks_that_only_mesh_are_read(tmp_path):
    """MESH200 of a volume."""
    nodes = "".join(
        f"{i:9d}{0:9d}{0:9d}{x:21.13E}{y:21.13E}{z:21.13E}\n"
        for i, (x, y, z) in enumerate(np.ndindex(2, 2, 2), 1)
    )
    element = "".join(f"{x:9d}" for x in (1, 1, 1, 1, 0, 0, 0, 0, 8, 0, 1, 1, 5, 7, 3, 2, 6, 8, 4))
    (tmp_path / "a.cdb").write_text(
        f"/PREP7\nET,1,200\nKEYOPT,1,1,10\nNBLOCK,6,SOLID,8,8\n(3i9,6e21.13e3)\n{nodes}"
        f"N,R5.3,LOC,       -1,\nEBLOCK,19,SOLID,1,1\n(19i9)\n{element}\n       -1\nFINISH\n"
    )
    read = read_mesh_file(tmp_path / "a.cdb")
    assert read.made.startswith("1 hexahedron on 8 nodes")


def by_gmsh(path, volume=True, same=False, partitions=0, also=(), **numbers):
    """A box with groups, as gmsh writes it."""
    with session("test"):
        gmsh.model.occ.addBox(200, -2, -20, 80, 4, 40)
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(2, [1], name="root")
        gmsh.model.addPhysicalGroup(2, [2], name="tip")
        if also:
            gmsh.model.addPhysicalGroup(2, also, name="also")
        if volume:
            gmsh.model.addPhysicalGroup(3, [1], name="root" if same else "blade")
        gmsh.option.setNumber("Mesh.MeshSizeMin", 8)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 8)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        if partitions:
            gmsh.model.mesh.partition(partitions)
        for name, value in numbers.items():
            gmsh.option.setNumber(f"Mesh.{name}", value)
        gmsh.write(str(path))


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ({"volume": False}, "holds no tetrahedra, bricks.*physical volume"),
        ({"volume": False, "Binary": 1}, "holds no tetrahedra, bricks.*physical volume"),
        ({"volume": False, "MshFileVersion": 2.2}, "holds no tetrahedra, bricks.*physical volume"),
        ({"partitions": 2}, "is partitioned: save it whole"),
        ({"SaveAll": 1}, "its groups alone"),
    ],
)
def test_files_of_gmsh_that_lack_something_are_named(how, words, tmp_path):
    by_gmsh(tmp_path / "a.msh", **how)
    refused(MeshError, read_mesh_file, tmp_path / "a.msh", match=words)


def test_a_surface_of_two_groups_is_in_both(tmp_path):
    """meshio has one number for each surface of MSH 4.1; of MSH 2.2 it stands there twice."""
    counts = []
    for version in (2.2, 4.1):
        by_gmsh(tmp_path / "a.msh", MshFileVersion=version, also=[1, 3])
        groups = read_mesh_file(tmp_path / "a.msh").face_groups
        counts.append({name: len(of) for name, of in groups.items() if ":" not in name})
    assert counts[0] == counts[1] and counts[0]["also"] > counts[0]["root"] > 0


def test_a_number_of_heat_is_no_material_of_a_blade(mesh, meshed):
    """MAT4 has the number of its MAT1."""
    deck = nastran(mesh, [*MAT1, "MAT4,1,7.2,526.,4.43-9"])
    _, _, summary = meshed("a.bdf", deck, **RADII)
    assert summary.cells == 576


@pytest.mark.parametrize("version", [2.2, 4.1])
def test_a_name_may_stand_for_a_surface_and_a_volume(version, tmp_path):
    by_gmsh(tmp_path / "a.msh", same=True, MshFileVersion=version)
    groups = read_mesh_file(tmp_path / "a.msh").face_groups
    assert len(groups["root"]) > 0 and len(groups["tip"]) > 0


def vtu(path, cells, kind):
    """A tetrahedron of ten nodes of VTK, by the number of its kind."""
    places = np.vstack([np.zeros(3), np.eye(3)])
    middles = [
        places[[a, b]].mean(axis=0) for a, b in ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
    ]
    array = '<DataArray type="{}" Name="{}" format="ascii">{}</DataArray>'
    numbers = " ".join(map(str, np.vstack([places, middles]).ravel()))
    path.write_text(
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
        'header_type="UInt32"><UnstructuredGrid><Piece NumberOfPoints="10" NumberOfCells="1">'
        f'<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">{numbers}'
        "</DataArray></Points><Cells>"
        + array.format("Int64", "connectivity", " ".join(map(str, cells)))
        + array.format("Int64", "offsets", len(cells))
        + array.format("UInt8", "types", kind)
        + "</Cells></Piece></UnstructuredGrid></VTKFile>"
    )


@pytest.mark.parametrize(
    ("cells", "kind", "words"),
    [
        (range(10), 71, "LAGRANGE.*its quadratic cells"),
        (range(1, 11), 24, "counted from another number"),
        (range(4), 42, "without polyhedra"),
        (range(3), 5, "holds no tetrahedra"),
    ],
)
def test_cells_of_vtk_that_are_not_read_are_named(cells, kind, words, tmp_path):
    vtu(tmp_path / "a.vtu", cells, kind)
    refused(MeshError, read_mesh_file, tmp_path / "a.vtu", match=words)
