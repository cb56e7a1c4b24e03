"""Blades from tables of section coordinates: against the parameters, and invalid tables."""

import meshio
import numpy as np
import pytest
from blades import camber_line, first_frequency, given, height, nodes_of, on_tip
from refused import refused

from geometry.base import MeshWarning
from geometry.blade import SectionTable
from geometry.mesh import MeshError, build_mesh
from geometry.profile import profile_at
from geometry.section_table import read_sections

CUT = 0.01  # of the chord
FRACTIONS = np.linspace(0, 1, 5)  # of the span
STATIONS = (1 - np.cos(np.linspace(0, np.pi, 41))) / 2


def side(sections, fraction, sign):
    """One side of a section of the reference blade, on the cylinder at a span fraction."""
    radius = sections.hub_radius + fraction * sections.span
    return np.array([on_tip(sections, xi, sign, radius) for xi in STATIONS])


@pytest.fixture(scope="module")
def outlines(coarse_blade):
    """Outlines of the reference blade, closed, hub to tip, m."""
    s = coarse_blade.sections
    return [np.vstack([side(s, f, +1), side(s, f, -1)[::-1]]) for f in FRACTIONS]


def rows(outlines, scale=1e3, axes=(0, 1, 2), digits=4):
    lines = ["# a comment", "section,x,y,z"]
    for name, outline in enumerate(outlines, start=1):
        for point in outline[:, axes] * scale:
            lines.append(f"{name}," + ",".join(f"{value:.{digits}f}" for value in point))
    return lines


def build(blade, lines, folder, **settings):
    """Mesh of the blade of a table; returns the summary and the file."""
    (folder / "table.csv").write_text("\n".join(lines) + "\n")
    table = {"file": "table.csv", "unit": "mm", "edge_cut_percent": 100 * CUT} | settings
    mesh = folder / "blade.msh"
    return build_mesh(given(blade, section_table=table), mesh, folder / "table.csv"), mesh


@pytest.fixture(scope="module")
def built(coarse_blade, outlines, tmp_path_factory):
    return build(coarse_blade, rows(outlines), tmp_path_factory.mktemp("table"))


def test_volume_is_that_of_the_parameters_less_the_cut_edges(built, coarse_mesh, coarse_blade):
    e, x = coarse_blade.sections.edge_thickness_percent / 100, CUT
    ends = 2 * (e * x + (1 - e) * (2 * x**2 - 4 / 3 * x**3))
    kept = 1 - ends / (e + (1 - e) * 2 / 3)
    assert kept == pytest.approx(0.9929, abs=1e-4)  # in closed form, alike in every section
    # the cuts are normal to the diagonal of the outline; measured 1.0e-4
    assert built[0].volume == pytest.approx(kept * coarse_mesh.summary.volume, rel=2e-4)


def test_first_frequency_is_that_of_the_parameters_but_for_the_cut(
    built, coarse_blade, coarse_mesh
):
    ratio = first_frequency(coarse_blade, built[1]) / first_frequency(
        coarse_blade, coarse_mesh.mesh
    )
    # the cambered section loses its ends, which stiffen it most: measured -0.17 % on these meshes
    assert ratio == pytest.approx(0.9983, abs=5e-4)


def test_root_tip_and_camber_line_lie_on_the_first_and_last_section(built, coarse_blade):
    s = coarse_blade.sections
    mesh = meshio.read(built[1])
    # both faces are straight from side to side: they sag t^2/8r below the cylinder, 9 um at the hub
    for group, radius in (("root", s.hub_radius), ("tip", s.tip_radius)):
        points = nodes_of(mesh, group)
        off = np.hypot(points[:, 0], points[:, 1]) - radius
        assert len(points) > 30
        assert off.min() > -2e-5 and off.max() < 2e-5
    line = camber_line(built[1])
    assert np.all(np.diff(line[:, 2]) > 0) and np.all(np.diff(line[:, 1]) < 0)
    profile = profile_at(s, s.tip_radius)  # its plane is 0.5 mm out at most, and 3 % of that in y
    xi = CUT + (1 - 2 * CUT) * np.linspace(0, 1, len(line))
    expected = profile.place(xi, height(profile, xi, 0))
    np.testing.assert_allclose(line[:, 1:], expected[:, 1:], atol=1e-4)


def test_sides_run_from_the_leading_edge_and_the_pressure_side_is_ahead(outlines, tmp_path):
    (tmp_path / "t.csv").write_text("\n".join(rows(outlines)))
    table = SectionTable(file="t.csv", unit="mm", edge_cut_percent=100 * CUT)
    for section in read_sections(table, tmp_path / "t.csv"):
        assert section.suction[0, 2] < section.suction[-1, 2]
        assert np.all(section.pressure[:, 1] > section.suction[:, 1])


def test_axes_unit_and_order_of_a_table_do_not_matter(built, coarse_blade, outlines, tmp_path):
    """The engine axis along -x of the file, the radius along y; tip first, the other way round.

    Every outline begins elsewhere.
    """
    turned = [np.roll(o[::-1] * [1, 1, -1], 25 * i, axis=0) for i, o in enumerate(outlines[::-1])]
    frame = {"downstream": "-x", "radial": "y", "rotation": "left-handed"}
    lines = rows(turned, scale=1e2, axes=(2, 0, 1), digits=5)
    summary, mesh = build(coarse_blade, lines, tmp_path, unit="cm", frame=frame)
    assert summary.volume == pytest.approx(built[0].volume, rel=1e-6)  # rounded to 0.1 um both
    np.testing.assert_allclose(camber_line(mesh), camber_line(built[1]), atol=1e-6)


def move_point(rows, i, axis, far):
    name, *place = rows[i].split(",")
    place[axis] = f"{float(place[axis]) + far:.4f}"
    rows[i] = ",".join([name, *place])


def move_section(rows, name, axis, far):
    for i, row in enumerate(rows):
        if row.startswith(f"{name},"):
            move_point(rows, i, axis, far)


def swap(rows, i, j):
    rows[i], rows[j] = rows[j], rows[i]


REFUSED = [  # with what the message names, by line and section
    (lambda rows: rows.__setitem__(5, "1,2,three,4"), {}, 6, "", "'three'"),
    (lambda rows: rows.__setitem__(5, "1,2,3"), {}, 6, "", "needs x, y, z: found 2 cells"),
    (lambda rows: rows.__setitem__(5, "\x07,2,3,4"), {}, 6, "", r"section '\x07'"),
    (lambda rows: rows.__setitem__(5, "1,2,nan,4"), {}, 6, "", "'nan'"),
    (lambda rows: rows.pop(1), {}, 2, "", "section,x,y,z"),
    (lambda rows: rows.clear(), {}, 1, "", "section,x,y,z"),
    (lambda rows: rows.__delitem__(slice(40, None)), {}, None, "", "needs two or more"),
    (lambda rows: rows.__delitem__(slice(10, 84)), {}, None, "", "section 1 has 8 points"),
    (lambda rows: swap(rows, 12, 30), {}, None, "section 1", "folds back"),
    (lambda rows: move_section(rows, "2", 0, 35), {}, None, "", "section 3 lies"),
    (lambda rows: move_section(rows, "2", 0, 60), {}, None, "", "section 3 lies inside section 2"),
    (lambda rows: None, {"unit": "m"}, None, "", "140 m long"),
    (lambda rows: None, {"frame": {"radial": "y"}}, None, "", "frame.radial y"),
    (lambda rows: None, {"frame": {"downstream": "-z"}}, None, "", "hollow side"),
    (lambda rows: None, {"frame": {"rotation": "left-handed"}}, None, "", "frame.rotation"),
    # each blamed the size of the elements before
    (lambda rows: move_point(rows, 22, 1, 3), {}, None, "section 1", "point 21 of 82"),
    (lambda rows: move_point(rows, 22, 0, 3), {}, None, "section 1", "point 21 of 82"),
    (lambda rows: move_section(rows, "2", 1, 40), {}, None, "section 2", "an edge lies"),
    (lambda rows: move_section(rows, "5", 2, 40), {}, None, "section 5", "an edge lies"),
    (lambda rows: move_section(rows, "1", 1, -40), {}, None, "section 1", "an edge lies"),
    (lambda rows: rows.__delitem__(slice(300, None)), {}, None, "section 4", "a gap of"),
    (lambda rows: rows.__delitem__(slice(43, 84)), {}, None, "section 1", "a gap of"),
    (lambda rows: rows.__delitem__(slice(20, 50)), {}, None, "section 1", "after its point 18 of"),
]


@pytest.mark.parametrize(("spoil", "settings", "line", "section", "named"), REFUSED)
def test_table_that_is_no_blade_is_refused(
    coarse_blade, outlines, tmp_path, monkeypatch, spoil, settings, line, section, named
):
    monkeypatch.chdir(tmp_path)  # of files of other folders the errors say nothing
    lines = rows(outlines)
    spoil(lines)
    error = refused(MeshError, build, coarse_blade, lines, tmp_path, **settings)
    assert (error.file, error.line, error.key) == ("table.csv", line, section)
    assert named in error.text and "element_size" not in error.text
    assert [path.name for path in tmp_path.iterdir()] == ["table.csv"]


def test_three_sections_out_of_line_cannot_be_told_apart(coarse_blade, outlines, tmp_path):
    lines = rows(outlines[::2])
    move_section(lines, "3", 1, 40)
    assert (
        refused(MeshError, build, coarse_blade, lines, tmp_path).key
        == "one of section 1 to section 3"
    )


def test_other_ways_of_writing_are_the_same_blade(coarse_blade, outlines, tmp_path):
    """With a byte-order mark, tip first, and in the numbers of Fortran."""
    table = SectionTable.model_validate({"file": "t.csv", "unit": "mm", "edge_cut_percent": 1})
    path, lines = tmp_path / "t.csv", rows(outlines)
    path.write_text("\n".join(lines))
    expected = read_sections(table, path)
    fortran = [
        ",".join([row.split(",")[0], *(f"{float(x) / 10!r}D+01" for x in row.split(",")[1:])])
        for row in lines[2:]
    ]
    for other in (lines, [*lines[:2], *lines[:1:-1]], [*lines[:2], *fortran]):
        path.write_text("\n".join(other), encoding="utf-8-sig")
        for one, same in zip(expected, read_sections(table, path), strict=True):
            np.testing.assert_allclose(one.suction, same.suction, atol=1e-12)
            np.testing.assert_allclose(one.pressure, same.pressure, atol=1e-12)


def test_section_whose_sides_cross_is_refused(coarse_blade, outlines, tmp_path):
    crossed = [outline.copy() for outline in outlines]
    crossed[2][:41, 1] += 0.008 * np.exp(
        -(((np.arange(41) - 20) / 6) ** 2)
    )  # the suction side comes out of the pressure side
    assert refused(MeshError, build, coarse_blade, rows(crossed), tmp_path).key == "section 3"


def test_columns_of_radius_angle_and_z_are_told(coarse_blade, outlines, tmp_path):
    """In degrees they make a blade of another thickness and stagger; in radians a sheet."""
    polar = []
    for x, y, z in map(np.transpose, outlines):
        angle = np.degrees(np.arctan2(y, x))
        polar.append(np.column_stack([1e3 * np.hypot(x, y), angle, 1e3 * z]))
    with pytest.warns(MeshWarning, match="a radius, an angle and z, give x, y, z"):
        build(coarse_blade, rows(polar, scale=1), tmp_path)
    radians = [points * [1, np.pi / 180, 1] for points in polar]
    error = refused(MeshError, build, coarse_blade, rows(radians, scale=1, digits=6), tmp_path)
    assert "% of its chord thick" in error.text and "x, y, z, all in one unit" in error.text
