"""The cost of a command: the sum over its jobs, by what their scenes and blades say."""

import re
from types import SimpleNamespace

import pytest
from test_targets import folder, of, project, write  # noqa: F401  fixtures

from geometry.base import duration
from simulate.sweeps.cost import cost
from workflow.model_cost import START, costs
from workflow.targets.told import DRAWN, OTHER, RUNS, _of_job, told


def job(rule, **wildcards):
    return rule, SimpleNamespace(get=wildcards.get, **wildcards)


NODES = 26_157  # of blade `paper`, as expected; its mesh has 25,972
SCENE = {"scene": "paper-e1", "blade": "paper"}


def test_jobs_of_a_scene_take_the_time_of_its_runs(folder):  # noqa: F811
    """Blocks and sweep together all of them; the answers so many more."""
    of_all, sweep = project(), cost(project().scenes["paper-e1"], None)
    blocks = of_all.scenes.block_count(of())
    each = {
        rule: _of_job(of_all, *job(rule, **SCENE)).seconds - START
        for rule in ("sweep_block", "sweep", "answers")
    }
    assert blocks * each["sweep_block"] + each["sweep"] == pytest.approx(sweep.seconds)
    assert each["answers"] == pytest.approx(RUNS["answers"] * sweep.seconds / sweep.runs)


def test_jobs_of_a_blade_take_the_time_of_its_mesh(folder):  # noqa: F811
    of_all, blade = project(), {"blade": "paper"}
    usual = costs(of_all.blades.settings["paper"], NODES)
    assert _of_job(of_all, *job("modes", **blade)) == usual["modes"]
    mesh = folder / "results/paper/blade.msh"
    mesh.parent.mkdir(parents=True)
    mesh.write_text("$Nodes\n1 90000 1 90000\n")
    assert _of_job(of_all, *job("modes", **blade)).seconds > 3 * usual["modes"].seconds
    assert _of_job(of_all, *job("draw_fig03")) == DRAWN and _of_job(of_all, *job("all")) == OTHER


def test_the_line_has_the_sum_and_the_largest_memory(folder):  # noqa: F811
    of_all, jobs = project(), [job("draw_fig03"), job("summary"), job("modes", blade="paper")]
    line, modes = told(of_all, jobs), costs(of_all.blades.settings["paper"], NODES)["modes"]
    seconds = DRAWN.seconds + OTHER.seconds + modes.seconds
    assert line.startswith(f"3 jobs: some {duration(seconds)} on one core, ")
    untold = told(of_all, [*jobs, job("experiment_block"), job("growth")])
    assert untold == line.replace("3", "5", 1) + ", without experiment_block, growth"
    assert re.search(rf" {max(modes.memory, DRAWN.memory) / 1e9:.2g} GB for one at most$", line)


@pytest.mark.parametrize("rule", ["sweep", "sweep_block", "answers", "pilot", "design_block"])
def test_no_scene_stops_a_run_whose_cost_is_told(folder, rule):  # noqa: F811
    """Nor a mesh that is damaged; that of `one-percent` its pilot chooses."""
    of_all = project()
    for name in of_all.scenes:
        told(of_all, [job(rule, scene=name, blade=of_all.scenes[name].blade, block="0")])
    mesh = folder / "results/paper/blade.msh"
    mesh.parent.mkdir(parents=True)
    mesh.write_text(f"$Nodes\n1 {'4' * 400} 1\n")
    assert told(of_all, [job("modes", blade="paper")]).endswith(", without modes")
