"""Bricks, wedges, pyramids as tetrahedra: volumes, neighbours that agree, files of each format."""

from contextlib import nullcontext
from itertools import pairwise, product

import gmsh
import numpy as np
import pytest
from brick_files import FORMATS, to_write, write_inp
from bricks import ENDS, Bricks
from meshio.gmsh.common import _meshio_to_gmsh_order
from refused import refused

from geometry.base import MeshError, MeshWarning
from geometry.generate import volume
from geometry.readers import read_mesh_file
from geometry.shape import CELL, jacobian_ratios, session
from geometry.split import KINDS, Block, split, triangles_of
from geometry.tetrahedra import GMSH, exterior

# corners of cells of edge 1, and their volumes
CUBE = np.array(
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)], float
)
CELLS = {
    "tetra": (CUBE[[0, 1, 3, 4]], 1 / 6, 1),
    "pyramid": (CUBE[:5], 1 / 3, 2),
    "wedge": (CUBE[[0, 1, 3, 4, 5, 7]], 1 / 2, 3),
    "hexahedron": (CUBE, 1.0, 6),
}


def measured(found):
    """Volume of ten-node cells, and their smallest Jacobian ratio, by gmsh."""
    with session("split"):
        gmsh.model.addDiscreteEntity(3, 1)
        nodes = np.arange(len(found.points)) + 1
        gmsh.model.mesh.addNodes(3, 1, nodes, found.points.ravel())
        cells = np.arange(len(found.cells)) + 1
        gmsh.model.mesh.addElementsByType(1, CELL, cells, (found.cells[:, GMSH] + 1).ravel())
        return volume(), jacobian_ratios().min()


def numbered(points, seed):
    """Points in a random order, and the nodes of one cell in them."""
    order = np.random.default_rng(seed).permutation(len(points))
    mixed = np.empty_like(points)
    mixed[order] = points
    return mixed, Block(order[None], np.array([7]))


@pytest.mark.parametrize("kind", CELLS)
def test_a_cell_is_filled_whichever_of_its_nodes_is_first(kind):
    points, whole, count = CELLS[kind]
    for seed in range(20):
        found = split(*(of if i == 0 else [of] for i, of in enumerate(numbered(points, seed))))
        size, ratio = measured(found)
        assert len(found.cells) == count and set(found.numbers) == {7}
        assert size == pytest.approx(whole, rel=1e-10) and ratio == pytest.approx(1)


def test_neighbours_agree_on_the_diagonals_between_them():
    """Bricks, numbered at random: the outside is closed, and has two triangles a side."""
    n = 3
    steps = np.arange(n + 1.0)
    points = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1).reshape(-1, 3)
    order = np.random.default_rng(5).permutation(len(points))
    row = {tuple(point): i for i, point in zip(order, points, strict=True)}
    corners = [[row[tuple(at + by)] for by in CUBE] for at in points if (at < n).all()]
    mixed = np.empty_like(points)
    mixed[order] = points
    found = split(mixed, [Block(np.array(corners), np.arange(n**3))])
    assert len(exterior(found.cells)) == 2 * 6 * n**2
    assert measured(found)[0] == pytest.approx(n**3, rel=1e-10)
    # nodes, edges, diagonals of squares and of cubes
    cubes, squares, edges = n**3, 3 * n**2 * (n + 1), 3 * n * (n + 1) ** 2
    assert len(found.points) == len(points) + edges + squares + cubes


def test_a_warped_brick_of_first_order_keeps_its_volume():
    """Its sides are ruled surfaces, which six-node triangles follow exactly."""
    rng = np.random.default_rng(2)
    nodes, weights = np.polynomial.legendre.leggauss(3)
    for seed in range(20):
        points = CUBE + rng.uniform(-0.15, 0.15, CUBE.shape)
        mapped = 0.0
        along = zip((nodes + 1) / 2, weights / 2, strict=True)
        for (u, a), (v, b), (w, c) in product(along, repeat=3):
            shares = [np.where(CUBE[:, i] == 1, x, 1 - x) for i, x in enumerate((u, v, w))]
            signs = np.where(CUBE == 1, 1, -1).T
            gradient = [(signs[i] * shares[i - 2] * shares[i - 1]) @ points for i in range(3)]
            mapped += a * b * c * np.linalg.det(gradient)
        mixed, block = numbered(points, seed)
        size, _ = measured(split(mixed, [block]))
        assert size == pytest.approx(mapped, rel=1e-10)


@pytest.mark.parametrize(("kind", "cells"), [("hexahedron", 6), ("wedge", 3)])
def test_the_volume_of_curved_cells_converges(coarse_blade, kind, cells):
    """Sides of eight nodes have cubic terms that triangles do not carry."""
    sizes = []
    for n in (1, 2, 4):
        bricks = Bricks(coarse_blade.sections, 3 * n, 1, 4 * n)
        nodes = bricks.cells(kind)
        found = split(1e-3 * bricks.points, [Block(nodes, np.arange(len(nodes)))])
        size, ratio = measured(found)
        assert len(found.cells) == cells * len(nodes) and ratio > 0.1
        sizes.append(size)
    first, last = (abs(b / a - 1) for a, b in pairwise(sizes))
    assert last < 1e-3 and last < first / 4


def test_a_quadrilateral_on_two_triangles_is_refused_with_its_cells():
    points = np.vstack([CUBE, [(0.5, 0.5, 2)]])
    brick = Block(np.arange(8)[None], np.array([1]))
    above = Block(np.array([[4, 5, 6, 8], [4, 6, 7, 8]]), np.array([2, 3]))
    error = refused(MeshError, split, points, [brick, above])
    assert "cell 1 meets a triangle of cell 2" in error.text
    pyramid = Block(np.array([[4, 5, 6, 7, 8]]), np.array([2]))
    assert measured(split(points, [brick, pyramid]))[0] == pytest.approx(1 + 1 / 3)


def test_an_edge_with_two_middle_nodes_is_refused():
    points = np.vstack([CUBE, CUBE[KINDS["hexahedron"].edges].mean(axis=1), CUBE[:1]])
    torn = Block(np.arange(20)[None].repeat(2, axis=0), np.arange(2))
    torn.nodes[1, 8] = 20
    assert "1 edges have two" in refused(MeshError, split, points, [torn]).text


def test_quadrilaterals_of_groups_are_cut_as_those_of_cells():
    assert triangles_of([(5, 2, 7, 3), (1, 0, 4)]).tolist() == [[1, 0, 4], [2, 7, 3], [2, 3, 5]]


@pytest.fixture(scope="module")
def bricks(coarse_blade):
    return Bricks(coarse_blade.sections, 4, 1, 8)


@pytest.mark.parametrize("second_order", [True, False])
@pytest.mark.parametrize("kind", ["hexahedron", "wedge"])
@pytest.mark.parametrize("name", FORMATS)
def test_a_blade_of_each_format_is_the_same(name, kind, second_order, bricks, build, capsys):
    _, root, tip = FORMATS[name]
    args = to_write(name, bricks, kind, second_order)
    cells, faces = bricks.cells(kind, second_order), bricks.faces(kind, second_order)
    keys = {"root": root, "tip": tip, "interface": {"patches": 4}}
    told = nullcontext() if second_order else pytest.warns(MeshWarning, match="first order")
    with told:
        summary, found = build(*args, **keys)
    expected = split(1e-3 * bricks.points, [Block(cells, np.arange(len(cells)))])
    # diagonals of curved faces lie a little other in them
    assert summary.volume == pytest.approx(measured(expected)[0], rel=1e-5)
    facets = len(faces["tip"]) * (2 if kind == "hexahedron" else 1)
    assert [len(found.facets[of]) for of in ENDS] == [facets, facets]
    said = f"split into {len(expected.cells)} ten-node tetrahedra on {summary.nodes} nodes"
    assert said in capsys.readouterr().out


def test_a_twisted_brick_is_refused_by_its_number(bricks, refusal):
    """Two nodes of one side exchanged."""
    points, cells = bricks.points.copy(), bricks.cells("hexahedron", False)
    a, b = cells[5, [4, 6]]
    points[[a, b]] = points[[b, a]]
    with pytest.warns(MeshWarning, match="first order"):
        error = refusal("b.inp", write_inp, points, cells, bricks.faces("hexahedron", False))
    assert "cell 6 of the file" in error.text and "inside out" in error.text


def test_complete_cells_of_gmsh_are_read(tmp_path):
    """27, 18 and 14 nodes: those within faces and cells are left out."""
    with session("test"):
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        for curve in gmsh.model.getEntities(1):
            gmsh.model.mesh.setTransfiniteCurve(curve[1], 3)
        for surface in gmsh.model.getEntities(2):
            gmsh.model.mesh.setTransfiniteSurface(surface[1])
            gmsh.model.mesh.setRecombine(*surface)
        gmsh.model.mesh.setTransfiniteVolume(1)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        gmsh.write(str(tmp_path / "box.msh"))
    mesh = read_mesh_file(tmp_path / "box.msh").without_unused()
    assert mesh.made.startswith("8 hexahedron27 on")
    assert measured(mesh)[0] == pytest.approx(1, rel=1e-10)


@pytest.mark.parametrize(("kind", "nodes"), [("wedge18", 15), ("pyramid14", 13)])
def test_complete_wedges_and_pyramids_have_gmshs_order(kind, nodes, tmp_path):
    """A single cell, its middle nodes moved outward: each lies near the middle of its edge."""
    of = KINDS[kind.rstrip("0123456789")]
    corners = CELLS[kind.rstrip("0123456789")][0]
    middles = corners[of.edges].mean(axis=1)
    without = {15: "wedge15", 13: "pyramid13"}[nodes]
    known = _meshio_to_gmsh_order(without, np.arange(nodes)[None])[0]
    inner = np.full((int(kind[-2:]) - nodes, 3), 0.3)
    points = np.vstack([corners, middles, inner])
    cell = np.append(known, np.arange(nodes, len(points)))
    text = "\n".join(
        ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(points))]
        + [f"{i} {x} {y} {z}" for i, (x, y, z) in enumerate(points, 1)]
        + ["$EndNodes", "$Elements", "1"]
        + [" ".join(map(str, [1, {15: 13, 13: 14}[nodes], 2, 1, 1, *(cell + 1)]))]
        + ["$EndElements", ""]
    )
    (tmp_path / "one.msh").write_text(text)
    mesh = read_mesh_file(tmp_path / "one.msh")
    size, ratio = measured(mesh.without_unused())
    assert size == pytest.approx(CELLS[kind.rstrip("0123456789")][1]) and ratio == pytest.approx(1)
