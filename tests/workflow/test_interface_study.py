"""Study of the interface: changes and their limits, and contact at all nodes of the tip."""

from types import SimpleNamespace

import nodes
import numpy as np
import pytest
from projects import ROOT
from scenes import scene
from test_trade import cosine, single

from fem.solid import read_solid
from simulate.errors.observables import numbers
from simulate.errors.run import Case
from simulate.marching import prepare
from workflow.many.plan import cases
from workflow.study import interface, interface_models, trade

EXPERIMENT = ROOT / "workflow/experiments/interface.yaml"
STRIPS, NU, RADIUS, LENGTH = 4, 32, 0.5, 0.08  # LENGTH of the tip along the axis, m


def marched(depth, amplitude=1.0, force=1.0):
    """Twenty rounds at engine order 4 over strips of 1, 2, 3, 4 tenths, worn to ``depth``, m."""
    width, radius = LENGTH * np.arange(1, STRIPS + 1) / 10, np.full(STRIPS, RADIUS)
    wear = np.full((STRIPS, NU), depth)
    return single(cosine(amplitude), wear, force, width=width, radius=radius)


def test_the_worn_volume_is_the_depth_times_the_area_under_the_tip():
    expected = 1e-4 * 2 * np.pi * RADIUS * LENGTH
    of = marched(1e-4)
    found = numbers(of)["worn_volume"]
    assert found == pytest.approx(expected, rel=1e-7)  # of wear in single precision, as in files


def row(scene, name, blade="reference", **numbers):
    return {"scene": scene, "row": name, "blade": blade, "numbers": numbers}


@pytest.fixture
def models():
    """Compliances and stresses with known changes, the largest at the first strip."""
    within = dict.fromkeys(interface.OPERATOR_BARS, 1e-12) | {"n": 60, "frequencies": 1.2e-5}
    of = {"reference-coarse": 0.99, "reference": 1.0, "reference-fine": 1.004}
    of |= {"rotor37": 1.0, "rotor37-fine": 1.002}
    rows = [
        row(blade, "", blade, patches=n, compliance_m_per_N=[1e-6 * factor, 2e-6], **within)
        for blade, factor in of.items()
        for n in (8, 16)
    ]
    at_peak = {"default": (98e6, 2e8), "fine": (100e6, 4e8), "twice": (94e6, 2.5e8)}
    return rows + [
        row("peak", name, away_Pa=inside, largest_Pa=anywhere)
        for name, (inside, anywhere) in at_peak.items()
    ]


def test_the_tables_have_limits_and_mark_changes_above_them(models):
    """One of each: an error of S, a frequency, compliances, a wear and a stress above its limit.

    Compliances are compared from each mesh to the next finer, stresses with those of the default.
    """
    models[0]["numbers"]["ST"] = 2e-9  # over its bar of 1e-9
    models[7]["numbers"]["frequencies"] = 2e-4
    changed = dict.fromkeys(("amplitude", "wear", "volume", "force"), 0.0) | {"wear": 0.02}
    of_scenes = {"calm": changed, "peak": {"Omega_c": 0.0}}
    rows = [
        row(scene, name, errors=of) for scene, of in of_scenes.items() for name in interface.BARS
    ]
    text = interface.table([*rows, row("calm", "default", largest=3.2e-8)], models)
    parts = [part.split("\n\n")[1].splitlines() for part in text.split("##")[1:]]
    missed = [sum("missed" in line for line in part) for part in parts]
    assert missed == [1, 1, 1, 3, 1]  # wear of 2 % is within one of its four limits
    assert parts[2][2:] == [
        "| reference-coarse | reference | 8 | 1 % |",  # told, not judged
        "| reference-coarse | reference | 16 | 1 % |",
        "| reference | reference-fine | 8 | **0.4 % (<= 0.3 %)** missed |",
        "| reference | reference-fine | 16 | 0.4 % (<= 0.6 %) |",
        "| rotor37 | rotor37-fine | 8 | 0.2 % (<= 0.3 %) |",
        "| rotor37 | rotor37-fine | 16 | 0.2 % (<= 0.6 %) |",
    ]
    assert parts[3][-1].startswith("| calm | gaps by 1e-10 | 3.2e-08 |")
    assert parts[4][2:] == [
        "| fine | 2 % (<= 3 %) | 50 % |",
        "| twice | **4.3 % (<= 3 %)** missed | 20 % |",
    ]


def test_the_rows_of_the_experiments_are_those_of_the_limits():
    found = {case.row: case for case in cases(EXPERIMENT)}
    assert {*interface.BARS, interface.DEFAULT} < {*found}
    assert all(set(of) <= set(interface.SHOWN) for of in interface.BARS.values())
    assert all(found[name].against != name for name in interface.BARS)
    models = cases(EXPERIMENT.with_name("interface-models.yaml"))
    of_patches = {(case.scene.blade, case.scene.liner.strips) for case in models}
    meshes = {mesh for *pair, _ in interface.MESHES for mesh in pair}
    assert {(mesh, n) for mesh in meshes for n in interface.COMPLIANCE_BARS} < of_patches
    assert (interface.PEAK, interface.DEFAULT) in {(case.label, case.row) for case in models}


def test_the_row_that_others_are_compared_with_has_the_difference_of_its_twin(coarse_rom):
    of = scene(record__history={"chord": [0.0625]}, record__contact_force=True)
    of = of.but(record__spectrum_rounds=1, rounds=2)
    setup = prepare(of, coarse_rom, coarse_rom.omega1 * 0.33)
    run = Case(of, coarse_rom, setup).march()
    assert 0 < trade.changes(run, None)["largest"] < 1e-3


@pytest.mark.parametrize("patches", [4, 8])
def test_the_interface_of_a_mesh_is_within_the_limits_of_the_study(
    patches, coarse_blade, coarse_files, monkeypatch
):
    """u_r = 1 itself is not in the shape functions of so coarse a mesh.

    What S errs by it is far less than a patch.
    """
    check = SimpleNamespace(error=np.array([[3e-5, -4e-5]]))
    monkeypatch.setattr(interface_models.RomCheck, "load", lambda file: check)
    files = str(coarse_files.mesh), coarse_files.matrices, "rom-check-r.nc"
    found = interface_models.of_patches(scene(liner__strips=patches), coarse_blade, *files)
    assert found["constant"] < 1e-6 and found["linear"] < 1e-6
    for key in ("ST", "compliance_of_model"):
        assert found[key] < interface.OPERATOR_BARS[key]
    assert found["frequencies"] == 4e-5
    assert len(found["compliance_m_per_N"]) == found["patches"] == patches


@pytest.fixture(scope="module")
def of_nodes(coarse_blade, coarse_matrices, coarse_mesh):
    solid = read_solid(str(coarse_mesh.mesh), coarse_blade.material)
    return nodes.reference(coarse_blade, coarse_matrices, solid), solid


def test_places_across_the_thickness_go_from_edge_to_edge_and_move_with_the_tip(of_nodes):
    """Moved along the radius by their angle, places have the angles of both edges and between."""
    of, solid = of_nodes
    points = solid.V.tabulate_dof_coordinates()[np.unique(solid.tip)]
    theta = np.zeros(of.rom.n)
    theta[: len(points)] = np.arctan2(points[:, 1], points[:, 0])
    expected = np.linspace(*of.sides, nodes.PLACES)
    assert of.P @ theta == pytest.approx(expected, abs=2e-3 * np.diff(of.sides, axis=0).max())
    assert of.P.sum(axis=-1) == pytest.approx(1, rel=1e-12)
    assert (np.diff(of.sides, axis=0) > 0).all()


@pytest.mark.slow
def test_two_rows_across_the_thickness_are_far_closer_to_all_nodes_than_one(
    monkeypatch, coarse_blade, coarse_files
):
    """On a coarse mesh, with few steps and rods."""
    (calm, *_) = [case.scene for case in cases(EXPERIMENT) if case.label == "resonance"]
    few = calm.but(
        rounds=8,
        record__spectrum_rounds=1,
        liner__rods_per_round=1021,
        integrator__steps_per_round=1024,
    )
    monkeypatch.setattr(nodes, "STRIPS", 8)
    monkeypatch.setattr(nodes, "MODELS", ((8, 1), (8, 2)))
    monkeypatch.setattr(nodes, "OVER_F1", {"calm": few.speeds.over_f1})
    of = coarse_blade, coarse_files.matrices, coarse_files.mesh
    one, two = nodes.compared(*of, {"calm": few})
    assert (one.across, two.across) == (1, 2) and one.nodes > 3 * 8
    assert abs(two.wear) < 0.3 * abs(one.wear) and abs(two.volume) < 0.3 * abs(one.volume)
    assert abs(one.volume) > 0.05 and abs(two.volume) < 0.02


def test_the_table_has_the_medians_over_the_speeds_of_each_model():
    rows = [nodes.Row("e1", 2, 8, 243, deep, -0.02, 0.01, 0.13) for deep in (-0.03, 0.01, 0.05)]
    assert nodes.table(rows) == [["e1", "2", "8", "3", "3 %", "2 %", "1 %", "13 %"]]
    head, *kept = (ROOT / nodes.KEPT).read_text().splitlines()
    assert head == f"# {nodes.COMMAND}" and len(kept) == 1 + 2 * len(nodes.MODELS)
