"""Meshes of other programs: nodes, cells and groups, and one-line errors for invalid files."""

import re
from contextlib import nullcontext

import exports
import gmsh
import meshio
import numpy as np
import pytest
from exports import MIRRORED, as_meshed, same_facets
from refused import refused

from geometry.blade import Blade
from geometry.errors import MeshError, MeshWarning
from geometry.mesh import build_mesh
from geometry.settings import check_settings
from geometry.shape import session
from geometry.tetrahedra import FACETS, GMSH


def deck(parts, *cards):
    """Our mesh as a deck without sets, then ``cards``."""

    def write(path):
        exports.write_inp(path, parts.points, parts.cells, {})
        path.write_text(path.read_text() + "\n".join(cards) + "\n")

    return write


def nset(name, group):
    return f"*nset, nset={name}\n" + "\n".join(f"{i + 1}," for i in np.unique(group))


def own_sides(parts, name):
    """Lines 'element, side' of a surface: a side is known by the corner it lacks, 4 3 1 2."""
    sides = {}
    for element, cell in enumerate(parts.cells[:, :4].tolist(), 1):
        for side, lacks in zip("1234", (3, 2, 0, 1), strict=True):
            sides[tuple(sorted(set(cell) - {cell[lacks]}))] = f"{element}, S{side}"
    return [sides[tuple(sorted(facet))] for facet in parts.facets[name][:, :3].tolist()]


def shells(parts, kind, first=10_001, elset=True):
    """One card of shell elements for each group."""
    lines = []
    for name, facets in parts.facets.items():
        lines.append(f"*Element, type={kind}" + (f", elset={name}" if elset else ""))
        for facet in facets[:, : 3 if kind == "S3" else 6] + 1:
            lines.append(", ".join(map(str, [first, *facet])))
            first += 1
    return lines


def numbers(error):
    """All numbers of a message."""
    return [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?", error.text)]


GROUPS = {
    "node sets": lambda p: [nset(name, group) for name, group in p.facets.items()],
    # meshio takes the set of the first card that names one for the first card, the solids
    "shells of gmsh": lambda p: shells(p, "CPS6"),
    "shells of three nodes": lambda p: shells(p, "S3"),
    "surface of sides": lambda p: [
        line
        for name in p.facets
        for line in (f"*SURFACE, TYPE=ELEMENT, NAME={name}", *own_sides(p, name))
    ],
    "surface of nodes": lambda p: [
        line
        for name, group in p.facets.items()
        for line in (nset(f"n{name}", group), f"*Surface, name={name}, type=node", f"n{name}, 1.")
    ],
    "sets of sets, in two cards": lambda p: [
        nset("tip", p.facets["tip"]),
        nset("a", p.facets["root"][:9]),
        nset("root", p.facets["root"][9:]),
        "*nset, nset=root\na,",
    ],
    "elements by numbers": lambda p: [
        *shells(p, "STRI65", elset=False),
        f"*ELSET, ELSET=root, GENERATE\n10001, {10_000 + len(p.facets['root'])}, 1",
        f"*ELSET, ELSET=tip, GENERATE\n{10_001 + len(p.facets['root'])}, "
        f"{10_000 + len(p.facets['root']) + len(p.facets['tip'])}",
    ],
}


@pytest.mark.parametrize("how", GROUPS)
def test_groups_of_a_deck(how, parts, build):
    _, found = build("blade.inp", deck(parts, *GROUPS[how](parts)))
    assert same_facets(found, parts)


def test_mesh_of_a_deck_with_two_node_cards(parts, build):
    """The second *NODE card has a node that only a spring uses; it and the spring are left out."""
    cards = "*NODE\n99999, 0., 0., 1e9\n** a comment\n"
    cards += "*ELEMENT, TYPE=SPRINGA, ELSET=Spring\n88888, 99999, 1\n*BOUNDARY\nroot, 1, 3\n"
    write = deck(parts, *GROUPS["node sets"](parts), cards)
    summary, found = build("blade.inp", write, root="root", tip="Tip")  # a deck has no case
    assert summary.nodes == len(parts.points)
    assert same_facets(found, parts)


FORMATS = {
    "blade.cdb": (exports.write_cdb, "ROOT", "tip"),
    "blade.bdf": (exports.write_bdf, "nastran:ref=2", "nastran:ref=3"),
    "blade.msh": (exports.write_msh, "root", "tip"),
    "blade.vtu": (exports.write_vtu, "root", "tip"),
}


@pytest.mark.parametrize("file", FORMATS)
def test_groups_of_the_other_formats(file, parts, build):
    write, root, tip = FORMATS[file]
    _, found = build(file, write, *parts, root=root, tip=tip)
    assert same_facets(found, parts)


def test_groups_by_value_of_cell_data(parts, build):
    def write(path):
        blocks = [("tetra10", parts.cells), *(("triangle6", f) for f in parts.facets.values())]
        values = [np.full(len(data), i) for i, (_, data) in enumerate(blocks)]
        meshio.Mesh(parts.points, blocks, cell_data={"entity": values}).write(path)

    _, found = build("blade.vtu", write, root="entity=1", tip="entity=2")
    assert same_facets(found, parts)


def test_groups_by_radius(parts, build):
    _, found = build("blade.inp", deck(parts), root=422.4, tip=562.4)
    assert same_facets(found, parts)


def test_written_mesh_is_the_blade_with_groups_and_no_points(parts, build, coarse_mesh):
    summary, found = build("blade.inp", exports.write_inp, *parts)
    assert summary.volume == pytest.approx(coarse_mesh.summary.volume, rel=1e-12)
    assert summary.smallest_jacobian == pytest.approx(coarse_mesh.summary.smallest_jacobian)
    assert (summary.nodes, summary.cells) == (len(parts.points), len(parts.cells))
    assert summary.cad_volume is None
    np.testing.assert_allclose(found.points, parts.points, rtol=1e-15)  # mm to m and back
    np.testing.assert_array_equal(found.cells, parts.cells)


def test_facets_of_the_root_are_exterior(parts, build):
    """A node set with all nodes: all facets of the surface, none between cells."""
    every = {"root": parts.cells, "tip": parts.facets["tip"]}
    refused(
        MeshError,
        build,
        "blade.inp",
        exports.write_inp,
        parts.points,
        parts.cells,
        every,
        match=f"root and tip share {len(every['tip'])} facets",
    )


def test_too_many_patches_are_refused(parts, refusal):
    error = refusal("blade.inp", exports.write_inp, *parts, interface={"patches": 60})
    assert (error.key, error.value) == ("interface.patches", 60)


def test_cells_inside_out(parts, refusal):
    cells = parts.cells.copy()
    cells[[5, 70]] = cells[[5, 70]][:, MIRRORED]
    error = refusal("blade.inp", exports.write_inp, *parts._replace(cells=cells))
    middle = parts.points[parts.cells[[5, 70], :4]].mean(axis=1)
    assert numbers(error)[:3] == [2, len(cells), -1.00]
    assert any("at {:.1f}, {:.1f}, {:.1f} mm".format(*at) in error.text for at in middle)


def test_cell_folded_by_a_middle_node(parts, refusal):
    """The corners are sound: only the curved cell is inside out somewhere."""
    points = parts.points.copy()
    a, b, middle = parts.cells[5, [0, 1, 4]]
    points[middle] = points[a] + 0.1 * (points[b] - points[a])
    error = refusal("blade.inp", exports.write_inp, *parts._replace(points=points))
    assert -1 < numbers(error)[2] < 0


@pytest.mark.parametrize(
    ("root", "key", "value"),
    [
        ("hub", "root.group", "hub"),
        ("EALL", "root.group", "EALL"),
        (300.0, "root.radius_mm", 300.0),
    ],
)
def test_root_that_is_not_there(root, key, value, parts, refusal):
    error = refusal("blade.inp", exports.write_inp, *parts, root=root)
    assert (error.key, error.value) == (key, value)


def test_root_that_is_empty(parts, refusal):
    groups = parts.facets | {"root": parts.facets["root"][:, :3]}  # corners only
    error = refusal("blade.inp", exports.write_inp, parts.points, parts.cells, groups)
    assert (error.key, error.value) == ("root.group", "ROOT")


def test_root_that_reaches_up_the_blade_is_warned_of(parts, build):
    """Skin clamped to 500 mm: 77.6 mm of 140; the span of its facets is at the mesh's nodes."""
    with pytest.warns(
        MeshWarning, match=r"clamped from radius 422\.4 to (4[5-9]\d|500).* mm, \d+ %"
    ):
        build("blade.inp", exports.write_inp, *parts, root=500.0)


@pytest.mark.parametrize("warns", [False, True])
def test_root_that_reaches_up_a_fifth_of_the_blade_is_warned_of(warns, parts, build):
    """A fall of 30 (40) mm is 18 (22) % of the blade: the hub does not reach to the tip's ends."""
    write = (exports.write_inp, *exports.oblique(parts, 40.0 if warns else 30.0))
    expect = pytest.warns(MeshWarning, match="2[1-4] % of the blade") if warns else nullcontext()
    with expect:
        build("blade.inp", *write)


def test_root_and_tip_exchanged(parts, refusal):
    error = refusal("blade.inp", exports.write_inp, *parts, root="TIP", tip="ROOT")
    assert numbers(error)[:2] == [562.4, 422.4]


def test_shells_with_nodes_of_their_own(parts, refusal):
    def write(path):
        own = np.vstack([parts.points, parts.points])
        facets = {name: facet + len(parts.points) for name, facet in parts.facets.items()}
        exports.write_msh(path, own, parts.cells, facets)

    count = len(parts.facets["root"])
    error = refusal("blade.msh", write, root="root", tip="tip")
    assert (error.key, error.value, numbers(error)) == ("root.group", "root", [count, count])


def test_two_blades(parts, refusal):
    points = np.vstack([parts.points, parts.points + np.array([0, 200, 0])])
    lower = parts.cells[parts.points[parts.cells, 0].max(axis=1) < 540]  # without its tip
    cells = np.vstack([parts.cells, lower + len(parts.points)])
    error = refusal("blade.inp", exports.write_inp, points, cells, parts.facets)
    assert numbers(error)[:3] == [2, len(parts.cells), len(lower)]


def test_cells_that_stand_twice(parts, refusal):
    cells = np.vstack([parts.cells, parts.cells[:1]])
    error = refusal("blade.inp", exports.write_inp, *parts._replace(cells=cells))
    assert "facets belong to more than two cells" in error.text


def test_edges_torn_at_their_middle(parts, refusal):
    """One cell has a middle node of its own where its neighbours have another."""
    points = np.vstack([parts.points, parts.points[parts.cells[5, 4]]])
    cells = parts.cells.copy()
    cells[5, 4] = len(parts.points)
    error = refusal("blade.inp", exports.write_inp, points, cells, parts.facets)
    assert error.text.startswith("1 edges have two middle nodes")


def test_surface_that_touches_itself(parts, refusal):
    """Of the cells around an inner edge only two are left, which face each other across it."""
    corners = [set(cell) for cell in parts.cells[:, :4].tolist()]
    i, j, edge = next(
        (i, j, a & b)
        for i, a in enumerate(corners)
        for j, b in enumerate(corners[:i])
        if len(a & b) == 2 and sum((a & b) <= c for c in corners) >= 5
    )
    kept = [n for n, c in enumerate(corners) if n in (i, j) or not edge <= c]
    error = refusal("blade.inp", exports.write_inp, *parts._replace(cells=parts.cells[kept]))
    assert "not manifold" in error.text


def test_other_cells_are_named_and_counted(parts, refusal, tmp_path):
    hexahedra = "*ELEMENT, TYPE=C3D8R\n" + "\n".join(
        ", ".join(map(str, [50_000 + i, *range(1, 9)])) for i in range(3)
    )
    wedge = "*ELEMENT, TYPE=C3D6\n60000, 1, 2, 3, 4, 5, 6"
    assert "1 C3D6, 3 C3D8R" in refusal("blade.inp", deck(parts, hexahedra, wedge)).text
    meshio.Mesh(parts.points, [("hexahedron", [range(8)])]).write(tmp_path / "b.vtu")
    assert "1 hexahedron" in refusal("b.vtu").text


@pytest.mark.parametrize(
    ("card", "line", "named"),
    [
        ("*Include, input=mesh.inc", None, "*INCLUDE"),
        ("*NGEN\n1, 2", None, "*NGEN"),
        ("*PART, NAME=a\n*PART, NAME=b", None, "several parts"),
        ("*INSTANCE, NAME=a, PART=b\n0., 0., 1.", None, "moved instance"),
        ("*ELEMENT, TYPE=SC8R\n1,2", 0, "SC8R"),
        ("*ELEMENT, TYPE=C3D4\n70000, 1, 2, 3, 5", None, "mixes 1 four-node"),
        ("*ELEMENT, TYPE=C3D4\n70000, 1, 2, 3", 1, "70000 has 3 of the 4 nodes"),
        ("*ELEMENT, TYPE=C3D4\n70000, 1, 2, 3, 4, 5", 1, "70000 has more than the 4 nodes"),
        ("*ELEMENT, TYPE=C3D4\n70000, 1, 2, 3, 99999", None, "99999"),
        ("*ELEMENT, TYPE=C3D4\n7e4, 1, 2, 3, 4", 1, "'7e4'"),
        ("*ELEMENT\n7, 1, 2, 3, 4", 0, "TYPE"),
        ("*ELEMENT, TYPE=S3\n1, 1, 2, 3", None, "element 1 is defined twice"),
        ("*NODE\n1, 0., 0., 0.", 1, "node 1 is defined twice"),
        ("*NODE\n9999, 0., 0.", 1, "''"),
        ("*NODE\n9999, 0., 0., 1_0", 1, "'1_0'"),
        ("*NSET, NSET=A\nB", 1, "'B'"),
        ("*NSET, NSET=A, GENERATE\n1, 9, 0", 1, "generated set"),
    ],
)
def test_deck_that_is_not_read(card, line, named, parts, refusal):
    error = refusal("blade.inp", deck(parts, card))
    card_line = 3 + len(parts.points) + len(parts.cells)
    assert error.line == (None if line is None else card_line + line)
    assert named in error.text


@pytest.mark.parametrize(
    ("file", "text", "named"),
    [
        ("blade.stl", "", ".stl: known are .inp, .cdb, .bdf, .nas, .fem, .msh, .vtu"),
        ("blade", "", "missing"),
        ("blade.inp", "", "no tetrahedra"),
        ("blade.bdf", "GRID", "ENDDATA"),
        ("blade.msh", "a", "$Elements"),
        ("blade.msh", "*NODE\n", ".inp"),
        ("blade.vtu", "<a", ".vtu"),
    ],
)
def test_file_that_is_not_read(file, text, named, refusal, tmp_path):
    (tmp_path / file).write_text(text)
    assert named in refusal(file).text


def test_numbers_of_fortran(parts, build):
    """In decks of Abaqus, small letters too, and of Nastran, where meshio reads none."""

    def write(path):
        exports.write_inp(path, *parts)
        nodes, rest = path.read_text().split("*ELEMENT")
        head, *rows = nodes.strip().split("\n")
        rows = [row.split(",") for row in rows]
        rows = [
            ",".join([n, *(f"{float(x):.16e}".replace("e", "d") for x in place)])
            for n, *place in rows
        ]
        path.write_text("\n".join([head, *rows, f"*ELEMENT{rest}"]))

    def write_bulk(path):
        exports.write_bdf(path, *parts)
        x = f"{parts.points[0, 0]:.13f}"[:16]
        path.write_text(path.read_text().replace(f"{x:>16}", f"{float(x):16.9E}".replace("E", "D")))

    plain, fortran = build("a.inp", exports.write_inp, *parts)[0], build("b.inp", write)[0]
    assert fortran.volume == pytest.approx(plain.volume, rel=1e-12)
    groups = {"root": "nastran:ref=2", "tip": "nastran:ref=3"}
    bulk = build("b.bdf", write_bulk, **groups)[0]
    assert bulk.volume == pytest.approx(plain.volume, rel=1e-7)  # ten digits of one coordinate


def test_node_of_nastran_that_is_defined_twice(parts, refusal):
    def write(path):
        exports.write_bdf(path, *parts)
        path.write_text(path.read_text().replace(f"GRID*   {2:16d}", f"GRID*   {1:16d}"))

    assert refusal("b.bdf", write).line == 4


def test_node_moved_out_of_the_surface(parts, refusal):
    """By 50 mm: its cells are stretched, and none is inside out."""
    points, corner = parts.points.copy(), parts.facets["tip"][0, 0]
    points[corner, 0] += 50
    error = refusal("b.inp", exports.write_inp, points, parts.cells, parts.facets)
    assert error.text.endswith("(allowed 4): correct its coordinates")


@pytest.fixture
def bent(parts):
    """Points of the mesh with an edge of the root bent by a share of its length."""

    def bent(share):
        a, b, middle = parts.facets["root"][0, [0, 1, 3]]
        points = parts.points.copy()
        points[middle, 0] -= share * np.linalg.norm(points[b] - points[a])
        return points

    return bent


def test_edge_that_is_bent_as_an_arc(parts, build, bent):
    build("b.inp", exports.write_inp, bent(0.3), parts.cells, parts.facets)


def test_middle_node_moved_out_of_the_surface(parts, refusal, bent):
    """Its cells grow and none is inside out: no Jacobian tells."""
    error = refusal("b.inp", exports.write_inp, bent(3.3), parts.cells, parts.facets)
    assert numbers(error)[-2:] == [3.3, 0.5]


def test_set_of_the_tip_that_is_cut_short(parts, refusal):
    def write(path):
        exports.write_inp(path, *parts)
        path.write_text(path.read_text().rstrip("\n").rpartition("\n")[0])

    assert refusal("b.inp", write).key == "tip.group"


def test_tip_without_its_middle(parts, refusal):
    tip = parts.facets["tip"]
    z = parts.points[tip[:, :3], 2].mean(axis=1)
    halves = tip[(z < np.quantile(z, 0.3)) | (z > np.quantile(z, 0.7))]
    parts = parts._replace(facets=parts.facets | {"tip": halves})
    assert refusal("b.inp", exports.write_inp, *parts).key == "tip.group"


def test_tip_without_its_last_facet(parts, refusal):
    tip = parts.facets["tip"]
    less = parts.points[tip[:, :3], 2].mean(axis=1).argsort()[:-1]
    parts = parts._replace(facets=parts.facets | {"tip": tip[less]})
    groups = {"root": "nastran:ref=2", "tip": "nastran:ref=3"}
    assert refusal("b.bdf", exports.write_bdf, *parts, **groups).key == "tip.group"


def test_tip_by_a_radius_that_is_too_close(parts, refusal):
    """Of a tip that rises downstream, the radius takes a part."""
    points = parts.points.copy()
    share = (points[:, 2] - points[:, 2].min()) / np.ptp(points[:, 2])
    points[:, 0] += 4 * share * (points[:, 0] - 422) / 140
    error = refusal("b.inp", exports.write_inp, points, parts.cells, parts.facets, tip=564.0)
    assert error.key == "tip.radius_mm"


def test_deck_without_its_last_elements(parts, refusal):
    """With root and tip by radius nothing else misses them."""
    order = np.argsort(-parts.points[parts.cells[:, :4], 0].mean(axis=1))
    kept = parts.cells[np.sort(order[:-200])]
    lower = np.hypot(*parts.points[np.unique(kept), :2].T).min()
    error = refusal("b.inp", exports.write_inp, parts.points, kept, {}, root=lower + 9, tip=562.3)
    assert "belong to no tetrahedron" in error.text


def test_file_that_is_missing(refusal):
    assert str(refusal("none.inp")) == "none.inp: there is no such file"


def test_coordinate_systems_of_nastran(parts, refusal):
    def write(path):
        exports.write_bdf(path, *parts)
        text = path.read_text()
        first = "GRID*   " + f"{1:16d}"
        path.write_text(text.replace(first + " " * 16, first + f"{7:16d}"))

    assert refusal("blade.bdf", write).line == 2


def test_slip_of_the_unit(parts, refusal):
    error = refusal("blade.inp", exports.write_inp, *parts, unit="m")
    assert numbers(error)[1:] == [0.001, 5]


def test_a_wrong_unit_within_the_lengths_allowed_is_detected_by_the_speed(parts, refusal):
    """Ten times too large: 1.4 m long, at a radius of 5.6 m."""
    error = refusal("blade.inp", exports.write_inp, *parts, unit="cm")
    assert (error.key, error.value) == ("max_speed_rad_s", 650)
    assert error.allowed["le"] == pytest.approx(1000 / 5.624)


def test_blade_that_stands_the_other_way(parts, refusal):
    error = refusal("blade.inp", exports.write_inp, *parts, frame={"radial": "-x"})
    assert error.text.endswith("choose frame.radial: x")


def test_blade_with_its_leading_edge_downstream(parts, refusal):
    """Seen against the engine axis, or against the rotation, the leading edge is behind."""
    frame = {"rotation": "left-handed"}
    error = refusal("blade.inp", exports.write_inp, *parts, frame=frame)
    assert error.text.endswith("check frame.downstream and frame.rotation")


HALF_TURN = {"downstream": "-z"}  # right-handed still: upstream is downstream, ahead is behind


def test_blade_turned_by_half_about_its_radius(parts, refusal):
    """Its trailing edge is upstream and ahead: only the concave side of the tip shows it."""
    error = refusal("blade.inp", exports.write_inp, *parts, frame=HALF_TURN)
    assert error.text.startswith("the hollow side of the tip is behind")


def test_a_reversed_tip_without_camber_is_not_detected(tmp_path, coarse_blade):
    """As geometry/README.md says."""
    straight = coarse_blade.model_dump(exclude_unset=True)
    straight["sections"]["tip"]["camber_percent"] = 0
    straight = check_settings(Blade, straight, "test")
    build_mesh(straight, tmp_path / "own.msh")
    exports.write_inp(tmp_path / "b.inp", *exports.parts(tmp_path / "own.msh"))
    blade = as_meshed(coarse_blade, "b.inp", frame=HALF_TURN)
    build_mesh(blade, tmp_path / "b.msh", tmp_path / "b.inp")


@pytest.fixture
def cut(parts):
    """The mesh with nodes of its own on one side of a part of a cross-section, and their pairs."""

    def cut(share):
        upper = parts.points[parts.cells[:, :4], 0].mean(axis=1) > 490
        facets = parts.cells[:, FACETS]
        keys = np.sort(facets[..., :3], axis=2)
        lower = set(map(tuple, keys[~upper].reshape(-1, 3).tolist()))
        meets = [tuple(key) in lower for key in keys[upper].reshape(-1, 3).tolist()]
        between = facets[upper].reshape(-1, 6)[meets]
        z = parts.points[between[:, :3], 2].mean(axis=1)
        torn = z >= np.quantile(z, 1 - share)
        nodes = np.setdiff1d(between[torn], between[~torn])
        own = np.arange(len(parts.points))
        own[nodes] = len(parts.points) + np.arange(len(nodes))
        cells = np.where(upper[:, None], own[parts.cells], parts.cells)
        return np.vstack([parts.points, parts.points[nodes]]), cells

    return cut


@pytest.mark.parametrize("kind", ["C3D4", "C3D10"])
def test_nodes_on_both_sides_of_a_cut(kind, cut, parts, refusal, recwarn):
    points, cells = cut(0.5)
    own = points[len(parts.points) :]
    assert len(own) > 10
    cells = cells if kind == "C3D10" else cells[:, :4]
    write = exports.write_inp, points, cells, parts.facets, kind
    count, *first = numbers(refusal("b.inp", *write, root=422.5, tip=562.3))
    assert kind == "C3D4" or count == len(own)  # of C3D4, middle nodes where edges are
    assert np.abs(own - np.array(first)).max(axis=1).min() < 0.1
    assert len(recwarn) == (kind == "C3D4")


def test_one_corner_that_is_not_merged(parts, refusal):
    """Of one cell at the corner; the surface stays closed."""
    inside = np.setdiff1d(parts.cells[:, :4], np.vstack([*parts.facets.values()]))
    corner = inside[np.argmax(parts.points[inside, 2])]  # on the trailing edge
    cells = parts.cells.copy()
    cell, at = np.argwhere(cells[:, :4] == corner)[0]
    cells[cell, at] = len(parts.points)
    points = np.vstack([parts.points, parts.points[corner]])
    error = refusal("b.inp", exports.write_inp, points, cells, parts.facets)
    assert error.text.startswith("1 pairs of nodes are not merged, the first at ")


def test_middle_nodes_in_the_order_of_gmsh(parts, refusal):
    cells = parts.cells[:, GMSH]
    error = refusal("b.inp", exports.write_inp, *parts._replace(cells=cells))
    assert "gmsh's order" in error.text


@pytest.mark.parametrize("nodes", [4, 10])
def test_flat_mesh(nodes, parts, refusal, recwarn):
    """All Jacobians are zero, and their ratios are no numbers."""
    points = parts.points.copy()
    points[:, 1] = 0.5 * points[:, 2]
    kind = "C3D10" if nodes == 10 else "C3D4"
    write = exports.write_inp, points, parts.cells[:, :nodes], parts.facets, kind
    error = refusal("b.inp", *write, root=422.5, tip=562.3)
    assert "inside out or flat" in error.text
    assert len(recwarn) == (nodes == 4)


def test_cell_with_two_corners_at_one_place(parts, refusal):
    points = parts.points.copy()
    points[parts.cells[5, 1]] = points[parts.cells[5, 0]]
    error = refusal("b.inp", exports.write_inp, points, parts.cells, parts.facets)
    assert "inf times its length" in error.text


@pytest.fixture
def by_gmsh(coarse_mesh, tmp_path):
    """Write our mesh in mm by gmsh itself, after a change of its model; the path."""

    def by_gmsh(version, change=lambda model: None, binary=False):
        with session(""):
            gmsh.merge(str(coarse_mesh.mesh))
            gmsh.model.mesh.affineTransform([1e3, 0, 0, 0, 0, 1e3, 0, 0, 0, 0, 1e3, 0])
            change(gmsh.model)
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            gmsh.option.setNumber("Mesh.Binary", binary)
            gmsh.write(str(tmp_path / "b.msh"))
        return tmp_path / "b.msh"

    return by_gmsh


@pytest.mark.parametrize(("version", "binary"), [(2.2, 0), (2.2, 1), (4.0, 0), (4.1, 0), (4.1, 1)])
def test_versions_of_gmsh(version, binary, by_gmsh, parts, build):
    by_gmsh(version, binary=binary)
    _, found = build("b.msh", root="root", tip="tip")
    assert exports.same_facets(found, parts)


def test_physical_volume_of_the_number_of_the_root(by_gmsh, refusal):
    """Gmsh numbers the groups of each dimension anew."""

    def change(model):
        model.removePhysicalGroups([(3, 1)])
        model.addPhysicalGroup(3, [1], tag=2, name="all")

    by_gmsh(2.2, change)
    error = refusal("b.msh", root="all", tip="tip")
    assert (error.key, error.value) == ("root.group", "all")


def test_group_of_gmsh_without_cells(parts, refusal):
    """With physical numbers 0 and 1 alone, the name of another is not the group of 1."""

    def write(path):
        exports.write_msh(path, *parts)
        text = re.sub(r"^(\d+ (?:9|11) 2) 1 ", r"\1 0 ", path.read_text(), flags=re.MULTILINE)
        text = re.sub(r"^(\d+ 9 2) [23] ", r"\1 1 ", text, flags=re.MULTILINE)
        path.write_text(text)

    error = refusal("b.msh", write, root=422.5, tip="tip")
    assert (error.key, error.value) == ("tip.group", "tip")


@pytest.mark.parametrize("version", [2.2, 4.0, 4.1])
def test_cells_beyond_those_declared(version, by_gmsh, refusal):
    """One cell (MSH 2), or one block of cells (MSH 4), less than are there."""
    path = by_gmsh(version)
    head = re.compile(r"(?<=\$Elements\n)\d+")
    path.write_text(head.sub(lambda found: str(int(found[0]) - 1), path.read_text()))
    held, read = numbers(refusal("b.msh", root=422.5, tip=562.3))
    assert held == 805 and read in (804, 37)


def test_mesh_of_gmsh_without_its_end(by_gmsh, refusal):
    path = by_gmsh(4.1)
    path.write_text(path.read_text().replace("$EndElements\n", ""))
    assert refusal("b.msh", root="root", tip="tip").text.startswith(
        "needs one $Nodes and one $Elements"
    )


def test_two_meshes_of_gmsh_in_one_file(by_gmsh, refusal):
    path = by_gmsh(2.2)
    path.write_text(path.read_text() * 2)
    assert refusal("b.msh", root="root", tip="tip").text.startswith(
        "needs one $Nodes and one $Elements"
    )


def _pieces(text):
    piece = text[text.index("<Piece") : text.index("</UnstructuredGrid>")]
    return text.replace(piece, piece * 2)


VTU = {
    "holds 1536 cells, of which 768 are read": _pieces,
    "holds 768 cells, of which 767 are read": lambda text: re.sub(
        r'(Name="types".*\n)24', r"\g<1>99", text
    ),
    "a tetra10 names a node that does not exist": lambda text: re.sub(
        r'(Name="connectivity".*\n)\d+', r"\1-1", text
    ),
}


@pytest.mark.parametrize("fault", VTU)
def test_cells_of_vtk_that_are_lost(fault, parts, refusal):
    def write(path):
        exports.write_vtu(path, *parts)
        meshio.vtu.write(path, meshio.read(path), binary=False)
        path.write_text(VTU[fault](path.read_text()))

    assert fault in refusal("b.vtu", write, root="root", tip="tip").text
