"""Study of the interface: changes and their limits, and contact at all nodes of the tip."""

from types import SimpleNamespace

import numpy as np
import pytest
from projects import ROOT
from test_trade import seen

from fem.interface import node_areas
from fem.solid import read_solid
from geometry.tip import on_line
from simulate.scene import Scene
from workflow.study import interface, interface_models, interface_nodes, interface_plan
from workflow.study.interface_plan import COMPARED, OPERATOR_BARS
from workflow.study.trade_runs import SAMPLES

MESH, INTERFACE = "2.48 to 1.75 mm", "16 patches, 16 strips to 32, 32"
STRIPS, NU, RADIUS, LENGTH = 4, 32, 0.5, 0.08  # LENGTH of the tip along the axis, m


def marched(depth, amplitude=1.0, force=1.0, Omega_c=None):
    """Twenty rounds at engine order 4 over strips of 1, 2, 3, 4 tenths, worn to ``depth``, m."""
    theta = 2 * np.pi * np.arange(20 * SAMPLES) / SAMPLES
    width, radius = LENGTH * np.arange(1, STRIPS + 1) / 10, np.full(STRIPS, RADIUS)
    wear, u = np.full((STRIPS, NU), depth), amplitude * np.cos(4 * theta)
    return seen(u, wear, force, width=width, radius=radius)._replace(Omega_c=Omega_c)


def test_the_worn_volume_is_the_depth_times_the_area_under_the_tip():
    expected = 1e-4 * 2 * np.pi * RADIUS * LENGTH
    found = marched(1e-4).numbers["worn_volume"]
    assert found == pytest.approx(expected, rel=1e-7)  # of wear in single precision, as in files


def test_a_change_is_met_only_if_it_is_below_all_its_limits():
    """Wear 0.8 % more, amplitude 0.4 %: above its limit of 0.3 %, where it has one."""
    one, other = marched(1.008e-4, 1.004, 1.02), marched(1e-4)
    row = interface._row("calm", MESH, one, other)
    expected = {"wear": 0.008, "amplitude": 0.004, "force": 0.02}
    assert row["changes"].pop("Omega_c") is None
    assert row["changes"].pop("volume") == pytest.approx(0.008, rel=1e-4)  # in single precision
    assert row["changes"] == pytest.approx(expected, rel=1e-9)
    assert not row["met"] and row["status"] == ["ok", "ok"]
    assert interface._row("calm", INTERFACE, one, other)["met"]
    # a missing peak meets no limit unless none was sought
    known, lost = marched(1e-4, Omega_c=0.3471), marched(1e-4, Omega_c=np.nan)
    assert interface._row("resonance", MESH, known, known)["met"]
    assert interface._row("calm", MESH, other, other)["met"]
    assert not interface._row("resonance", MESH, lost, known)["met"]


def model(blade, patches, compliance, stress=None):
    kept = dict.fromkeys(("constant", "linear", "ST", "compliance_of_model"), 1e-12)
    row = {"blade": blade, "patches": patches, "n": 60, "compliance_m_per_N": compliance} | kept
    return row | ({"stress": stress} if stress else {})


@pytest.fixture
def models():
    """Compliances and stresses with known changes, the largest at the first strip."""
    of = {"reference-coarse": 0.99, "reference": 1.0, "reference-fine": 1.004}
    of |= {"rotor37": 1.0, "rotor37-fine": 1.002}
    told = {
        ("reference", 16): {"away_Pa": 98e6, "largest_Pa": 200e6},
        ("reference-fine", 16): {"away_Pa": 100e6, "largest_Pa": 400e6},
        ("reference", 32): {"away_Pa": 94e6, "largest_Pa": 250e6},
    }
    rows = [
        model(blade, n, [1e-6 * factor, 2e-6], told.get((blade, n)))
        for blade, factor in of.items()
        for n in (8, 16)
    ]
    return [*rows, model("reference", 32, [1e-6, 2e-6], told["reference", 32])]


def test_compliances_are_compared_from_each_mesh_to_the_next_finer(models):
    rows = {(r["from"], r["patches"]): r for r in interface.between_meshes(models)}
    assert len(rows) == 6
    assert rows["reference", 8]["compliance"] == pytest.approx(1 - 1 / 1.004)
    assert rows["reference-coarse", 16]["compliance"] == pytest.approx(0.01)
    assert rows["rotor37", 16]["to"] == "rotor37-fine"
    bars = {("reference", 8): 0.003, ("rotor37", 16): 0.006, ("reference-coarse", 8): None}
    assert {of: rows[of]["bar"] for of in bars} == bars  # None: told, not judged


def test_stresses_are_compared_with_finer_mesh_and_twice_the_patches(models):
    mesh, patches = interface.stresses(models)
    assert (mesh["away"], mesh["anywhere"]) == pytest.approx((0.02, 0.5))
    assert (patches["away"], patches["anywhere"]) == pytest.approx((4 / 94, 0.2))
    assert mesh["away_Pa"] == [98e6, 100e6] and patches["bar"] == 0.03


def test_the_tables_have_limits_and_mark_changes_above_them(models):
    """One of each: an error of S, a frequency, compliances, a wear and a stress above its limit."""
    models[0]["ST"] = 2e-9  # over its bar of 1e-9
    same = marched(1e-4, Omega_c=0.35)
    worse = marched(1.02e-4, Omega_c=0.35)
    study = {
        "models": models,
        "frequencies": {"reference": 1.2e-5, "rotor37": 2e-4},
        "between_meshes": interface.between_meshes(models),
        "changes": [
            interface._row("resonance", MESH, worse, same),
            {"scene": "calm", "change": "gaps by 1e-10", "largest": 3.2e-8},
        ],
        "stress": interface.stresses(models),
        "all_nodes": [
            {"scene": "calm", "moving": "alone", "amplitude": 0.01, "wear": 0.13, "volume": -0.02}
        ],
    }
    parts = [part.split("\n\n")[1].splitlines() for part in interface.table(study).split("##")[1:]]
    missed = [sum("missed" in row for row in part) for part in parts]
    assert missed == [1, 1, 1, 1, 1, 0]
    assert "| 0.4 % (<= 0.6 %) |" in parts[2][5] and "**0.4 % (<= 0.3 %)** missed" in parts[2][4]
    assert parts[5][2:] == ["| calm | alone | 13 % | -2 % | +1 % |"]


def test_every_limit_is_of_an_observable_in_the_tables():
    assert all(set(of.bars) <= set(interface_plan.SHOWN) for of in COMPARED.values())


def test_every_model_that_is_marched_is_an_input():
    """Of each comparison both, with the directions of every scene."""
    compared = {model for of in COMPARED.values() for model in (of.one, of.other)}
    assert compared <= set(interface_plan.MODELS)
    assert {scene.directions for scene in interface_plan.SCENES.values()} <= {"r", "rt"}


@pytest.fixture(scope="module")
def solid(coarse_blade, coarse_mesh):
    return read_solid(str(coarse_mesh.mesh), coarse_blade.material)


SUBTRIANGLES = [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)]  # of six nodes, VTK's order


def test_the_areas_of_nodes_add_up_to_that_of_the_tip(solid):
    """That of four flat triangles in each facet, up to its curvature; every node has some."""
    areas, points = node_areas(solid), solid.V.tabulate_dof_coordinates()
    a, b, c = points[solid.tip[:, SUBTRIANGLES].reshape(-1, 3).T]
    flat = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    assert areas.sum() == pytest.approx(flat, rel=3e-3)
    used = np.unique(solid.tip)
    assert (areas[used] > 0).all() and areas.sum() == pytest.approx(areas[used].sum(), rel=1e-14)


def test_a_flat_facet_gives_its_corners_a_nineteenth_each():
    """Diagonal of the mass matrix of six nodes: A/30 at corners, 8A/45 at middles."""
    corners = np.array([[0, 0, 0], [2, 0, 0], [0, 1, 1]], float)
    points = np.vstack([corners, (corners + np.roll(corners, -1, axis=0)) / 2])
    space = SimpleNamespace(tabulate_dof_coordinates=lambda: points)
    areas = node_areas(SimpleNamespace(V=space, tip=np.arange(6)[None]))
    expected = np.sqrt(2) * np.repeat([3, 16], 3) / 57
    assert areas == pytest.approx(expected, rel=1e-12)


def test_the_interface_of_a_mesh_is_within_the_limits_of_the_study(
    monkeypatch, coarse_yaml, coarse_files
):
    """u_r = 1 itself is not in the shape functions of so coarse a mesh.

    What S errs by it is far less than a patch.
    """
    monkeypatch.setitem(interface_models.PATCHES, "coarse", (4, 8))
    rows = interface_models.numbers(coarse_files, coarse_yaml, scene={})
    assert [row["patches"] for row in rows] == [4, 8]
    for row in rows:
        assert row["constant"] < 1e-6 and row["linear"] < 1e-6
        assert all(row[key] < OPERATOR_BARS[key] for key in ("ST", "compliance_of_model"))
        assert len(row["compliance_m_per_N"]) == row["patches"] and "stress" not in row


def test_nodes_of_the_tip_move_with_it_and_divide_the_area_of_their_stations(
    monkeypatch, coarse_blade, coarse_matrices, coarse_mesh
):
    monkeypatch.setattr(interface_nodes, "STATIONS", 8)
    nodes = interface_nodes._nodes(coarse_blade, coarse_matrices.camber, coarse_mesh.mesh)
    x, y, _ = coarse_matrices.coordinates.T
    radial = np.column_stack([x, y, 0 * x]) / np.hypot(x, y)[:, None]
    assert nodes.S[::3] @ radial.ravel() == pytest.approx(1, rel=1e-12)
    of_station = np.diff(on_line(coarse_matrices.camber, interface_nodes._ends())[:, 2])
    width = np.bincount(nodes.station, nodes.places.width)
    assert width == pytest.approx(nodes.across * of_station, rel=1e-12)
    assert np.abs(nodes.station / 8 - nodes.places.xi).max() <= 1 / 16
    assert np.ptp(nodes.places.radius) < 1e-4  # m: the tip is round


@pytest.mark.slow
def test_contact_at_all_nodes_of_the_tip_is_close_to_that_of_patches(
    monkeypatch, coarse_yaml, coarse_files
):
    """On a coarse mesh, with few steps and rods."""
    for name, value in (("STEPS", 512), ("RODS", 509), ("STATIONS", 12)):
        monkeypatch.setattr(interface_nodes, name, value)
    scene = Scene.load(ROOT / "workflow/scenes/hand-e1.yaml").but(rounds=10)
    scenes = {"calm": scene.model_dump(mode="json")}
    alone, row = interface_nodes.numbers(coarse_files, coarse_yaml, scenes)
    assert row["scene"] == alone["scene"] == "calm" and row["nodes"] == alone["nodes"] > 3 * 8
    assert alone["moving"] == "on their own"
    for found in (alone, row):
        assert all(0 < abs(found[key]) < 0.3 for key in ("amplitude", "wear", "volume"))
