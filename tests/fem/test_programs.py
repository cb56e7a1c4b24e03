"""Matrices of the coarse blade, as other programs write them beside their mesh, are read back."""

import re
import subprocess
from pathlib import Path
from typing import NamedTuple

import calculix
import exports
import numpy as np
import pytest
import yaml
from bricks import Bricks
from programs import WRITERS
from refused import refused
from scipy.io import mmwrite
from scipy.sparse import block_diag, csr_matrix, diags, eye_array, kron, triu
from scipy.spatial import KDTree

from ufl import TestFunction, TrialFunction, dx, inner

from fem.assemble import assemble
from fem.deck import Deck, deck_of
from fem.elsewhere import ElsewhereError, read_matrices
from fem.matrix_files import read_matrix
from fem.solid import read_solid
from geometry.base import ROOT, UserError, check_settings
from geometry.blade import METRES, Frame, MeshFile, MeshGeometry
from geometry.elsewhere import MatricesElsewhere
from geometry.file_mesh import UNITS
from geometry.frame import rotation
from geometry.mesh import build_mesh
from geometry.tetrahedra import EDGES
from rom.modes import ShiftInvert
from rom.reduce import reduce

needs_ccx = pytest.mark.skipif(calculix.CCX is None, reason="ccx is not here (calculix-ccx)")
FRAMES = {
    "mm": {},
    "in": {"downstream": "x", "radial": "-y", "rotation": "left-handed"},
}
ENDS = {"root": {"group": "ROOT"}, "tip": {"group": "TIP"}}


class Model(NamedTuple):
    """A deck with its M and K in the axes and unit of a program."""

    folder: Path
    mesh: dict  # settings of the deck
    M: csr_matrix
    K: csr_matrix
    rows: np.ndarray  # (n, 2), node and direction


def settings(mesh, M, K, **others):
    keys = {"M": M, "K": K if isinstance(K, dict) else {0.0: K}, "mesh_file": mesh}
    top = {} if isinstance(K, dict) else {"max_speed_rad_s": 500.0}
    tip = {"patches": 8, "across": 1}
    return check_settings(MatricesElsewhere, {"full_matrices": keys} | tip | top | others, "test")


def frequencies(M, K, count=10):
    return ShiftInvert(csr_matrix(K), csr_matrix(M)).modes(count).omega / (2 * np.pi)


def model(unit, coarse_matrices, coarse_mesh, folder) -> Model:
    """Numbers of nodes are drawn; rows stand in the order of ours."""
    frame = check_settings(Frame, FRAMES[unit], "a frame")
    R = rotation(frame)
    parts = exports.parts(coarse_mesh.mesh)
    new = np.random.default_rng(50).permutation(len(parts.points))  # number of each node, from 0
    points = np.empty_like(parts.points)
    points[new] = 1e-3 * parts.points @ R / METRES[unit]
    facets = {name: new[of] for name, of in parts.facets.items()}
    exports.write_inp(folder / "blade.inp", points, new[parts.cells], facets)
    _, at = KDTree(1e-3 * parts.points).query(coarse_matrices.coordinates)
    rows = np.column_stack([np.repeat(new[at] + 1, 3), np.tile([1, 2, 3], len(at))])
    turn = kron(eye_array(len(at)), R) / np.sqrt(UNITS[unit][0] * METRES[unit])
    M, K = (csr_matrix(turn.T @ A @ turn) for A in (coarse_matrices.M, coarse_matrices.K[0]))
    mesh = {"file": "blade.inp", "unit": unit, "frame": FRAMES[unit]} | ENDS
    return Model(folder, mesh, M, K, rows)


@pytest.fixture(scope="module", params=FRAMES)
def models(request, coarse_matrices, coarse_mesh, tmp_path_factory):
    return model(request.param, coarse_matrices, coarse_mesh, tmp_path_factory.mktemp("model"))


@pytest.fixture(scope="module")
def in_mm(coarse_matrices, coarse_mesh, tmp_path_factory):
    return model("mm", coarse_matrices, coarse_mesh, tmp_path_factory.mktemp("in-mm"))


@pytest.mark.parametrize("program", WRITERS)
def test_files_of_a_program_are_our_own_matrices(program, models, coarse_matrices):
    """Whatever the numbers, axes and unit.

    The fourteen digits of CalculiX cost 3e-8 of f1, the ten of DMIG 6e-5.
    """
    files = WRITERS[program](models.folder, models.M, models.K, models.rows)
    fom = read_matrices(settings(models.mesh, *files), "given", models.folder)
    found, ours = frequencies(fom.M, fom.K[0]), frequencies(coarse_matrices.M, coarse_matrices.K[0])
    np.testing.assert_allclose(found, ours, rtol=2e-4 if "DMIG" in program else 2e-7)
    assert fom.span == pytest.approx(coarse_matrices.span, rel=1e-9)
    np.testing.assert_allclose(fom.camber, coarse_matrices.camber, atol=1e-9)
    theirs, own = (of.S @ fields(of.coordinates) for of in (fom, coarse_matrices))
    np.testing.assert_allclose(theirs, own, atol=1e-10)


def fields(x):
    """Displacements (3 n, 12): constant, and linear in place."""
    e = np.eye(3)
    linear = [np.outer(x[:, i], e[j]).ravel() for i in range(3) for j in range(3)]
    return np.column_stack([*(np.tile(e[j], len(x)) for j in range(3)), *linear])


def test_bricks_move_their_diagonals_with_their_faces(coarse_blade, tmp_path):
    """S of split bricks, on nodes of the file alone, is that of their tetrahedra.

    For constant and linear displacements; wedges and first order as well. Unit translations stay of
    length 1 but for the turn of the radius within a patch.
    """
    bricks = Bricks(coarse_blade.sections, 8, 1, 4)
    for kind, second_order in (("hexahedron", True), ("hexahedron", False), ("wedge", True)):
        points, nodes, groups = bricks.parts(kind, second_order)
        name = {20: "C3D20R", 8: "C3D8", 15: "C3D15"}[nodes.shape[1]]
        exports.write_inp(tmp_path / "b.inp", points, nodes, groups, name)
        deck = deck_of(mesh_file({"file": "b.inp", "unit": "mm"} | ENDS), tmp_path)
        S, *_ = deck.interface(8, 1)
        split, *_ = deck._replace(weights=eye_array(len(deck.points))).interface(8, 1)
        assert S.shape[1] == 3 * len(deck.numbers) < split.shape[1]
        np.testing.assert_allclose(
            S @ fields(deck.coordinates), split @ fields(deck.points), atol=1e-12
        )
        e_r = (S @ fields(deck.coordinates)[:, :3]).reshape(8, 3, 3)
        np.testing.assert_allclose(np.linalg.norm(e_r, axis=2), 1, atol=1e-3)


def mesh_file(keys):
    return check_settings(MeshFile, keys, "test")


@pytest.fixture
def of_calculix(in_mm, tmp_path):
    """The model in a folder of its own, to be spoiled."""
    files = WRITERS["CalculiX"](tmp_path, in_mm.M, in_mm.K, in_mm.rows)
    (tmp_path / "blade.inp").write_text((in_mm.folder / "blade.inp").read_text())
    return in_mm._replace(folder=tmp_path), files


CUT = {
    "within a number": lambda text: text[:-5],
    "after a row": lambda text: "\n".join(text.split("\n")[:-200]) + "\n",
    "within a row": lambda text: text[: len(text) // 2 // 28 * 28 + 7] + "\n",
    "empty": lambda text: "",
}


@pytest.mark.parametrize("cut", CUT)
@pytest.mark.parametrize("file", ["job.sti", "job.mas", "job.dof"])
def test_file_that_is_cut_short_is_refused(cut, file, of_calculix):
    of, files = of_calculix
    path = of.folder / file
    text = path.read_text()
    if file == "job.dof":
        text = text.rstrip("\n")
    path.write_text(CUT[cut](text))
    given = settings(of.mesh, *files)
    refused(ElsewhereError, read_matrices, given, "given", of.folder, match=r"job\..*cut short\?")


def refuse(of, program, match, mesh=None, **spoiled):
    """Files of a program with some values spoiled."""
    files = WRITERS[program](
        of.folder,
        *(spoiled.get(name, getattr(of, name)) for name in "MK"),
        spoiled.get("rows", of.rows),
    )
    given = settings(of.mesh | (mesh or {}), *files)
    return refused(UserError, read_matrices, given, "given", of.folder, match=match)


def node_of(of, node):
    """Rows of which one node has another number."""
    rows = of.rows.copy()
    rows[rows[:, 0] == of.rows[30, 0], 0] = node
    return rows


def test_rows_that_are_no_displacements_of_nodes_are_refused(of_calculix):
    of, _ = of_calculix
    refuse(of, "CalculiX", "node 99999, direction 1, has a row.*reference", rows=node_of(of, 99999))
    refuse(of, "Abaqus, MATRIX INPUT", "node -7, .*Lagrange", rows=node_of(of, -7))
    other = np.add(of.rows, [0, 1])
    refuse(of, "Abaqus, MATRIX INPUT", "direction 4, has a row", rows=other)


def test_constrained_nodes_off_the_root_are_refused(of_calculix):
    """Left out, or held by a large number; those of the root may be either."""
    of, _ = of_calculix
    node = of.rows[30, 0]
    kept = np.arange(len(of.rows)) != 31
    M, K = (A[kept][:, kept] for A in (of.M, of.K))
    refuse(of, "CalculiX", f"node {node}, direction 2, has no row", M=M, K=K, rows=of.rows[kept])
    held = diags(np.where(kept, 0, 1e36))
    refuse(
        of,
        "Abaqus, MATRIX INPUT",
        f"1e\\+39 on the diagonal .*node {node}, direction 2",
        K=of.K + held,
    )
    root = deck_of(mesh_file(of.mesh), of.folder).clamped
    rows = np.vstack(
        [of.rows, np.column_stack([np.repeat(root, 3), np.tile([1, 2, 3], len(root))])]
    )
    of_root = np.arange(len(rows)) >= len(of.rows)
    one = eye_array(of_root.sum())
    M, K = (csr_matrix(block_diag([A, x * one])) for A, x in ((of.M, 0.0), (of.K, 1e36)))
    files = WRITERS["Abaqus, MATRIX INPUT"](of.folder, M, K, rows)
    fom = read_matrices(settings(of.mesh, *files), "given", of.folder)
    assert fom.M.shape == of.M.shape


@pytest.mark.slow
def test_other_units_order_or_mesh_are_refused(of_calculix):
    of, _ = of_calculix
    for program in ("CalculiX", "Nastran, DMIG"):
        refuse(of, program, "mass of .*kg/m3: .*units of M", M=1e3 * of.M, K=1e3 * of.K)  # SI
    refuse(of, "CalculiX", "the blade is 140 m long with unit: m", mesh={"unit": "m"})
    order = np.random.default_rng(1).permutation(len(of.rows) // 3)
    shuffled = (3 * order[:, None] + np.arange(3)).ravel()
    refuse(
        of,
        "SciPy",
        "forces away from the clamp",
        M=of.M[shuffled][:, shuffled],
        K=of.K[shuffled][:, shuffled],
    )
    n = len(of.rows) - 3
    shorter = {"M": of.M[:n, :n], "K": of.K[:n, :n], "rows": of.rows[:n]}
    refuse(of, "Abaqus, COORDINATE", f"{n} rows and {n} columns, needs", **shorter)
    deck = (of.folder / "blade.inp").read_text()
    start, nodes, rest = deck.partition("*ELEMENT")
    moved = [line.split(", ") for line in start.splitlines()[1:]]
    stretched = [f"{i}, {float(x) * 1.1}, {y}, {z}" for i, x, y, z in moved]
    (of.folder / "blade.inp").write_text("\n".join(["*NODE", *stretched, nodes + rest]))
    refuse(of, "CalculiX", "forces away from the clamp .* order and the frame")


def test_one_triangle_needs_its_word_in_matrix_market_alone(of_calculix):
    of, _ = of_calculix
    order = np.lexsort(of.rows.T[::-1])
    M, K = (A[order][:, order] for A in (of.M, of.K))
    mmwrite(of.folder / "M.mtx", M, symmetry="symmetric", precision=17)
    mmwrite(of.folder / "K.mtx", triu(K), symmetry="general", precision=17)
    given = settings(of.mesh, "M.mtx", "K.mtx")
    refused(
        ElsewhereError, read_matrices, given, "given", of.folder, match="not symmetric.*`symmetric`"
    )


HEAD = "%%MatrixMarket matrix {} {} {}\n% by hand\n2 2 2\n{}"


@pytest.mark.parametrize(
    ("file", "text", "fault"),
    [
        ("K.sub", "", "a superelement's rows are no displacements of nodes"),
        ("K.full", "", "cannot be read|ansys-mapdl-reader"),
        ("K.pch", "DMIG*   MAAX\n", "begins with K, has 0"),
        ("K.mtx", "1, 2, 3, 4\n", "4 numbers a line, needs 5"),
        (
            "K.pch",
            2 * f"DMIG*   {'K':16}{1:16d}{1:16d}\n*       {1:16d}{1:16d}1.0\n",
            "K.pch: .*twice",
        ),
        ("K.pch", f"DMIG*   {'K':16}{1:16d}{1:16d}\n*       {1:16d}{1:16d}1.0D+0", "cut short"),
        ("K.pch", "", "begins with K, has 0"),
        ("K.mtx", 2 * "1,1, 1,1, 2.0\n", "K.mtx: names an entry twice: one matrix a file"),
        ("K.mtx", 2 * "1 1 2.0\n", "K.mtx: names an entry twice"),
        ("K.mtx", "1,1, 1,1, nan\n", "not finite"),
        ("J.sti", "1 1 2.0\n", "J.dof: cannot be read"),
        # entries that would be lost
        (
            "K.mtx",
            HEAD.format("coordinate", "complex", "general", "1 1 1 .5\n2 2 2 0\n"),
            "complex",
        ),
        (
            "K.mtx",
            HEAD.format("coordinate", "pattern", "general", "1 1\n2 2\n"),
            "not their values",
        ),
        ("K.mtx", HEAD.format("coordinate", "real", "skew-symmetric", "2 1 1.\n"), "is skew-sym"),
        ("K.mtx", HEAD.format("coordinate", "real", "general", "1 1 1,5\n2 2 2,0\n"), "'1,5'"),
        ("K.mtx", HEAD.format("coordinate", "real", "general", "1 1 1.5+3\n2 2 2\n"), "1.5.3"),
        (
            "K.mtx",
            HEAD.format("coordinate", "real", "general", "1 1 1. 7\n2 2 2. 8\n"),
            "4 numbers",
        ),
        ("K.mtx", HEAD.format("coordinate", "real", "general", "1 1 1.\n"), "has 1 entries.* 2"),
        ("K.mtx", HEAD.format("coordinate", "real", "general", "0 0 1.\n1 1 2.\n"), "from 1"),
        ("K.mtx", "0, 0, 1.0\n1, 1, 2.0\n", "in row or column 0: .* counted from 1"),
        ("K.sti", "1 1 1.0 2.0\n2 2 2.0 1.0\n", "4 numbers a line, needs 3"),
        (
            "K.pch",
            f"DMIG*   {'K':16}{1:16d}{1:16d}\n*       {1:16d}{1:16d}{'1.0D+0':>16}{'.5':>16}\n",
            "is complex",
        ),
    ],
)
def test_file_that_is_not_read_whole_is_refused(file, text, fault, tmp_path):
    (tmp_path / file).write_text(text)
    (tmp_path / "K.dof").write_text("1.1\n1.2\n")
    refused(ElsewhereError, read_matrix, tmp_path / file, "K", match=fault)


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("K.mtx", HEAD.format("coordinate", "real", "general", "1 1 1.5D+03\n2 2 2.0d0\n")),
        ("K.mtx", HEAD.format("coordinate", "complex", "general", "1 1 1.5E3 0\n2 2 2 0.0\n")),
        (
            "K.mtx",
            HEAD.format("array", "real", "general", "1.5D3\n0\n0\n2.0\n").replace("2 2 2", "2 2"),
        ),
        ("K.mtx", "1, 1, 1.5D+3\n2, 2, 2.0\n"),
        ("K.mtx", "1,1, 1,1, 1.5D+3\n1,2, 1,2, 2.0\n"),
        ("K.sti", "1 1 1.5D+3\n2 2 2.0\n"),
    ],
)
def test_exponents_of_fortran_are_read(file, text, tmp_path):
    """`mmread` ends a number at the D: 1.5."""
    (tmp_path / file).write_text(text)
    (tmp_path / "K.dof").write_text("1.1\n1.2\n")
    assert read_matrix(tmp_path / file, "K").A.toarray().tolist() == [[1500.0, 0.0], [0.0, 2.0]]


@pytest.mark.parametrize(
    ("text", "rows"),
    [
        ("5,17, 5,17, 2.0\n", [[5, 17]]),  # also numbers that no node of a solid has
        ("** rows\n\n*MATRIX\n5,1, 5,1, 2.0\n", [[5, 1]]),  # lines before are left out
    ],
)
def test_rows_are_those_of_the_file(text, rows, tmp_path):
    (tmp_path / "K.mtx").write_text(text)
    assert read_matrix(tmp_path / "K.mtx", "K").rows.tolist() == rows


def test_names_of_rows_are_among_the_files_that_are_watched():
    files = map(str, settings({"file": "b.inp", "unit": "mm"} | ENDS, "A.MAS", "B.sti").files)
    assert {"A.dof", "B.dof"} <= {*files}


class Job(NamedTuple):
    """A deck in m, and files that CalculiX wrote of it by speed (rad/s)."""

    folder: Path
    cells: calculix.Cells
    K: dict[float, str]

    @property
    def mesh(self):
        return {"file": "blade.inp", "unit": "m"} | ENDS

    def read(self):
        given = settings(self.mesh, "rest.mas", self.K)
        return given, read_matrices(given, "given", self.folder)


SPEEDS = {0.0: "rest", 325.0: "s325", 563.0: "s563", 650.0: "s650"}


def run_jobs(blade, kind, points, nodes, groups, folder) -> Job:
    exports.write_inp(folder / "blade.inp", points, nodes, groups, kind)
    cells = calculix.Cells(kind, points, nodes, np.unique(groups["root"]))
    for speed, name in SPEEDS.items():
        calculix.matrices(cells, blade.material, speed, folder / name)
    return Job(folder, cells, {speed: f"{name}.sti" for speed, name in SPEEDS.items()})


@pytest.fixture(scope="module")
def straight(coarse_blade, coarse_mesh, tmp_path_factory) -> Job:
    """Ten-node tetrahedra with straight sides."""
    parts = exports.parts(coarse_mesh.mesh)
    points = 1e-3 * parts.points
    points[parts.cells[:, 4:]] = points[parts.cells[:, EDGES]].mean(axis=2)
    folder = tmp_path_factory.mktemp("straight")
    return run_jobs(coarse_blade, "C3D10", points, parts.cells, parts.facets, folder)


@needs_ccx
def test_tetrahedra_of_calculix_are_ours_at_its_points(straight, coarse_blade, tmp_path):
    """K entry by entry; M if it is integrated at the four points that CalculiX takes.

    They are not exact for a mass, whose integrand is of fourth degree: with exact M frequencies
    differ by 9e-8 in f1 to 1e-4 in the tenth on these coarse cells, and on four times finer ones by
    4e-9 to 2e-6.
    """
    _, fom = straight.read()
    own = exports.as_meshed(coarse_blade, "blade.inp", interface={"patches": 8, "across": 1})
    geometry = check_settings(MeshGeometry, mesh_file(straight.mesh).model_dump(), "test")
    own = own.model_copy(update={"mesh_file": geometry})
    mesh = tmp_path / "blade.msh"
    build_mesh(own, mesh, straight.folder / "blade.inp")
    solid = read_solid(str(mesh), own.material)
    u, v = TrialFunction(solid.V), TestFunction(solid.V)
    at_four = dx(solid.mesh, metadata={"quadrature_degree": 2})
    M = solid.matrix(own.material.density_kg_m3 * inner(u, v) * at_four)
    ours = assemble(own, "own", mesh, [0.0])
    _, at = KDTree(ours.coordinates).query(fom.coordinates)
    order = (3 * at[:, None] + np.arange(3)).ravel()
    for theirs, A in (fom.K[0], ours.K[0]), (fom.M, M):
        assert abs(theirs - A[order][:, order]).max() < 1e-10 * abs(A).max()
    found = frequencies(fom.M, fom.K[0])
    np.testing.assert_allclose(found, frequencies(M, ours.K[0]), rtol=1e-6)
    np.testing.assert_allclose(found, frequencies(ours.M, ours.K[0]), rtol=2e-4)


@needs_ccx
def test_between_its_speeds_the_reduced_model_is_calculix(straight, coarse_blade):
    """Measured 1e-5 to 3e-5."""
    given, fom = straight.read()
    rom, _ = reduce(fom, given.basis, "r")
    for speed in (162.5, 450.0, 610.0):
        theirs = calculix.frequencies(straight.cells, coarse_blade.material, speed).frequencies
        found = rom.modes(speed)[0][:10] / (2 * np.pi)
        np.testing.assert_allclose(found, theirs, rtol=1e-4)


@pytest.mark.nightly
@needs_ccx
@pytest.mark.parametrize("kind", ["C3D20R", "C3D15"])
def test_bricks_of_calculix_keep_its_frequencies(kind, coarse_blade, tmp_path):
    """Split for the tip alone; M and K stay those of bricks, with fewer points, and of wedges.

    Measured with the default basis: 9e-6.
    """
    bricks = Bricks(coarse_blade.sections, 10, 1, 20)
    points, nodes, groups = bricks.parts({"C3D20R": "hexahedron", "C3D15": "wedge"}[kind], True)
    job = run_jobs(coarse_blade, kind, 1e-3 * points, nodes, groups, tmp_path)
    given, fom = job.read()
    finer = given.basis.model_copy(update={"rank_tolerance": 1e-5})
    roms = {share: reduce(fom, of, "r")[0] for share, of in ((1e-6, finer), (2e-5, given.basis))}
    for speed in SPEEDS:
        theirs = calculix.frequencies(job.cells, coarse_blade.material, speed).frequencies
        for share, rom in roms.items():
            found = rom.modes(speed)[0][:10] / (2 * np.pi)
            np.testing.assert_allclose(found, theirs, rtol=share)


def test_files_of_ansys_give_its_frequencies():
    """The beam that the reader comes with; its pages print 1283.2, 5782.0 and 6919.4 Hz."""
    reader = pytest.importorskip("ansys.mapdl.reader")
    from ansys.mapdl.reader.examples import fullfile

    M, K = (read_matrix(Path(fullfile), letter) for letter in "MK")
    full = reader.read_binary(fullfile)
    full.load_km()
    clamped = np.unique(full.const[:, 0])
    free = np.setdiff1d(K.rows[:, 0], clamped)
    nothing = np.empty((0, 3))
    deck = Deck(free, clamped, nothing, 0.0, nothing, nothing, csr_matrix((0, len(free))))
    found = frequencies(deck.matrix(M), deck.matrix(K), 5)
    expected = [1283.20036921, 1283.20036921, 5781.97486169, 6919.39887714, 6919.39887714]
    np.testing.assert_allclose(found, expected, rtol=1e-9)


PAGE = (ROOT / "fem/matrices.md").read_text()


@needs_ccx
def test_example_of_the_page(coarse_mesh, tmp_path):
    """Its script on the coarse blade in mm, and its blade's file on the files of the script.

    f1 is that of CalculiX's own solver on this mesh.
    """
    parts = exports.parts(coarse_mesh.mesh)
    exports.write_inp(tmp_path / "blade.inp", parts.points, parts.cells, parts.facets)
    script, blade = (
        re.search(rf"```{kind}\n(.*?)```", PAGE, re.DOTALL)[1] for kind in ("bash", "yaml")
    )
    subprocess.run(["bash", "-e", "-c", script], cwd=tmp_path, check=True, capture_output=True)
    given = check_settings(MatricesElsewhere, yaml.safe_load(blade), "the page")
    fom = read_matrices(given, "mine", tmp_path)
    assert list(fom.speeds) == [0, 325, 563, 650]
    assert frequencies(fom.M, fom.K[0])[0] == pytest.approx(259.310, rel=1e-5)
    assert frequencies(fom.M, fom.K[3])[0] == pytest.approx(356.239, rel=1e-5)
