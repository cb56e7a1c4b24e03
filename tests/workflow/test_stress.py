"""Stress of a sweep from shapes of its motion, against all its states through the fields."""

import numpy as np
import pytest
import pyvista as pv
from projects import ROOT
from scenes import RUBBING
from scipy.spatial import cKDTree

from fem.fatigue import largest_cycle, margin, von_mises
from fem.fields import TENSOR, away, fields
from fem.solid import read_solid
from geometry.blade import RPM, Fatigue
from rom.reconstruct import Basis
from simulate.scene import GROWING, Scene
from simulate.sweeps.over_speeds import as_sweep, at_speeds
from workflow import stress as job
from workflow.stress import cycles, numbers, worst

STRENGTH = {"endurance_MPa": 500, "yield_MPa": 900, "ultimate_MPa": 1000}
SPEEDS = [0.3, 0.34, 0.36]  # over f1(0)


@pytest.fixture(scope="module")
def sweep(coarse_rom):
    record = {"spectrum_rounds": 4, "samples_per_round": 256, "motion": 2}
    scene = Scene.load(ROOT / "workflow/scenes/paper-e10.yaml").but(
        blade="coarse",
        speeds={"over_f1": SPEEDS},
        rounds=8,
        peaks=None,
        record=record,
        liner__strips=8,
        **RUBBING,
    )
    speeds = 2 * np.pi * coarse_rom.f1 * np.array(SPEEDS)
    runs = as_sweep(at_speeds(scene, coarse_rom, speeds))
    return runs.assign(trend=("speed_over_f1", ["steady", GROWING, "steady"]))


@pytest.fixture(scope="module")
def basis_file(coarse_matrices, coarse_reduced, tmp_path_factory):
    rom, T = coarse_reduced
    path = tmp_path_factory.mktemp("stress") / "basis.h5"
    Basis.of(coarse_matrices, T, rom.provenance).save(path)
    return path


@pytest.fixture(scope="module")
def written(coarse_blade, coarse_mesh, coarse_rom, basis_file, sweep):
    blade = coarse_blade.but(fatigue=STRENGTH)
    vtu = basis_file.with_name("stress.vtu")
    names = {"scene": "mine", "blade": "coarse"}
    mesh = str(coarse_mesh.mesh)
    return job.write(blade, mesh, coarse_rom, str(basis_file), sweep, names, str(vtu)), vtu


def test_the_worst_node_is_that_of_all_states_marched_through_the_fields(
    written, sweep, coarse_blade, coarse_mesh, basis_file
):
    """Nonlinear fields of every recorded state; the linear ones differ by a share of a percent."""
    told, vtu = written
    row = told["speeds"][2]
    run, basis = sweep.isel(speed_over_f1=2), Basis.load(basis_file)
    static = basis.static(float(run["speed"]))
    states = run["motion"].values[~np.isnan(run["motion"].values).any(axis=1)]
    found = [
        fields(coarse_blade, coarse_mesh.mesh, basis.coordinates, static, basis.reconstruct(u))
        for u in states
    ]
    mean, alternating = largest_cycle(np.array([of.total.stress[:, *TENSOR] for of in found]))
    settled = away(read_solid(str(coarse_mesh.mesh), coarse_blade.material))
    margins = margin(mean, alternating, Fatigue(**STRENGTH))[settled]
    node = np.flatnonzero(settled)[margins.argmin()]
    assert row["at"] == pytest.approx((1e3 * found[0].points[node]).tolist(), abs=1e-6)
    assert row["unit"] == "mm" and row["missed"] < 0.05
    assert row["alternating"] == pytest.approx(alternating[node], rel=0.01)
    assert row["mean_stress"] == pytest.approx(mean[node], rel=0.01)
    assert row["margin"] == pytest.approx(margins.min(), rel=0.01)
    grid, near = pv.read(vtu), cKDTree(found[0].points)
    (name,) = (name for name in grid.point_data if name.startswith("alternating"))
    of_file = grid[name][near.query(grid.points)[1].argsort()]
    largest = alternating[settled].max()
    assert abs(of_file - alternating)[settled].max() < 0.1 * largest


def test_nothing_is_told_of_a_growing_motion(written):
    told, _ = written
    assert [row.get("margin") is None for row in told["speeds"]] == [False, True, False]
    assert told["speeds"][1].keys() == {"speed_over_f1", "trend", "missed"}
    assert told["fatigue"] == STRENGTH | {"line": "goodman"}


def test_the_file_has_the_fields_of_the_reported_runs(written, sweep, coarse_blade, coarse_mesh):
    told, vtu = written
    grid = pv.read(vtu)
    solid = read_solid(str(coarse_mesh.mesh), coarse_blade.material)
    settled = away(solid)
    np.testing.assert_array_equal(grid["away from clamp and contact"], settled)
    (name,) = (name for name in grid.point_data if name.startswith("margin"))
    (speed,) = np.flatnonzero([f"{RPM * of:.0f} rpm" in name for of in sweep["speed"].values])
    row = told["speeds"][speed]
    assert grid[name][settled].min() == pytest.approx(row["margin"], rel=1e-9)
    node = int(np.linalg.norm(1e3 * grid.points - row["at"], axis=1).argmin())
    for what, head in (("mean_stress", "mean stress"), ("alternating", "alternating stress")):
        field = grid[name.replace("margin", f"{head} (Pa)")]
        assert field[node] == pytest.approx(row[what], rel=1e-9)


@pytest.mark.parametrize("times", [60, 3])  # also fewer than shapes
@pytest.mark.parametrize("fatigue", [Fatigue(**STRENGTH), None])
def test_the_search_by_bounds_finds_the_worst_of_all_nodes(fatigue, times):
    rng = np.random.default_rng(5)
    sigma = 1e7 * rng.normal(size=(5, 700, 6)) * [[[10]], *[[[1]]] * 4]
    a = np.hstack([np.ones((times, 1)), rng.normal(size=(times, 4)) * [3, 1, 0.3, 0.1]])
    mean, alternating = cycles(sigma, a)
    of_all = numbers(*largest_cycle(np.tensordot(a, sigma, 1)), fatigue)
    np.testing.assert_allclose(mean, of_all["mean_stress"], rtol=1e-9)
    np.testing.assert_allclose(alternating, of_all["alternating"], rtol=1e-9)
    node, found = worst(sigma, a, fatigue)
    least = of_all["margin"] if fatigue else -of_all["alternating"]
    assert node == least.argmin()
    assert found == pytest.approx({name: of[node] for name, of in of_all.items()}, rel=1e-9)
    assert np.all(alternating <= np.ptp(a, axis=0) / 2 @ von_mises(sigma) * (1 + 1e-12))
