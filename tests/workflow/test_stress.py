"""Stress of a sweep from shapes of its motion, against all its states through the fields."""

from dataclasses import replace

import numpy as np
import pytest
import pyvista as pv
from runs import of_paper
from scipy.spatial import cKDTree

from fem.fatigue import FIVE, damage, margin, numbers, reserve, uniaxial, von_mises
from fem.fields import TENSOR, airfoil, dofs_at, fields, linearised
from fem.solid import read_solid
from fem.worst_node import NodeStress, cycles, worst
from geometry.base import ProvenanceError
from geometry.blade import Fatigue
from rom.coarser import coarser
from rom.polynomial import evaluate
from simulate.errors.model_errors import ModelError
from simulate.scene import GROWING
from simulate.sweeps.peak_results import (
    at_node,
    case_of,
    mesh_errors,
    results,
    stress_of,
    through,
    to_march,
    with_rotation,
    worst_stressed,
)
from workflow import stress as job
from workflow.shapes import Shapes, motion, stresses

STRENGTH = {"endurance_MPa": 500, "yield_MPa": 900, "ultimate_MPa": 1000}
STEEP = Fatigue(**STRENGTH, slope_k=9)
SPEEDS = [0.3, 0.34, 0.36]  # over f1(0)


@pytest.fixture(scope="module")
def sweep(coarse_rom):
    runs = of_paper(coarse_rom, SPEEDS, 8)
    return runs.assign(trend=("speed_over_f1", ["steady", GROWING, "steady"]))


@pytest.fixture(scope="module")
def basis_file(coarse_basis, tmp_path_factory):
    path = tmp_path_factory.mktemp("stress") / "basis.h5"
    coarse_basis.save(path)
    return path


@pytest.fixture(scope="module")
def solid(coarse_blade, coarse_mesh):
    return read_solid(str(coarse_mesh.mesh), coarse_blade.material)


@pytest.fixture(scope="module")
def written(coarse_blade, coarse_mesh, coarse_rom, basis_file, sweep):
    return write(coarse_blade.but(fatigue=STRENGTH), coarse_mesh, coarse_rom, basis_file, sweep)


def write(blade, mesh, rom, basis_file, sweep):
    """What is told, and the file of the fields."""
    vtu, names = basis_file.with_name("stress.vtu"), {"scene": "mine", "blade": "coarse"}
    return job.write(blade, str(mesh.mesh), rom, str(basis_file), sweep, names, str(vtu)), vtu


@pytest.mark.slow
def test_the_worst_node_is_that_of_all_states_marched_through_the_fields(
    written, sweep, coarse_blade, coarse_mesh, coarse_basis, solid
):
    """Nonlinear fields of every state of its revolution; the linear ones differ by a percent."""
    told, vtu = written
    row = told["speeds"][2]
    static = coarse_basis.static(float(sweep.isel(speed_over_f1=2)["speed"]))
    found = [
        fields(
            coarse_blade,
            coarse_mesh.mesh,
            coarse_basis.coordinates,
            static,
            coarse_basis.reconstruct(u),
        )
        for u in job.revolutions(sweep)[2][row["revolution"]]
    ]
    total = np.array([of.total.stress[:, *TENSOR] for of in found])
    mean, alternating = cycles(total, np.eye(len(total)))
    settled, _ = airfoil(solid, coarse_blade.stress)
    margins = margin(mean, alternating, Fatigue(**STRENGTH))[settled]
    node = np.flatnonzero(settled)[margins.argmin()]
    assert row["at"] == pytest.approx((1e3 * found[0].points[node]).tolist(), abs=1e-6)
    assert row["at_m"] == found[0].points[node].tolist()
    assert row["unit"] == "mm" and row["missed"] < 0.05
    assert row["alternating"] == pytest.approx(alternating[node], rel=0.01)
    assert row["mean_stress"] == pytest.approx(mean[node], rel=0.01)
    assert row["margin"] == pytest.approx(margins.min(), rel=0.01)
    grid, near = pv.read(vtu), cKDTree(found[0].points)
    name = f"alternating stress (Pa), {row['rpm']:.0f} rpm"
    of_file = grid[name][near.query(grid.points)[1].argsort()]
    largest = alternating[settled].max()
    assert abs(of_file - alternating)[settled].max() < 0.1 * largest


def test_a_growing_motion_has_the_stress_that_it_reached(written):
    told, _ = written
    row = told["speeds"][1]
    assert row["trend"] == GROWING and row["alternating"] > 0
    assert told["fatigue"] == STRENGTH | {"line": "goodman"}
    assert told["worst"] == min(told["speeds"], key=reserve)["speed_over_f1"]


def test_the_file_has_the_fields_of_the_reported_runs_and_of_the_worst(
    written, coarse_blade, solid
):
    """In single precision."""
    told, vtu = written
    grid = pv.read(vtu)
    settled, distance = airfoil(solid, coarse_blade.stress)
    assert (told["root"], told["away_m"], told["too_near"]) == ("sharp", distance, None)
    np.testing.assert_array_equal(grid["away from clamp and contact"], settled)
    rows = [row for row in told["speeds"] if "mesh" in row]
    assert told["worst"] in [row["speed_over_f1"] for row in rows]
    assert len([name for name in grid.point_data if name.startswith("margin")]) == len(rows)
    for row in rows:
        margins = grid[f"margin, {row['rpm']:.0f} rpm"]
        assert margins[settled].min() == pytest.approx(row["margin"], rel=1e-5)
        node = int(np.linalg.norm(grid.points - row["at_m"], axis=1).argmin())
        for what, head in (("mean_stress", "mean stress"), ("alternating", "alternating stress")):
            field = grid[f"{head} (Pa), {row['rpm']:.0f} rpm"]
            assert field[node] == pytest.approx(row[what], rel=1e-5)
    tip = solid.V.tabulate_dof_coordinates()[np.unique(solid.tip)]
    edges = [told["edges"][name][2] for name in ("LE", "TE")]
    assert edges == [tip[:, 2].min(), tip[:, 2].max()]


@pytest.mark.parametrize("times", [60, 3])  # also fewer than shapes
@pytest.mark.parametrize("fatigue", [Fatigue(**STRENGTH), None])
def test_the_search_by_bounds_finds_the_worst_of_all_nodes(fatigue, times):
    """Of two revolutions, the second of which moves more; and mean stress of rotation alone."""
    rng = np.random.default_rng(5)
    sigma = 1e7 * rng.normal(size=(5, 1700, 6)) * [[[10]], *[[[1]]] * 4]
    of_each = []
    for size in (1, 1.1):
        a = size * rng.normal(size=(times, 4)) * [3, 1, 0.3, 0.1]
        of_each.append(with_rotation(a))
    found, which = worst(
        (sigma @ FIVE.T).astype(np.float32), lambda n: sigma[:, n], of_each, fatigue
    )
    direct = [cycles(np.tensordot(a, sigma, 1), np.eye(times)) for a in of_each]
    left = [reserve(numbers(*of, fatigue)) for of in direct]
    assert (which, found) == np.unravel_index(np.argmin(left), np.shape(left))
    mean, alternating = cycles(sigma, of_each[0])
    np.testing.assert_allclose([mean, alternating], direct[0], rtol=1e-9)
    assert np.all(alternating <= np.ptp(of_each[0], axis=0) / 2 @ von_mises(sigma) * (1 + 1e-12))


def test_ten_drawn_runs_tell_the_largest_stress_of_all_their_revolutions(
    coarse_blade, coarse_mesh, coarse_rom, coarse_basis, basis_file, solid
):
    """To 2 %, each revolution by itself; in half of the runs the last one misses a tenth.

    The largest between any two instants of the run is no less than that told beside it.
    """
    drawn = np.sort(np.random.default_rng(8).uniform(0.1, 0.39, 10)).round(3).tolist()
    runs = of_paper(coarse_rom, drawn, 20, states_rounds=20, samples_per_round=512, motion=3)
    told, _ = write(coarse_blade, coarse_mesh, coarse_rom, basis_file, runs)
    shapes = motion(runs["states"].values, coarse_rom.stiffness(0.0), job.SHAPES)
    sigma = stresses(solid, coarse_basis, shapes.shapes, coarse_blade.prestress)
    stressed = job.Stressed(coarse_blade, solid, coarse_basis, shapes, sigma)
    missed = []
    for row, run in zip(told["speeds"], runs["states"].values, strict=True):
        times = len(run) // 20
        a = with_rotation(run @ shapes.onto)
        rounds = {number + 1: a[number * times :][:times] for number in range(20)}
        speed = float(runs["speed"].sel(speed_over_f1=row["speed_over_f1"]))
        most, last = (
            (found := stressed.worst(speed, of)).stress.numbers(found.a)["alternating"]
            for of in (rounds, {20: rounds[20]})
        )
        assert row["alternating"] > 0.98 * most
        missed.append(last < 0.9 * most)
        if "between" in row:
            assert row["alternating"] <= row["between"] * (1 + 1e-9)
    assert sum(missed) >= 3


@pytest.fixture(scope="module")
def worn_long(coarse_blade, coarse_mesh, coarse_rom, basis_file):
    """A sweep and its stress, with a slope of the S-N line."""
    runs = of_paper(coarse_rom, SPEEDS, 8).assign_attrs(modes=4, orders=[4])
    blade = coarse_blade.but(fatigue=STRENGTH | {"slope_k": 9})
    return runs, write(blade, coarse_mesh, coarse_rom, basis_file, runs)[0]


def test_second_runs_give_stress_its_uncertainty(worn_long, coarse_rom):
    """The first run tells the stress of the sweep's; the mesh has a part; the worst speed, too."""
    runs, told = worn_long
    peaks = results(runs, coarse_rom, ModelError(1e-4, 1e-3), stress=told)
    peaks += results(
        runs,
        coarse_rom,
        ModelError(1e-4, 1e-3),
        stress=told,
        peaks=worst_stressed(runs, told, peaks),
    )
    assert told["worst"] in [peak.Omega_c for peak in peaks]
    assert worst_stressed(runs, told, peaks) == worst_stressed(runs, None, peaks) == []
    for peak in peaks:
        row = told["speeds"][peak.index]
        for name in ("mean_stress", "alternating", "margin"):
            assert peak.numbers[name] == pytest.approx(row[name], rel=1e-4)
            assert peak.errors[name] >= abs(row["mesh"][name] * row[name])
            assert {"twin", "model", "stress", "patches"} <= {
                part for part, of in peak.parts.items() if name in of
            }
        assert peak.numbers["damage"] > 0
    plain = results(runs, coarse_rom, ModelError(1e-4, 1e-3))
    for with_stress, without in zip(peaks, plain, strict=False):
        assert with_stress.verdict == without.verdict
        assert with_stress.numbers.items() >= without.numbers.items()
        assert with_stress.errors.items() >= without.errors.items()


def test_a_coarser_model_has_the_same_stress_of_the_same_motion(worn_long, coarse_rom):
    """u = T u'; without T the stress is that of the model itself."""
    runs, told = worn_long
    (peak, *_) = worst_stressed(runs, told, [])
    at, (_, T) = at_node(told, peak.index), coarser(coarse_rom)
    u = np.random.default_rng(2).normal(size=(7, T.shape[1]))
    own, other = with_rotation(u @ T.T) @ at.sigma, with_rotation(u) @ through(at, T).sigma
    np.testing.assert_allclose(other, own, rtol=1e-9, atol=1e-9 * abs(own).max())
    assert through(at, None) is at and through(None, T) is None
    assert at_node({**told, "speeds": [{}]}, 0) is None


def test_the_damage_is_that_of_all_revolutions(worn_long, coarse_rom):
    """By hand from the states of the whole run; the largest cycle has that of its margin."""
    runs, told = worn_long
    (peak, *_) = worst_stressed(runs, told, [])
    run = case_of(runs, to_march(runs, told), coarse_rom, peak).march()
    assert len(run.outcome.states) == 8 * 256
    found = stress_of(run, at_node(told, peak.index))
    again = of_paper(coarse_rom, [told["worst"]], 8, states_rounds=8)["states"].values[0]
    by_itself = damage(uniaxial(with_rotation(again) @ at_node(told, peak.index).sigma), STEEP)
    assert found["damage"] == pytest.approx(by_itself, rel=1e-6, abs=0)
    least = 0.5 * found["margin"] ** -9 / 1e7  # of half of that cycle
    assert least < found["damage"] < 8 * 20 * 2 * least
    without = {**told, "fatigue": STRENGTH | {"line": "goodman"}}
    plain = case_of(runs, to_march(runs, without), coarse_rom, peak).march()
    assert "damage" not in stress_of(plain, at_node(without, peak.index))


def test_what_is_read_near_a_sharp_clamp_is_warned(
    coarse_blade, coarse_mesh, coarse_rom, basis_file, sweep
):
    """At a fillet nothing is nearer."""
    for stress, too_near in (({"away_mm": 1.0}, True), ({"root": "fillet"}, False)):
        told, _ = write(coarse_blade.but(stress=stress), coarse_mesh, coarse_rom, basis_file, sweep)
        assert (told["too_near"] is not None) == too_near
        assert not any("nearer" in row for row in told["speeds"])


def test_bending_rises_further_towards_a_sharp_clamp(
    coarse_blade, coarse_rom, coarse_basis, solid, monkeypatch
):
    """One mode, at the border of what is read; a smooth field, and mode 1 has one cycle a period.

    Twice the motion has twice the stress, and the same error by the mesh.
    """
    _, modes = coarse_rom.modes(300.0)
    shapes = Shapes(modes[:, :1], np.linalg.pinv(modes[:, :1]).T, np.zeros(1))
    sigma = stresses(solid, coarse_basis, shapes.shapes, coarse_blade.prestress)
    blade = coarse_blade.but(fatigue=STRENGTH)
    stressed = job.Stressed(blade, solid, coarse_basis, shapes, sigma)
    swing = 1e-5 * np.sin(2 * np.pi * 4 * np.arange(1, 129) / 128)[:, None]
    found = stressed.worst(300.0, {1: with_rotation(swing), 2: with_rotation(2 * swing)})
    one, two = (found.stress.numbers(a)["alternating"] for a in found.revolutions.values())
    assert (found.number, two) == (2, pytest.approx(2 * one))
    assert found.stress.order(found.a) == 4
    told, farther = stressed.around(found), blade.but(stress={"away_mm": 30})
    at_border = job.Stressed(farther, solid, coarse_basis, shapes, sigma)
    border = at_border.worst(300.0, found.revolutions)
    assert at_border.around(border)["rises"] == job.CLAMP and told["stands_out"] < 1.25
    assert told["between"] == pytest.approx(two)
    other = job.Found(found.Omega, found.node, 1, found.revolutions, found.stress)
    errors = stressed.mesh_errors(other)
    assert told["mesh"]["alternating"] == pytest.approx(errors["alternating"])
    assert 0 < errors["alternating"] < 0.5
    near = stressed.near_clamp
    assert not stressed.airfoil[0][near].any() and len(near) > 10
    with monkeypatch.context() as lifted:
        lifted.setattr(job, "AGREE", 1.0)
        nearer = stressed.nearer(found)["nearer"]
    assert nearer["alternating"] == pytest.approx(
        stressed.everywhere(found, near, float)["alternating"].max(), rel=0.05
    )
    resolved = nearer["mesh"]["alternating"] <= job.AGREE
    assert ("nearer" in stressed.nearer(found)) == resolved
    small = mesh_errors({"speeds": [{"mesh": errors}], "fatigue": {"slope_k": 9}}, 0)
    assert small["damage"] == pytest.approx((1 - errors["margin"]) ** -9 - 1)
    compressed = NodeStress(-found.stress.sigma, blade.fatigue)
    pressed = job.Found(found.Omega, found.node, 2, found.revolutions, compressed)
    assert compressed.numbers(found.a)["mean_stress"] < 0  # it earns no credit, and takes none
    errors = stressed.mesh_errors(pressed)
    assert errors["margin"] == pytest.approx(1 - 1 / (1 + errors["alternating"]), rel=1e-6)


def test_without_motion_there_is_no_worst_speed(
    coarse_blade, coarse_mesh, coarse_rom, basis_file, sweep
):
    """And a margin that is used up ranks by the alternating stress."""
    still = sweep.assign(motion=0 * sweep["motion"], strained=0 * sweep["strained"])
    told, _ = write(coarse_blade, coarse_mesh, coarse_rom, basis_file, still)
    assert told["worst"] is None and not any("mesh" in row for row in told["speeds"])
    assert reserve({"margin": 0.0, "alternating": 3.0}) == -3.0
    left = reserve({"margin": np.array([2.0, 0.0]), "alternating": np.array([3.0, 4.0])})
    assert left.tolist() == [2.0, -4.0]


def test_a_mesh_without_nodes_near_the_clamp_has_none_nearer(coarse_blade, sweep, monkeypatch):
    """And a sweep of before is to be made anew."""
    monkeypatch.setattr(job.Stressed, "near_clamp", np.array([], int))
    assert job.Stressed(coarse_blade, None, None, None, None).nearer(None) == {}
    old = sweep.drop_vars(["strained", "strained_round"])
    with pytest.raises(ProvenanceError, match=r"sweep\.nc has no strained, strained_round"):
        job.revolutions(old)


def test_stress_of_linear_prestress_is_in_the_square_of_the_speed(coarse_basis, coarse_rom, solid):
    """Two powers hold that of rotation and of modes at any speed: as the field at that speed."""
    modes = coarse_rom.modes(0.0)[1][:, :2]
    basis = replace(coarse_basis, u_static=coarse_basis.u_static[:1])
    sigma, Omega = stresses(solid, basis, modes, "linear"), 0.3 * basis.Omega_m
    order = dofs_at(basis.coordinates, solid.free_coordinates()).ravel()
    along = (basis.T @ modes).T[:, order]
    (field,) = linearised(solid, basis.static(Omega)[order], along, "linear", strain=False)
    assert len(sigma) == 2
    np.testing.assert_allclose(evaluate(sigma, 0.3), field, atol=1e-12 * abs(field).max())
