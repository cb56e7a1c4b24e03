"""The blade's own mesh, exported and read back, is the same blade; a linear one is stiffer."""

import exports
import numpy as np
import pytest
from brick_files import FORMATS, to_write
from bricks import ENDS, Bricks

from fem.assemble import assemble
from geometry.base import MeshWarning
from geometry.import_mesh import eased
from geometry.mesh import build_mesh
from geometry.shape import session
from geometry.split import Block, split
from rom.modes import ShiftInvert


def frequencies(matrices):
    """First ten at each speed, rad/s."""
    return np.array([ShiftInvert(K, matrices.M).modes(10).omega for K in matrices.K])


@pytest.fixture(scope="module")
def parts(coarse_mesh):
    return exports.parts(coarse_mesh.mesh)


@pytest.fixture(scope="module")
def expected(coarse_matrices):
    return frequencies(coarse_matrices)[[0, -1]]


def read_back(blade, path, speeds=(0.0,)):
    mesh = path.with_name("out.msh")
    build_mesh(blade, mesh, path)
    matrices = assemble(blade, "imported", mesh, speeds)
    return frequencies(matrices), matrices


@pytest.mark.parametrize("suffix", exports.FORMATS)
def test_each_format_gives_back_the_frequencies(suffix, coarse_blade, parts, expected, tmp_path):
    """Ten-node tetrahedra in the wrong order would be inside out, or softer by percents.

    Measured 3e-11 to 7e-10: SLEPc is asked for 1e-10, and round-off of the coordinates starts it
    elsewhere. Files of 9 digits keep 3e-9, of 7 digits 4e-7.
    """
    write, root, tip = exports.FORMATS[suffix]
    file = f"blade{suffix}"
    write(tmp_path / file, *parts)
    found, _ = read_back(exports.as_meshed(coarse_blade, file, root, tip), tmp_path / file)
    np.testing.assert_allclose(found[0], expected[0], rtol=1e-8)


def test_own_mesh_at_top_speed_with_the_same_interface(
    coarse_blade, coarse_mesh, coarse_matrices, expected, tmp_path
):
    """MSH 4.1, as we write it; groups by name, unit m."""
    path = tmp_path / "blade.msh"
    path.write_bytes(coarse_mesh.mesh.read_bytes())
    blade = exports.as_meshed(coarse_blade, "blade.msh", "root", "tip", unit="m")
    found, matrices = read_back(blade, path, [0.0, blade.top_speed])
    np.testing.assert_allclose(found, expected, rtol=1e-8)  # measured 3e-11
    np.testing.assert_allclose(matrices.camber, coarse_matrices.camber, atol=1e-14)
    assert (
        abs(compliance(matrices) - compliance(coarse_matrices)).max()
        < 1e-8 * abs(compliance(coarse_matrices)).max()
    )


def compliance(matrices):
    """C at rest, whatever the order of the nodes: a third of the thin blade's round-off."""
    loads = matrices.S.T.toarray()
    return matrices.S @ ShiftInvert(matrices.K[0], matrices.M).solve(loads)


@pytest.mark.parametrize("hand", ["right-handed", "left-handed"])
def test_other_axes_are_the_same_blade(hand, coarse_blade, parts, expected, tmp_path):
    """The engine axis along x, the blade along -y; left-handed, the file holds a mirror image."""
    mirror = hand == "left-handed"
    x, y, z = parts.points.T
    turned = np.column_stack([z, -x, y if mirror else -y])
    cells = parts.cells[:, exports.MIRRORED] if mirror else parts.cells
    exports.write_inp(tmp_path / "blade.inp", turned, cells, parts.facets)
    frame = {"downstream": "x", "radial": "-y", "rotation": hand}
    blade = exports.as_meshed(coarse_blade, "blade.inp", frame=frame)
    found, _ = read_back(blade, tmp_path / "blade.inp", [blade.top_speed])
    np.testing.assert_allclose(found[0], expected[1], rtol=1e-8)  # measured 4e-11


def test_length_of_a_blade_on_an_oblique_hub_is_from_its_mean_radius(coarse_blade, parts, tmp_path):
    """The hub falls by 27 mm: its highest node would make the blade 13 mm longer."""
    moved = exports.oblique(parts, 27.0)
    exports.write_inp(tmp_path / "blade.inp", *moved)
    blade = exports.as_meshed(coarse_blade, "blade.inp")
    mesh = tmp_path / "out.msh"
    build_mesh(blade, mesh, tmp_path / "blade.inp")
    hub = np.hypot(*moved.points[np.unique(moved.facets["root"]), :2].T) * 1e-3
    assert np.ptp(hub) > 0.02
    matrices = assemble(blade, "oblique", mesh, [0.0])
    span = matrices.camber[:, 0].mean() - hub.mean()
    assert matrices.span == pytest.approx(span, rel=1e-12)


def test_four_node_cells_are_raised_and_do_not_lock(coarse_blade, parts, expected, tmp_path):
    """Left is the straight edge: a thinner blade; measured -0.8 % of f1 (locked: +4 to +11 %)."""
    exports.write_inp(
        tmp_path / "blade.inp", parts.points, parts.cells[:, :4], parts.facets, "C3D4"
    )
    blade = exports.as_meshed(coarse_blade, "blade.inp")
    with pytest.warns(MeshWarning, match=r"^blade.inp: cells of first order"):
        found, _ = read_back(blade, tmp_path / "blade.inp")
    assert found[0, 0] == pytest.approx(expected[0, 0], rel=0.01)


@pytest.mark.parametrize("kind", ["hexahedron", "wedge"])
def test_bricks_and_wedges_have_the_frequencies_of_tetrahedra(
    kind, coarse_blade, expected, tmp_path
):
    """Two meshes that share nothing but the blade; both are coarse."""
    bricks = Bricks(coarse_blade.sections, 10, 1, 18).parts(kind)
    name = {"hexahedron": "C3D20", "wedge": "C3D15"}[kind]
    exports.write_inp(tmp_path / "blade.inp", *bricks, name)
    found, _ = read_back(exports.as_meshed(coarse_blade, "blade.inp"), tmp_path / "blade.inp")
    np.testing.assert_allclose(found[0, :6], expected[0, :6], rtol=5e-3)  # measured 3e-3


@pytest.fixture(scope="module")
def bricks(coarse_blade):
    return Bricks(coarse_blade.sections, 5, 1, 6)


@pytest.fixture(scope="module", params=["hexahedron", "wedge"])
def split_first(request, coarse_blade, bricks, tmp_path_factory):
    """Kind of cells, and frequencies of the tetrahedra that they are split into, in a file."""
    cells = bricks.cells(request.param)
    ten = split(bricks.points, [Block(cells, np.arange(len(cells)))])
    groups = {end: ten.with_new(bricks.on(i, cells)) for end, i in ENDS.items()}
    path = tmp_path_factory.mktemp("split") / "blade.inp"
    with session("test"):
        points = eased(ten.points, ten.cells, ten.parents)
    exports.write_inp(path, points, ten.cells, groups)
    return request.param, read_back(exports.as_meshed(coarse_blade, path.name), path)[0]


@pytest.mark.parametrize("name", FORMATS)
def test_bricks_and_wedges_of_each_format_have_the_same_frequencies(
    name, split_first, coarse_blade, bricks, tmp_path
):
    """To the last bit, or 6e-10 where the format has fewer digits (Nastran, Ansys)."""
    kind, expected = split_first
    _, root, tip = FORMATS[name]
    file, write, *what = to_write(name, bricks, kind)
    write(tmp_path / file, *what)
    found, _ = read_back(exports.as_meshed(coarse_blade, file, root, tip), tmp_path / file)
    np.testing.assert_allclose(found, expected, rtol=1e-8)
