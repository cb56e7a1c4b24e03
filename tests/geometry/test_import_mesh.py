"""Meshes of other programs: nodes, cells and groups, and one-line errors for invalid files."""

import re
from contextlib import nullcontext

import exports
import gmsh
import meshio
import numpy as np
import pytest
from exports import MIRRORED, as_meshed, same_facets

from geometry.base import RPM, MeshWarning, check_settings
from geometry.blade import Blade
from geometry.mesh import build_mesh
from geometry.shape import session
from geometry.tetrahedra import GMSH


def write_deck(path, parts, *cards):
    """Our mesh as a deck without sets, then ``cards``."""
    exports.write_inp(path, parts.points, parts.cells, {})
    path.write_text(path.read_text() + "\n".join(cards) + "\n")


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


def of_elements(parts):
    """*NSET, ELSET=: of shells, as cgx and gmsh write them; also of a set of sets."""
    return [
        *shells(parts, "CPS6"),
        *("*ELSET, ELSET=again", "root", "*NSET, NSET=clamp, ELSET=again"),
        "*nset,nset=top,elset=tip",
    ]


def by_cell_data(path, parts):
    """Root and tip by the values 1 and 2 of their cells."""
    blocks = [("tetra10", parts.cells), *(("triangle6", f) for f in parts.facets.values())]
    values = [np.full(len(data), i) for i, (_, data) in enumerate(blocks)]
    meshio.Mesh(parts.points, blocks, cell_data={"entity": values}).write(path)


WAYS = {  # suffix, function that writes the parts to a path, root and tip
    **{
        how: (".inp", lambda path, p, cards=cards: write_deck(path, p, *cards(p)), "ROOT", "TIP")
        for how, cards in GROUPS.items()
    },
    **{
        suffix: (suffix, lambda path, parts, write=write: write(path, *parts), *groups)
        for suffix, (write, *groups) in exports.FORMATS.items()
    },
    "value of cell data": (".vtu", by_cell_data, "entity=1", "entity=2"),
    "radius": (".inp", write_deck, 422.4, 562.4),
    "nodes of elements": (
        ".inp",
        lambda path, p: write_deck(path, p, *of_elements(p)),
        "clamp",
        "top",
    ),
}


@pytest.mark.parametrize("how", WAYS)
def test_groups(how, parts, build):
    suffix, write, root, tip = WAYS[how]
    _, found = build(f"blade{suffix}", write, parts, root=root, tip=tip)
    assert same_facets(found, parts)


def test_written_mesh_is_the_blade_with_groups_and_no_points(parts, build, coarse_mesh):
    summary, found = build("blade.inp", exports.write_inp, *parts)
    assert summary.volume == pytest.approx(coarse_mesh.summary.volume, rel=1e-12)
    assert summary.smallest_jacobian == pytest.approx(coarse_mesh.summary.smallest_jacobian)
    assert (summary.nodes, summary.cells) == (len(parts.points), len(parts.cells))
    assert summary.cad_volume is None
    np.testing.assert_allclose(found.points, parts.points, rtol=1e-15)  # mm to m and back
    np.testing.assert_array_equal(found.cells, parts.cells)


def test_facets_of_the_root_are_exterior(parts, refusal):
    """A node set with all nodes: all facets of the surface, none between cells."""
    every = parts.facets | {"root": parts.cells}
    error = refusal("blade.inp", exports.write_inp, *parts._replace(facets=every))
    assert numbers(error) == [len(every["tip"])]


def placed(parts, node, at):
    """One node elsewhere."""
    points = parts.points.copy()
    points[node] = at
    return parts._replace(points=points)


def apart(parts, cell, at):
    """A node of one cell is another one, at the same place."""
    points = np.vstack([parts.points, parts.points[parts.cells[cell, at]]])
    cells = parts.cells.copy()
    cells[cell, at] = len(parts.points)
    return parts._replace(points=points, cells=cells)


def folded(parts):
    """By a middle node; the corners are sound: only the curved cell is inside out somewhere."""
    a, b, middle = parts.cells[5, [0, 1, 4]]
    return placed(parts, middle, 0.9 * parts.points[a] + 0.1 * parts.points[b])


def bent(parts, share):
    """An edge of the root bent by a share of its length."""
    a, b, middle = parts.facets["root"][0, [0, 1, 3]]
    far = share * np.linalg.norm(parts.points[b] - parts.points[a])
    return placed(parts, middle, parts.points[middle] - [far, 0, 0])


def touching(parts):
    """Of the cells around an inner edge only two are left, which face each other across it."""
    corners = [set(cell) for cell in parts.cells[:, :4].tolist()]
    i, j, edge = next(
        (i, j, a & b)
        for i, a in enumerate(corners)
        for j, b in enumerate(corners[:i])
        if len(a & b) == 2 and sum((a & b) <= c for c in corners) >= 5
    )
    kept = [n for n, c in enumerate(corners) if n in (i, j) or not edge <= c]
    return parts._replace(cells=parts.cells[kept])


def rising(parts):
    """A tip that rises downstream, of which a radius takes a part."""
    points = parts.points.copy()
    share = (points[:, 2] - points[:, 2].min()) / np.ptp(points[:, 2])
    points[:, 0] += 4 * share * (points[:, 0] - 422) / 140
    return parts._replace(points=points)


def not_merged(parts):
    """One cell at a corner on the trailing edge; the surface stays closed."""
    inside = np.setdiff1d(parts.cells[:, :4], np.vstack([*parts.facets.values()]))
    corner = inside[np.argmax(parts.points[inside, 2])]
    return apart(parts, *np.argwhere(parts.cells[:, :4] == corner)[0])


def same(parts):
    return parts


HALF_TURN = {"downstream": "-z"}  # right-handed still: upstream is downstream, ahead is behind
FAULTS = {  # the mesh, its settings, fields of the error, and words of it where it has no others
    "too many patches": (
        same,
        {"interface": {"patches": 60}},
        {"key": "interface.patches", "value": 60},
        "",
    ),
    "cell folded": (folded, {}, {}, r"\(Jacobian ratio -0\.\d\d, "),
    "no such root": (same, {"root": "hub"}, {"key": "root.group", "value": "hub"}, ""),
    "root of cells": (same, {"root": "EALL"}, {"key": "root.group", "value": "EALL"}, ""),
    "no root within": (same, {"root": 300.0}, {"key": "root.radius_mm", "value": 300.0}, ""),
    "root of corners alone": (
        lambda p: p._replace(facets=p.facets | {"root": p.facets["root"][:, :3]}),
        {},
        {"key": "root.group", "value": "ROOT"},
        "",
    ),
    "root and tip exchanged": (same, {"root": "TIP", "tip": "ROOT"}, {}, "562.4 mm .* 422.4 mm"),
    "cell twice": (
        lambda p: p._replace(cells=np.vstack([p.cells, p.cells[:1]])),
        {},
        {},
        "more than two cells",
    ),
    # a cell has a middle node of its own where its neighbours have another
    "edge torn": (lambda p: apart(p, 5, 4), {}, {}, "^1 edges have two middle nodes"),
    "touching itself": (touching, {}, {}, "not manifold"),
    # by 50 mm: its cells are stretched, and none is inside out
    "corner moved": (
        lambda p: placed(p, p.facets["tip"][0, 0], p.points[p.facets["tip"][0, 0]] + [50, 0, 0]),
        {},
        {},
        "stands out of the surface",
    ),
    # out of the surface: its cells grow and none is inside out; no Jacobian tells
    "middle node moved": (lambda p: bent(p, 3.3), {}, {}, r"3\.3 times its length \(allowed 0.5\)"),
    "rising tip": (rising, {"tip": 564.0}, {"key": "tip.radius_mm"}, ""),
    "slip of unit": (same, {"unit": "m"}, {"allowed": (0.001, 5)}, ""),
    # ten times too large: 1.4 m long, at a radius of 5.6 m
    "unit within the lengths": (
        same,
        {"unit": "cm"},
        {
            "key": "max_speed_rpm",
            "value": pytest.approx(650 * RPM),
            "allowed": {"le": pytest.approx(1000 / 5.624 * RPM)},
        },
        "",
    ),
    "other way": (same, {"frame": {"radial": "-x"}}, {"allowed": "x"}, ""),
    # seen against the engine axis, or against the rotation, the leading edge is behind
    "leading edge downstream": (
        same,
        {"frame": {"rotation": "left-handed"}},
        {},
        "frame.downstream and frame.rotation$",
    ),
    # its trailing edge is upstream and ahead: only the concave side of the tip shows it
    "half a turn": (same, {"frame": HALF_TURN}, {}, "^the hollow side of the tip is behind"),
    "corner not merged": (not_merged, {}, {}, "^1 pairs of nodes are not merged"),
    "gmsh's order": (lambda p: p._replace(cells=p.cells[:, GMSH]), {}, {}, "gmsh's order"),
    "two corners at one place": (
        lambda p: placed(p, p.cells[5, 1], p.points[p.cells[5, 0]]),
        {},
        {},
        "inf times its length",
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_mesh_that_is_no_blade_is_refused(fault, parts, refusal):
    change, settings, fields, named = FAULTS[fault]
    error = refusal("blade.inp", exports.write_inp, *change(parts), **settings)
    assert {name: getattr(error, name) for name in fields} == fields
    assert re.search(named, error.text)


def test_cells_inside_out_are_counted_and_the_worst_is_named(parts, refusal):
    cells = parts.cells.copy()
    cells[[5, 70]] = cells[[5, 70]][:, MIRRORED]
    error = refusal("blade.inp", exports.write_inp, *parts._replace(cells=cells))
    middle = parts.points[parts.cells[[5, 70], :4]].mean(axis=1)
    assert numbers(error)[:3] == [2, len(cells), -1.00]
    assert any("at {:.1f}, {:.1f}, {:.1f} mm".format(*at) in error.text for at in middle)


def test_root_that_reaches_up_the_blade_is_warned_of(parts, build):
    """Skin clamped to 500 mm: 77.6 mm of 140; the span of its facets is at the mesh's nodes."""
    with pytest.warns(
        MeshWarning, match=r"clamped from radius 422\.4 to (4[5-9]\d|500).* mm, \d+ %"
    ):
        build("blade.inp", exports.write_inp, *parts, root=500.0)


@pytest.mark.parametrize("warns", [False, True])
def test_root_that_reaches_up_a_fifth_of_the_blade_is_warned_of(warns, parts, build):
    """A fall of 30 (40) mm is 18 (22) % of the blade: the hub does not reach to the tip's ends."""
    fall = 40.0 if warns else 30.0
    with pytest.warns(MeshWarning, match="2[1-4] % of the blade") if warns else nullcontext():
        build("blade.inp", exports.write_inp, *exports.oblique(parts, fall))


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


def test_cells_of_third_order_are_counted(refusal, tmp_path):
    cells = [("tetra20", [range(20)]), ("tetra", [range(4)])]
    meshio.Mesh(np.eye(20, 3), cells).write(tmp_path / "b.msh", file_format="gmsh22", binary=False)
    assert "holds 1 tetra20: read are" in refusal("b.msh").text


@pytest.mark.parametrize(
    ("card", "line", "named"),
    [
        ("*Include, input=mesh.inc", None, "*INCLUDE"),
        ("*NGEN\n1, 2", None, "*NGEN"),
        ("*PART, NAME=a\n*PART, NAME=b", None, "several parts"),
        ("*INSTANCE, NAME=a, PART=b\n0., 0., 1.", None, "moved instance"),
        ("*ELEMENT, TYPE=SC8R\n1,2", 0, "holds elements SC8R: read are"),
        ("*ELEMENT, TYPE=C3D4\n70000, 1, 2, 3, 5", None, "768 C3D10, 1 C3D4: export one order"),
        ("*ELEMENT, TYPE=C3D27\n70000, 1, 2, 3, 5", 1, "has 4 of the 27 nodes"),
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
        ("*NSET, NSET=A\n1, 99999", 1, "99999"),
        ("*ELSET, ELSET=A\n99999,", 1, "99999"),
        ("*SURFACE, NAME=A\n99999, S1", 1, "99999"),
        ("*SURFACE, NAME=A, TYPE=NODE\n99999, 1.", 1, "99999"),
        ("*NSET, NSET=A, GENERATE\n90001, 99999, 1", 1, "90001 to 99999"),
        ("*NSET, NSET=A, GENERATE\n9, 1, 1", 1, "9 to 1"),
        ("*NSET, NSET=A, ELSET=B", 0, "'B'"),
        ("*SURFACE, NAME=A\nEall,", 1, "S1 to S4"),
        ("*NSET, NSET=A, INPUT=a.txt", 0, "INPUT"),
        ("*NODE, SYSTEM=C\n99999, 1., 2., 3.", 0, "SYSTEM"),
        ("*ELEMENT, TYPE=S3, OFFSET=9\n99999, 1, 2, 3", 0, "OFFSET"),
    ],
)
def test_deck_that_is_not_read(card, line, named, parts, refusal):
    error = refusal("blade.inp", write_deck, parts, card)
    card_line = 3 + len(parts.points) + len(parts.cells)
    assert error.line == (None if line is None else card_line + line)
    assert named in error.text


@pytest.mark.parametrize(
    ("file", "text", "named"),
    [
        ("blade.stl", "", ".stl: known are .inp, .cdb, .bdf, .nas, .fem, .msh, .vtu"),
        ("blade", "", "missing"),
        ("blade.inp", None, "no such file"),
        ("blade.inp", "", "no tetrahedra, bricks"),
        ("blade.bdf", "GRID", "ENDDATA"),
        ("blade.msh", "a", "$Elements"),
        ("blade.msh", "*NODE\n", "no tetrahedra, bricks"),
        ("blade.vtu", "<a", ".vtu"),
    ],
)
def test_file_that_is_not_read(file, text, named, refusal, tmp_path):
    if text is not None:
        (tmp_path / file).write_text(text)
    assert named in refusal(file).text


def test_edge_that_is_bent_as_an_arc(parts, build):
    build("b.inp", exports.write_inp, *bent(parts, 0.3))


@pytest.mark.parametrize(
    ("suffix", "keep", "change"),
    [
        (".inp", lambda z: (z < np.quantile(z, 0.3)) | (z > np.quantile(z, 0.7)), None),
        (".bdf", lambda z: z.argsort()[:-1], None),
        (".inp", lambda z: z.argsort(), lambda text: text.rstrip("\n").rpartition("\n")[0]),
    ],
)
def test_tip_without_its_middle_or_its_end(suffix, keep, change, parts, refusal):
    tip = parts.facets["tip"]
    less = tip[keep(parts.points[tip[:, :3], 2].mean(axis=1))]
    parts = parts._replace(facets=parts.facets | {"tip": less})
    write, root, tip = exports.FORMATS[suffix]
    error = refusal(f"b{suffix}", write, *parts, change=change, root=root, tip=tip)
    assert error.key == "tip.group"


def test_deck_without_its_last_elements(parts, refusal):
    """With root and tip by radius nothing else misses them."""
    order = np.argsort(-parts.points[parts.cells[:, :4], 0].mean(axis=1))
    kept = parts.cells[np.sort(order[:-200])]
    lower = np.hypot(*parts.points[np.unique(kept), :2].T).min()
    error = refusal("b.inp", exports.write_inp, parts.points, kept, {}, root=lower + 9, tip=562.3)
    assert "belong to no solid cell" in error.text


def test_a_reversed_tip_without_camber_is_not_detected(tmp_path, coarse_blade):
    """As geometry/README.md says."""
    straight = coarse_blade.model_dump(exclude_unset=True)
    straight["sections"]["tip"]["camber_percent"] = 0
    straight = check_settings(Blade, straight, "test")
    build_mesh(straight, tmp_path / "own.msh")
    exports.write_inp(tmp_path / "b.inp", *exports.parts(tmp_path / "own.msh"))
    blade = as_meshed(coarse_blade, "b.inp", frame=HALF_TURN)
    build_mesh(blade, tmp_path / "b.msh", tmp_path / "b.inp")


@pytest.mark.parametrize("kind", ["C3D4", "C3D10"])
def test_nodes_on_both_sides_of_a_cut(kind, parts, refusal, recwarn):
    """Half of a cross-section has nodes of its own on its upper side."""
    upper = parts.points[parts.cells[:, :4], 0].mean(axis=1) > 490
    both = np.intersect1d(parts.cells[upper], parts.cells[~upper])
    z = parts.points[both, 2]
    nodes = both[z > np.median(z)]
    own = np.arange(len(parts.points))
    own[nodes] = len(parts.points) + np.arange(len(nodes))
    cells = np.where(upper[:, None], own[parts.cells], parts.cells)
    points = np.vstack([parts.points, parts.points[nodes]])
    assert len(nodes) > 10
    write = exports.write_inp, points, cells[:, : int(kind[3:])], parts.facets, kind
    count, *first = numbers(refusal("b.inp", *write, root=422.5, tip=562.3))
    assert kind == "C3D4" or count == len(nodes)  # of C3D4, middle nodes where edges are
    assert np.abs(parts.points[nodes] - np.array(first)).max(axis=1).min() < 0.1
    assert len(recwarn) == (kind == "C3D4")


@pytest.mark.parametrize("nodes", [4, 10])
def test_flat_mesh(nodes, parts, refusal, recwarn):
    """All Jacobians are zero, and their ratios are no numbers."""
    points = parts.points[:, [0, 2, 2]] * [1, 0.5, 1]
    write = exports.write_inp, points, parts.cells[:, :nodes], parts.facets, f"C3D{nodes}"
    error = refusal("b.inp", *write, root=422.5, tip=562.3)
    assert "inside out or flat" in error.text
    assert len(recwarn) == (nodes == 4)


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

    def change(text):
        text = re.sub(r"^(\d+ (?:9|11) 2) 1 ", r"\1 0 ", text, flags=re.MULTILINE)
        return re.sub(r"^(\d+ 9 2) [23] ", r"\1 1 ", text, flags=re.MULTILINE)

    error = refusal("b.msh", exports.write_msh, *parts, change=change, root=422.5, tip="tip")
    assert (error.key, error.value) == ("tip.group", "tip")


@pytest.mark.parametrize("version", [2.2, 4.0, 4.1])
def test_cells_beyond_those_declared(version, by_gmsh, refusal):
    """One cell (MSH 2), or one block of cells (MSH 4), less than are there."""
    by_gmsh(version)
    head = re.compile(r"(?<=\$Elements\n)\d+")
    fewer = {"change": lambda text: head.sub(lambda found: str(int(found[0]) - 1), text)}
    held, read = numbers(refusal("b.msh", root=422.5, tip=562.3, **fewer))
    assert held == 805 and read in (804, 37)


@pytest.mark.parametrize(
    "change", [lambda text: text.replace("$EndElements\n", ""), "{0}{0}".format]
)
def test_mesh_of_gmsh_without_its_end_or_twice_in_one_file(change, by_gmsh, refusal):
    by_gmsh(4.1)
    error = refusal("b.msh", change=change, root="root", tip="tip")
    assert "one $Nodes and one $Elements" in error.text


VTU = {
    "declares 1536 cells, of which 768 are read": lambda text: re.sub(
        r"(?s)(<Piece.*)(?=</UnstructuredGrid>)", r"\1\1", text
    ),
    "declares 768 cells, of which 767 are read": lambda text: re.sub(
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

    assert fault in refusal("b.vtu", write, change=VTU[fault], root="root", tip="tip").text
