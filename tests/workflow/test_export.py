"""A scene's model and sweep for other programs, in the axes and unit of the blade's file."""

import re
import shutil

import numpy as np
import pandas as pd
import pytest
import pyvista as pv
import xarray as xr
import yaml
from exports import MIRRORED, as_meshed, parts, write_inp
from numpy.testing import assert_allclose, assert_array_equal
from projects import Project
from scipy.io import loadmat
from scipy.linalg import eigh
from scipy.spatial import KDTree

from fem.matrices import Matrices
from geometry.base import RPM
from geometry.blade import Blade
from geometry.frame import rotation
from rom.full_model import FullModel
from rom.model import Rom
from rom.reconstruct import Basis
from workflow.export import MOST_STEPS, steps

pytestmark = pytest.mark.slow  # of whole sweeps
SCENE = "results/paper/paper-e1"
AXES = {"downstream": "x", "radial": "-y", "rotation": "left-handed"}


def export(project, *words, expect=0):
    return project.call("workflow.export", *words, expect=expect)


@pytest.fixture(scope="module")
def exported(swept, tmp_path_factory):
    """The project with its sweeps, of which scene `paper-e1` is exported at two speeds."""
    folder = tmp_path_factory.mktemp("export") / "project"
    copy = Project(shutil.copytree(swept.folder, folder, symlinks=True))
    export(copy, "paper-e1", "0", "5415.5")
    return copy


@pytest.fixture(scope="module")
def arrays(exported):
    return dict(np.load(exported.folder / SCENE / "export/model.npz"))


@pytest.fixture(scope="module")
def turned(exported, kept):
    """The blade as a deck in mm with the engine axis x, left-handed: run and exported.

    Its deck and its arrays.
    """
    points, cells, facets = parts(exported.folder / "results/paper/blade.msh")
    x, y, z = points.T
    deck = np.column_stack([z, -x, y])

    def turn(project):
        blades, scenes = (project.folder / f"workflow/{kind}s" for kind in ("blade", "scene"))
        write_inp(blades / "turned.inp", deck, cells[:, MIRRORED], facets)
        blade = as_meshed(Blade.load(blades / "paper.yaml"), "turned.inp", frame=AXES)
        values = blade.model_dump(mode="json", exclude_unset=True)
        (blades / "turned.yaml").write_text(yaml.safe_dump(values))
        of_one = {"speeds": {"over_f1": [0.34]}, "peaks": None}
        scene = {"base": "paper-e1", "blade": "turned"} | of_one
        (scenes / "turned.yaml").write_text(yaml.safe_dump(scene))

    asked = ("results/turned/turned/sweep.nc", "--config", "explore=[turned]")
    made = kept("turned", *asked, change=turn)
    turn(exported)
    shutil.copytree(made.folder / "results/turned", exported.folder / "results/turned")
    export(exported, "turned", "0")
    return deck, dict(np.load(exported.folder / "results/turned/turned/export/model.npz"))


def first_modes(arrays, at, count=5):
    """Frequencies, Hz, and displacements (count, nodes, 3) from exported arrays alone."""
    squares, Phi = eigh(arrays["K_at"][at], arrays["M"])
    shapes = (arrays["T"] @ Phi[:, :count]).T
    return np.sqrt(squares[:count]) / (2 * np.pi), shapes.reshape(count, -1, 3)


def test_matlab_and_numpy_get_the_same_arrays_those_of_the_model(exported, arrays):
    """With K at the speeds that were asked for."""
    rom = Rom.load(exported.folder / "results/paper/rom-r.nc")
    of_matlab = loadmat(exported.folder / SCENE / "export/model.mat")
    assert {name for name in of_matlab if not name.startswith("__")} == arrays.keys()
    for name, values in arrays.items():
        if np.size(values):  # MATLAB has no vector of none
            assert_array_equal(np.squeeze(of_matlab[name]), np.squeeze(values), name)
    for name in ("M", "K", "xi", "camber", "Omega_m", "f1", "span", "growth", "speeds"):
        assert_array_equal(arrays[name], getattr(rom, name), name)
    assert arrays["directions"].tolist() == ["radial"]
    assert_allclose(arrays["Omega"], [0.0, 5415.5 / RPM])
    for K, Omega in zip(arrays["K_at"], arrays["Omega"], strict=True):
        powers = Omega ** arrays["power"]
        assert_allclose(K, np.tensordot(powers, arrays["K"], 1), rtol=1e-12)
        assert_array_equal(K, rom.stiffness(Omega))


def test_frequencies_at_rest_are_those_of_the_full_model(exported, arrays):
    full = FullModel.load(exported.folder / "results/paper/full-model.nc")
    frequencies, _ = first_modes(arrays, 0)
    assert_allclose(frequencies, full.omega[0, :5] / (2 * np.pi), rtol=1e-3)


@pytest.mark.parametrize("blade", ["paper", "turned"])
def test_modes_have_unit_mass_through_the_basis(blade, exported, arrays, turned):
    """In the full mass matrix, which is in the blade's frame, m."""
    given, R, metres = arrays, np.eye(3), 1e-3
    if blade == "turned":
        settings = Blade.load(exported.folder / "workflow/blades/turned.yaml")
        given, R = turned[1], rotation(settings.source.frame)
    fom = Matrices.load(exported.folder / f"results/{blade}/matrices.h5")
    places = metres * given["coordinates"] @ R.T
    distance, node = KDTree(places).query(fom.coordinates)
    assert distance.max() < 1e-9
    _, shapes = first_modes(given, 0)
    u = metres * (shapes @ R.T)
    free = u[:, node].reshape(len(u), -1)
    assert_allclose(free @ (fom.M @ free.T), np.eye(len(u)), atol=1e-9)
    clamped = np.setdiff1d(np.arange(len(places)), node)
    assert len(clamped) > 10 and not u[:, clamped].any()


def test_nodes_and_cells_are_those_of_the_deck_in_its_axes_and_unit(turned):
    """And its cells are upright there, which the blade's frame mirrors."""
    deck, given = turned
    distance, at = KDTree(deck).query(given["coordinates"])
    assert distance.max() < 1e-6 and len({*at}) == len(deck)
    corners = given["coordinates"][given["cells"][:, :4]]
    edges = corners[:, 1:] - corners[:, :1]
    assert (np.linalg.det(edges) > 0).all()
    assert given["unit"] == "mm"


def test_a_mode_of_the_deck_is_that_of_the_blade_in_its_own_frame(arrays, turned):
    """Engine axis x: u_z of ours is u_x of the deck, u_x its -u_y, u_y its u_z, in mm."""
    own, (_, given) = arrays, turned
    (f, ours), (of_deck, theirs) = first_modes(own, 0, 1), first_modes(given, 0, 1)
    assert_allclose(of_deck, f, rtol=1e-6)
    places = own["coordinates"] @ np.array([[0, -1, 0], [0, 0, 1], [1, 0, 0]])
    _, node = KDTree(places).query(given["coordinates"])
    x, y, z = ours[0, node].T
    expected = np.column_stack([z, -x, y])
    sign = np.sign(np.vdot(expected, theirs[0]))
    assert_allclose(sign * theirs[0], expected, atol=1e-4 * abs(expected).max())


@pytest.mark.parametrize(("rpm", "at"), [("0", 0), ("5416", 1)])
def test_pictures_of_modes_are_those_of_the_arrays(rpm, at, exported, arrays):
    """Of unit mass through T, by which their reduced coordinates are found; with frequencies."""
    grid = pv.read(exported.folder / SCENE / f"export/modes-{rpm}rpm.vtu")
    assert_allclose(grid.points, arrays["coordinates"])
    assert_array_equal(grid.cells_dict[pv.CellType.QUADRATIC_TETRA], arrays["cells"])
    frequencies, _ = first_modes(arrays, at, 10)
    names = [f"mode {i} ({f:.1f} Hz)" for i, f in enumerate(frequencies, 1)]
    assert grid.point_data.keys() == names
    shapes = np.column_stack([grid[name].ravel() for name in names])
    q = np.linalg.lstsq(arrays["T"], shapes)[0]
    assert_allclose(arrays["T"] @ q, shapes, atol=1e-9 * abs(shapes).max())
    assert_allclose(q.T @ arrays["M"] @ q, np.eye(10), atol=1e-7)
    squares = (2 * np.pi * frequencies) ** 2
    assert_allclose(np.diag(q.T @ arrays["K_at"][at] @ q), squares, rtol=1e-6)


def test_time_steps_are_static_deflection_and_motion_of_the_nearest_speed(exported):
    """By basis and sweep alone, at the free nodes; 5415.5 rpm is nearest to 5290 rpm."""
    files = sorted((exported.folder / SCENE / "export/steps-5290rpm").iterdir())
    assert files[7].name == "steps-5290rpm-0007.vtu"
    basis = Basis.load(exported.folder / "results/paper/basis-r.h5")
    with xr.open_dataset(exported.folder / SCENE / "sweep.nc", engine="h5netcdf") as sweep:
        run = sweep.sel(speed_over_f1=0.34)
        run = run.isel(motion_time=np.isfinite(run["motion"]).all("dof").values)
        assert len(files) == run.sizes["motion_time"] == 128
        for at in (0, 7, 127):
            grid = pv.read(files[at])
            assert grid.field_data["TimeValue"][0] == float(run["motion_time"][at])
            _, node = KDTree(1e-3 * grid.points).query(basis.coordinates)
            vibration = basis.T @ run["motion"][at].values
            powers = float(run["speed"]) ** (2 * np.arange(1, len(basis.u_static) + 1))
            total = powers @ basis.u_static + vibration
            scale = abs(total).max()
            for name, u in (("vibration (mm)", vibration), ("displacement (mm)", total)):
                assert_allclose(1e-3 * grid[name][node].ravel(), u, atol=1e-6 * scale)


def test_pictures_are_in_axes_and_unit_of_the_deck(exported, turned):
    """The tip grows outward, along -y, by what the reduced model says of its radius, in mm."""
    deck, given = turned
    folder = exported.folder / "results/turned/turned/export"
    modes = pv.read(folder / "modes-0rpm.vtu")
    assert KDTree(deck).query(modes.points)[0].max() < 1e-6
    _, shapes = first_modes(given, 0, 1)
    shape = modes[modes.array_names[0]]
    assert_allclose(abs(shape), abs(shapes[0]), atol=1e-9 * abs(shape).max())
    (series,) = folder.glob("steps-*")
    first = pv.read(sorted(series.iterdir())[0])
    static = first["displacement (mm)"] - first["vibration (mm)"]
    with xr.open_dataset(folder.parent / "sweep.nc", engine="h5netcdf") as sweep:
        rom = Rom.load(exported.folder / "results/turned/rom-r.nc")
        grown = 1e3 * rom.growth_at(np.linspace(0, 1, 9), float(sweep["speed"][0]))
    radius = np.hypot(*first.points[:, 1:].T)
    outward = -static[radius > radius.max() - 0.1, 1]
    assert grown.min() - 2e-3 < outward.mean() < grown.max() + 2e-3


def test_of_many_time_steps_every_third_is_exported(tmp_path):
    basis = Basis(np.eye(3)[:, :1], np.zeros((1, 3)), np.zeros((1, 3)), 9.0, None)
    motion = np.arange(401.0)[:, None]
    run = xr.Dataset(
        {"motion": (("motion_time", "dof"), motion), "speed": 1.0},
        {"motion_time": motion[:, 0]},
    )
    cells = np.empty((0, 10), int)
    steps(run, cells, basis, "m", tmp_path)
    files = sorted((tmp_path / "steps-10rpm").iterdir())  # 1 rad/s
    assert len(files) == 134 <= MOST_STEPS
    shown = [pv.read(path)["vibration (m)"][0, 0] for path in files[:3]]
    assert shown == [0, 3, 6]
    steps(run.isel(motion_time=slice(200)), cells, basis, "m", tmp_path / "short")
    assert len([*(tmp_path / "short/steps-10rpm").iterdir()]) == 200


def test_what_was_exported_before_is_not_mixed_with_it(exported, tmp_path):
    copy = Project(shutil.copytree(exported.folder, tmp_path / "copy", symlinks=True))
    said = export(copy, "paper-e1", "5600")
    names = {path.name for path in (copy.folder / SCENE / "export").iterdir()}
    pictures = {"modes-5600rpm.vtu", "steps-5602rpm"}
    assert names == pictures | {"model.mat", "model.npz", "sweep.csv"}
    assert all(name in said for name in names)


def test_the_table_has_what_is_one_number_of_each_run(exported):
    with xr.open_dataset(exported.folder / SCENE / "sweep.nc", engine="h5netcdf") as sweep:
        table = pd.read_csv(exported.folder / SCENE / "export/sweep.csv")
        assert len(table) == sweep.sizes["speed_over_f1"]
        for column, name in (("displacement (m)", "displacement"), ("speed (rad s-1)", "speed")):
            assert_allclose(table[column], sweep[name])
        assert table["status"].tolist() == sweep["status"].values.tolist()
        assert table["trend"].tolist() == sweep["trend"].values.tolist()
        assert_allclose(table["rpm"], sweep["speed"] * 60 / (2 * np.pi))
        deepest = [run["wear"].values.max() for _, run in sweep.groupby("speed_over_f1")]
        assert_allclose(table["largest wear (m)"], deepest)
        single = {name for name, of in sweep.variables.items() if of.dims == ("speed_over_f1",)}
        named = {re.sub(r" \(.*\)$", "", column) for column in table}
        assert named == single | {"rpm", "largest wear"}


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "SCENE: no workflow/scenes/.yaml; of these there are results: paper-e1, "),
        (("none",), "none: no workflow/scenes/none.yaml; of these there are results: paper-e1, "),
        (("long-20",), "no result yet: ./run snakemake results/paper/long-20/sweep.nc, then"),
        (("five-factors",), "five-factors: its design makes tables, and no sweep"),
        (("paper-e1", "fast"), "'fast' is no number; needs RPM"),
        (("paper-e1", "-1"), "speed -0.10472 rad/s is outside [0, 650] rad/s (-1 rpm, highest 6"),
        (("paper-e1", "100", "9000"), "rad/s (9000 rpm, highest 6207.04)"),
    ],
)
def test_what_is_refused_in_one_line(words, said, exported):
    before = sorted((exported.folder / SCENE / "export").iterdir())
    error = export(exported, *words, expect=2)
    assert said in error and error.count("\n") == 1
    assert sorted((exported.folder / SCENE / "export").iterdir()) == before


def test_a_basis_of_another_model_is_refused(exported, turned, tmp_path):
    copy = Project(shutil.copytree(exported.folder, tmp_path / "copy", symlinks=True))
    blades = copy.folder / "results"
    shutil.copy(blades / "turned/basis-r.h5", blades / "paper/basis-r.h5")
    assert "basis-r.h5: is of blade turned, " in export(copy, "paper-e1", expect=2)
