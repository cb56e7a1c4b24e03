"""Error over CPU time by stage, of prescribed rows of the study of accuracy and time."""

import numpy as np
import pytest
from test_trade import cells, row

from workflow.figures import stages as figure
from workflow.study import stages
from workflow.study.levels import OBSERVABLES

CENTRAL = {"scheme": "central-difference"}


def by(integrator, *arguments, **changes):
    """A row with another scheme or step."""
    of = row(*arguments, group="scheme", **changes)
    of["settings"]["integrator"] |= integrator
    return of


@pytest.fixture
def study(tmp_path):
    """One setting of a model on two scenes, rods with both tips, steps of three schemes."""
    logs = tmp_path / "results/reference-coarse/logs"
    logs.mkdir(parents=True)
    for job, seconds in zip(stages.JOBS, (1.5, 2.0, 4.0), strict=True):
        (logs / f"{job}.log").write_text(f"used {seconds:.2f} s of CPU, 100 MB at most\n")
    rom = {"rom": str(logs.parent / "rom-r.nc")}
    rows = [
        row("3.51 mm", 0.3, 0.02, group="mesh"),
        row("3.51 mm", 0.7, 0.05, group="mesh", on="tangential"),
        row("few", 0.1, 0.02, group="rods"),
        row("few", 0.2, 0.04, group="rods", on="stiff"),
        row("few", 0.5, 0.001, group="rods", on="tangential"),
        row("many", 0.4, 0.004, group="rods"),
        by({}, "1024 steps", 0.02, 0.2),
        by({}, "2048 steps", 0.04, 0.02),
        by(CENTRAL, "central", 0.3, 0.001),
        by(CENTRAL | {"mass_scaling_hz": 25e3}, "scaled", 0.1, 0.05),
        by({}, "no result", 0.001, 0.0, **dict.fromkeys(OBSERVABLES)),
        row("of another group", 0.1, 0.0, group="front"),
    ]
    before = [
        {"stage": "rods", "of": "flat tip", "row": "few", "error": 0.04, "cpu_s": 0.6},
        {"stage": "rods", "of": "flat tip", "row": "many", "error": 0.004, "cpu_s": 0.8},
        {"stage": "mesh", "of": "model", "row": "2.48 mm", "error": 0.02, "cpu_s": 30.0},
    ]
    return stages.records([of | rom for of in rows], before)


def test_settings_have_the_time_of_their_model_or_of_a_run_of_each_scene(study):
    """And the largest error of these scenes; those without a result are left out."""
    found = {
        (of["stage"], of["of"], of["row"]): (of["error"], of["cpu_s"])
        for of in study
        if of["version"] == stages.AFTER
    }
    assert found == {
        ("mesh", "model", "3.51 mm"): (0.05, 7.5),
        ("rods", "flat tip", "few"): (0.04, pytest.approx(0.3)),
        ("rods", "tilted tip", "few"): (0.001, 0.5),
        ("rods", "flat tip", "many"): (0.004, 0.4),
        ("step, piecewise-exact", "flat tip", "1024 steps"): (0.2, 0.02),
        ("step, piecewise-exact", "flat tip", "2048 steps"): (0.02, 0.04),
        ("step, central", "flat tip", "central"): (0.001, 0.3),
        ("step, mass-scaled", "flat tip", "scaled"): (0.05, 0.1),
    }
    assert len(study) == len(found) + 3


def test_the_table_has_the_fastest_setting_that_meets_a_level_before_and_after(study):
    by_stage = {(stage, of): levels for stage, of, *levels in cells(stages.table(study))}
    assert by_stage["rods", "flat tip"] == [
        "few: 0.6 → 0.3", "many: 0.8 → 0.4", "many: 0.8 → 0.4",
    ]  # fmt: skip
    assert by_stage["mesh", "model"] == [
        "2.48 mm → 3.51 mm: 30 → 7.5", "2.48 mm: 30 → -", "none: - → -",
    ]  # fmt: skip
    assert by_stage["step, piecewise-exact", "flat tip"][:2] == ["2048 steps: - → 0.04"] * 2


def test_the_picture_has_a_panel_for_each_stage_with_both_versions(study):
    """Points in the order of their time."""
    rods = figure.draw(study).axes[1]
    assert rods.get_title(loc="right") == "rods"
    lines = {line.get_label(): line.get_xydata().tolist() for line in rods.lines}
    assert lines["flat tip, before"] == [[0.6, 4.0], [0.8, 0.4]]
    assert np.allclose(lines["flat tip, after"], [[0.3, 4.0], [0.4, 0.4]])
    assert lines["tilted tip, after"] == [[0.5, 0.1]]
