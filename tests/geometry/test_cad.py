"""Blades from CAD files: the reference blade, exported and read back; what is refused."""

import re
from functools import partial
from pathlib import Path

import gmsh
import numpy as np
import pytest
from blades import camber_line, first_frequency, given
from refused import refused

from geometry.blade import Blade, Cad
from geometry.cad import StepFile, import_cad
from geometry.mesh import MeshError, build_mesh
from geometry.sections import loft_parameters
from geometry.shape import session

RADII = {"root": {"radius_mm": 422.5}, "tip": {"radius_mm": 562.3}}  # 0.1 mm about 422.4, 562.4
GROUPS = {"root": {"group": "hub"}, "tip": {"group": "shroud"}}


@pytest.fixture(scope="module")
def folder(tmp_path_factory, coarse_blade):
    """The reference blade as BREP (m) and STEP (mm), root and tip named hub and shroud in STEP."""
    folder = tmp_path_factory.mktemp("cad")
    with session("test"):
        gmsh.option.setString("Geometry.OCCTargetUnit", "M")  # gmsh writes STEP in mm
        shape = loft_parameters(coarse_blade.sections)
        gmsh.write(str(folder / "blade.brep"))
        gmsh.write(str(folder / "blade.step"))
        # (x, y, z) -> (z, x, y) -> (-z, x, y): a mirror
        gmsh.model.occ.rotate([(3, shape.solid)], 0, 0, 0, 1, 1, 1, 2 * np.pi / 3)
        gmsh.model.occ.mirror([(3, shape.solid)], 1, 0, 0, 0)
        gmsh.model.occ.synchronize()
        gmsh.write(str(folder / "mirrored.brep"))
    names = {shape.root[0]: "hub", shape.tip[0]: "shroud"}
    count = iter(range(1, 100))
    text = (folder / "blade.step").read_text()
    named = re.sub(
        r"ADVANCED_FACE\(''",
        lambda _: f"ADVANCED_FACE('{names.get(next(count), '')}'",
        text,
    )
    (folder / "blade.step").write_text(named)
    return folder


def build(blade, path, tmp_path, unit="m", faces=RADII, **settings) -> tuple:
    cad = {"file": path.name, "unit": unit} | faces | settings
    mesh = tmp_path / "blade.msh"
    return build_mesh(given(blade, cad=cad), mesh, path), mesh


MIRRORED = {"downstream": "-x", "radial": "y", "rotation": "left-handed"}


@pytest.mark.parametrize(
    ("name", "settings"),
    [
        ("blade.brep", {}),
        ("blade.step", {"unit": "mm"}),
        ("blade.step", {"unit": "mm", "faces": GROUPS}),
        ("mirrored.brep", {"frame": MIRRORED}),
    ],
)
def test_exported_blade_is_the_blade(coarse_blade, coarse_mesh, folder, tmp_path, name, settings):
    summary, mesh = build(coarse_blade, folder / name, tmp_path, **settings)
    # gmsh's mirror makes splines of the sides, whose volume OpenCASCADE has 7e-6 too large
    assert summary.cad_volume == pytest.approx(coarse_mesh.summary.cad_volume, rel=1e-5)
    assert summary.volume == pytest.approx(coarse_mesh.summary.volume, rel=1e-6)
    # the same curves have the same nodes: round-off of a frame and of a file's digits
    np.testing.assert_allclose(camber_line(mesh), camber_line(coarse_mesh.mesh), atol=1e-9)
    assert first_frequency(coarse_blade, mesh) == pytest.approx(
        first_frequency(coarse_blade, coarse_mesh.mesh), rel=5e-4
    )  # 800 other cells: f1 of such meshes scatters by 2e-4


@pytest.mark.parametrize(
    ("order", "off", "found"),
    [
        (slice(None), 0.005, True),  # half the tolerance of 0.01 mm
        (slice(None), 0.02, False),
        (slice(None, None, -1), 0.0, False),
    ],
)
def test_named_faces_must_have_the_vertices_of_the_file(folder, monkeypatch, order, off, found):
    """Moved, or in another order."""
    faces = [(name, vertices + np.array([off, 0, 0])) for name, vertices in named_faces(folder)]
    monkeypatch.setattr(StepFile, "faces", lambda file: faces[order])
    if found:
        assert len(import_named(folder).tip) == 1
    else:
        refused(MeshError, import_named, folder, match=NOT_AS_IN_FILE)


NOT_AS_IN_FILE = "face (hub|shroud) is not as in the file .* find root and tip by radius_mm"


def named_faces(folder):
    """Faces as the STEP file has them, mm."""
    return StepFile(folder / "blade.step").faces()


def import_named(folder):
    cad = Cad.model_validate({"file": "blade.step", "unit": "mm"} | GROUPS)
    with session("test"):
        return import_cad(cad, folder / "blade.step")


def box(occ, x=0.4, y=-0.02):
    return occ.addBox(x, y, -0.02, 0.1, 0.04, 0.04)


def long_box(occ):
    return occ.addBox(400, 0, 0, 100, 10, 10)


def two_boxes(occ):
    box(occ), box(occ, 0.6)


def faces_of_box(occ):
    tag = box(occ)
    occ.synchronize()
    occ.remove([(3, tag)])
    return [face for _, face in gmsh.model.getEntities(2)]


def open_box(occ):
    first, *faces = faces_of_box(occ)
    occ.addVolume([occ.addSurfaceLoop(faces)])
    occ.remove([(2, first)])


def boxes_sharing_an_edge(occ):
    occ.fragment([(3, box(occ))], [(3, box(occ, 0.5, 0.02))])
    occ.synchronize()
    occ.remove(gmsh.model.getEntities(3))
    occ.addVolume([occ.addSurfaceLoop([face for _, face in gmsh.model.getEntities(2)])])


def written(path, make) -> None:
    with session("test"):
        make(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        gmsh.write(str(path))


def inside_out(path) -> None:
    """A box whose shell within the solid of the BREP file is reversed."""
    written(path, box)
    text, count = re.subn(r"(\nSo\n\n\d+\n)\+", r"\g<1>-", path.read_text())
    assert count == 1
    path.write_text(text)


text = partial(Path.write_text, data="x")


@pytest.mark.parametrize(
    ("name", "unit", "write", "named"),
    [
        ("b.brep", "m", partial(written, make=two_boxes), "2 solids of 0.00016, 0.00016 m3"),
        ("b.brep", "m", partial(written, make=faces_of_box), "6 faces"),
        ("b.brep", "m", partial(written, make=open_box), "the solid is open: 1 face(s)"),
        ("b.brep", "m", partial(written, make=boxes_sharing_an_edge), "non-manifold: 4 face(s)"),
        (
            "b.brep",
            "m",
            partial(written, make=long_box),
            "100 m long with unit: m; allowed 0.001 to 5 m: choose another",
        ),
        ("b.step", "mm", partial(written, make=long_box), "declares mm: export it anew"),
        ("b.brep", "m", inside_out, "-0.00016 m3"),
        ("b.igs", "mm", text, ".step, .stp, .brep"),
        ("b.step", "mm", text, "ISO-10303-21"),
        ("b.brep", "m", text, "0 faces"),
        ("b.brep", "mm", text, "cannot be read as .brep"),
    ],
)
def test_cad_that_is_no_solid_of_its_unit_is_refused(
    coarse_blade, tmp_path, name, unit, write, named
):
    write(tmp_path / name)
    assert named in refused_build(coarse_blade, tmp_path / name, unit=unit).text


def refused_build(blade: Blade, path, **settings) -> MeshError:
    error = refused(MeshError, build, blade, path, path.parent, **settings)
    assert error.file == path.name
    assert not (path.parent / "blade.msh").exists()
    return error


def test_a_seam_and_a_pole_are_not_open_edges(coarse_blade, tmp_path):
    """The seam of a cylinder bounds one face twice; both solids pass the check."""
    for make in (
        lambda occ: occ.addCylinder(0.5, 0, 0, 0.1, 0, 0, 0.02),
        lambda occ: occ.addSphere(0.5, 0, 0, 0.05),
    ):
        written(tmp_path / "b.brep", make)
        assert refused_build(coarse_blade, tmp_path / "b.brep").value == 422.5


@pytest.mark.parametrize(
    ("name", "settings", "key", "value", "named"),
    [
        ("blade.brep", {"unit": "mm"}, "", None, "0.00014 m long"),
        ("blade.step", {"unit": "cm"}, "", None, "declares the unit mm"),
        ("blade.brep", {"frame": {"radial": "-x"}}, "", None, "-180 degrees"),
        ("blade.brep", {"frame": {"rotation": "left-handed"}}, "", None, "frame.rotation"),
        ("blade.brep", {"frame": {"downstream": "-z"}}, "", None, "hollow side"),
        ("blade.brep", {"root": {"radius_mm": 400}}, "cad.root.radius_mm", 400, "422.4"),
        ("blade.brep", {"tip": {"radius_mm": 600}}, "cad.tip.radius_mm", 600, "562.4"),
        ("blade.brep", {"root": {"radius_mm": 563}}, "", None, "in common"),
        (
            "blade.step",
            {"unit": "mm", "root": {"group": "foot"}},
            "cad.root.group",
            "foot",
            "hub, shroud",
        ),
        ("blade.brep", {"root": {"group": "foot"}}, "cad.root.group", "foot", "radius_mm"),
    ],
)
def test_wrong_settings_of_a_cad_file_are_refused(
    coarse_blade, folder, name, settings, key, value, named
):
    error = refused_build(coarse_blade, folder / name, **settings)
    assert (error.key, error.value) == (key, value)
    assert named in error.text


SI = "#1 = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT({},.METRE.) );\n"
INCH = """#2 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#1);
#3 = ( CONVERSION_BASED_UNIT('INCH',#2)
LENGTH_UNIT() NAMED_UNIT(#4) );
"""
ANGLE = "#9 = ( CONVERSION_BASED_UNIT('DEGREE',#8) NAMED_UNIT(#7) PLANE_ANGLE_UNIT() );\n"


@pytest.mark.parametrize(
    ("text", "units"),
    [
        (SI.format("$"), {"m"}),
        (SI.format(".MILLI.") + ANGLE, {"mm"}),
        (SI.format(".MILLI.") + INCH, {"in"}),  # the inch is told in mm
        (SI.format(".MICRO."), {".MICRO.METRE"}),
        (ANGLE, set()),
    ],
)
def test_declared_unit(tmp_path, text, units):
    (tmp_path / "a.step").write_text(f"ISO-10303-21;\n{text}END-ISO-10303-21;\n")
    assert StepFile(tmp_path / "a.step").units == units
