"""Study of cost: what is measured of a process, exponents, and the plans made from the numbers."""

import json
import sys
import time
from types import SimpleNamespace

import numpy as np
import pytest
from made_sweeps import ROOT

from simulate.scene import Scene
from simulate.sweeps import dataset
from workflow.config import Config
from workflow.study import scaling, scaling_plan, scaling_stages
from workflow.study.scaling_axes import StageError, measured, run_stage
from workflow.study.scaling_budget import MANY_ROWS, Gpu, breaks, large_mesh, million, on_gpu

AXES = {
    "mesh": ("mesh", "assemble", "reduce", "full_model"),
    "patches": ("assemble", "reduce"),
    "march": ("strips", "rods", "rounds"),
    "speeds": ("merge",),
    "rows": ("design", "tables"),
    "jobs": ("plan",),
}
RUN = {"n": 60, "strips": 16, "steps": 80_000, "bytes": 1e5, "held": 0, "row_bytes": 0}


def made_points():
    """Times and memories that grow as x, and as x^2 for `jobs`."""
    x = [1000, 2000, 4000, 8000]
    return {
        axis: {
            stage: [
                RUN
                | {
                    "x": value,
                    "seconds": 1e-4 * (value if axis != "jobs" else value**2),
                    "peak_MB": 100 + 0.2 * value,
                    "held": 1e5 * value,
                    "bytes": 150.0 * value,
                    "row_bytes": 900.0 * value,
                }
                for value in x
            ]
            for stage in stages
        }
        for axis, stages in AXES.items()
    }


def test_the_cpu_time_and_peak_memory_of_a_process_are_its_own():
    """A sleep costs no time; 300 MB are touched; the 600 MB of what starts it do not count.

    The process has one thread: it takes what it says, and at most the time passed less its sleep.
    """
    ballast = b"x" * 600_000_000
    program = (
        "import time; time.sleep(1); b = b'x' * 300_000_000; until = time.process_time() + 0.5\n"
        "while time.process_time() < until: pass\nprint(time.process_time())"
    )
    begun = time.perf_counter()
    output, of_process = measured([sys.executable, "-c", program])
    assert 0.5 < float(output) <= of_process["seconds"] <= time.perf_counter() - begun - 1
    assert 300 < of_process["peak_MB"] < 400 < len(ballast) / 1e6


def test_a_process_that_fails_is_an_error_with_the_end_of_its_output():
    with pytest.raises(StageError, match="no such thing"):
        measured([sys.executable, "-c", "raise SystemExit('no such thing')"])


@pytest.fixture(scope="module")
def rom_file(coarse_rom, tmp_path_factory):
    path = tmp_path_factory.mktemp("scaling") / "rom.nc"
    coarse_rom.save(path)
    return str(path)


@pytest.fixture(scope="module")
def short_scene():
    scene = Scene.load(ROOT / "workflow/scenes/paper-e1.yaml").but(
        **scaling_plan.ONE_SPEED,
        blade="coarse",
        rounds=3,
        record__spectrum_rounds=1,
        casing__ramp_rounds=1,
        integrator__steps_per_round=512,
        record__samples_per_round=512,
        liner__rods_per_round=509,
    )
    return scene.model_dump(mode="json")


def test_a_stage_tells_its_own_time_and_the_memory_of_its_process(rom_file, short_scene):
    told = run_stage("march", rom=rom_file, scene=short_scene, rounds=5)
    assert told["steps"] == 5 * 512 and told["strips"] == 16
    assert told["status"] == "ok" and 0 < told["seconds"] < 5 and told["peak_MB"] > 50


def test_the_sweep_of_many_speeds_has_them_all_and_a_design_its_rows(
    rom_file, short_scene, tmp_path
):
    where = {"folder": str(tmp_path), "rom": rom_file, "scene": short_scene}
    scaling_stages.blocks(**where, speeds=23, blocks=3)
    scaling_stages.merge(str(tmp_path))
    assert dataset.load(tmp_path / "sweep.nc").sizes["speed_over_f1"] == 23
    assert scaling_stages.design(**where, rows=7)["runs"] == 1
    tables = scaling_stages.tables(**where, rows=7)
    assert tables["bytes"] > 7 * 100 and tables["row_bytes"] > 7 * 100


def test_the_exponent_is_that_of_a_power_law():
    x = np.array([3.0, 10.0, 47.0])
    assert scaling.slope(x, 0.2 * x**1.37) == pytest.approx(1.37, abs=1e-12)


@pytest.fixture
def study(tmp_path):
    files = []
    for axis, stages in made_points().items():
        files.append(tmp_path / f"{axis}.json")
        files[-1].write_text(json.dumps(stages))
    return scaling.numbers(SimpleNamespace(axes=files))


def test_exponents_are_over_the_last_points_of_each_stage(study):
    assert study["exponents"]["jobs"]["plan"]["seconds"] == pytest.approx(2)
    assert study["exponents"]["mesh"]["reduce"]["seconds"] == pytest.approx(1)


def test_memory_is_counted_from_the_first_point_on():
    """What the libraries take is no growth: 100 MB + 1e-4 x^2 has the exponent 2 from 10 x0 on."""
    points = [
        {"x": x, "seconds": 1.0, "peak_MB": 100 + 1e-4 * x**2} for x in (100, 1000, 3000, 9000)
    ]
    assert scaling._exponents(points)["peak_MB"] == pytest.approx(2, abs=0.01)
    assert scaling._exponents(points[:2])["peak_MB"] is None


def test_the_tables_and_the_figure_have_every_stage(study):
    rows = scaling.table(study).splitlines()[2:]
    assert len(rows) == sum(map(len, AXES.values()))
    assert scaling.plans(study).count("**") == 6
    drawn = scaling.draw(study)
    of_columns = [len(axes.lines) for axes in drawn.axes[:3]]
    assert of_columns == [4, 3, 4]


def test_a_million_runs_cost_what_one_costs_and_what_their_blocks_read():
    points = made_points()
    plan = million(points)
    one = points["march"]["rods"][0]["seconds"]
    assert plan["core_h"] == pytest.approx(1e6 * one / 3600)
    assert plan["designs"] * plan["rows"] == 1e6
    blocks = plan["blocks"] / plan["designs"]
    assert plan["block_s"] * blocks == pytest.approx(MANY_ROWS * one)
    # table, log and benchmark of each block, a part every 120 s; two tables of each design
    assert plan["files"] == 100 * (blocks * (3 + np.ceil(plan["block_s"] / 120)) + 2)
    # each block reads all rows of its design, 1e-4 s each
    assert plan["beside_share"] == pytest.approx(blocks * 1e-4 / one)
    assert plan["one_block_s"] == pytest.approx(100)
    assert plan["runs_GB"] == pytest.approx(0.15) and plan["rows_GB"] == pytest.approx(0.9)
    assert plan["sweep_GB"] == pytest.approx(100)


def test_what_breaks_first_is_where_the_memory_of_a_merge_and_a_minute_of_planning_end():
    limits = breaks(made_points())
    assert limits["speeds"] == pytest.approx(24e3 / 0.2) and limits["run_kB"] == pytest.approx(100)
    assert limits["jobs_in_a_minute"] == pytest.approx(60 / (1e-4 * 9000))


def test_a_larger_mesh_costs_what_the_exponents_say():
    """300 MB at 1000 nodes and 1700 at 8000, linear above the first."""
    exponents = {"mesh": {"full_model": {"seconds": 2.0, "peak_MB": 1.0}}}
    mesh = large_mesh(made_points(), exponents, nodes=80_000, memory_GB=14.3)
    assert mesh["min"] == pytest.approx(0.8 * 100 / 60)
    assert mesh["GB"] == pytest.approx((300 + 14_000) / 1e3)
    assert mesh["nodes_in_memory"] == pytest.approx(80_000)


def test_the_bounds_of_a_gpu_are_those_of_its_data_sheet():
    gpu = Gpu(flops=1e12, bandwidth=1e12, memory=1e9, processors=10)
    bounds = on_gpu(made_points(), runs=1000, gpu=gpu)
    flops = 4 * 16 * 60 + 10 * 60 + 16 * 4 * 25
    assert bounds["step_flops"] == flops
    assert bounds["rate_s"] == pytest.approx(1000 * 80_000 * flops / 1e11)
    assert bounds["chain_s"] == pytest.approx(1000 * 80_000 * 3e-6 / 160)


def test_every_value_of_the_plan_is_allowed():
    scene = Scene.load(ROOT / "workflow/scenes/paper-e1.yaml").but(**scaling_plan.ONE_SPEED)
    for rods in scaling_plan.RODS:
        scene.but(liner__rods_per_round=rods)
    for rounds in scaling_plan.ROUNDS:
        scene.but(rounds=rounds, integrator__steps_per_round=scaling_plan.FEW_STEPS)
    assert Config(scenes=[scaling_plan.SCENE], blocks=max(scaling_plan.JOBS))
    for strips in scaling_plan.STRIPS:
        scene.but(liner__strips=strips)
