"""The paper's targets: what one command would run, and that its table takes in what is there."""

import json

import pytest

from tests.workflow.projects import make_project
from tests.workflow.test_claims import AS_IN_THE_PAPER, with_change

CLAIMS = "results/paper/claims.json"


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    return make_project(tmp_path_factory.mktemp("paper"))


def put(project, edition, numbers):
    """Numbers of an edition as if they had been run."""
    file = project.folder / f"results/paper/{edition}/numbers.json"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(numbers))


def judged(project):
    """Make the claims table, and only that, from the numbers that are there."""
    project.run(CLAIMS, "--allowed-rules", "paper_claims")
    return {row["id"]: row for row in json.loads((project.folder / CLAIMS).read_text())}


def test_one_command_plans_every_figure_and_the_table(project):
    planned = project.planned("paper")
    assert planned["grid_row"] == 9 and planned["paper_claims"] == 1
    # 02 04 05 06 07 08 13 13-k6 14 15 15-without 16, which cases are predictable, worst
    assert planned["paper_figure"] == 14
    assert planned["repeat_sweep"] == planned["cause"] == 0  # targets of their own


def test_nothing_is_run_twice_for_two_figures(project):
    planned = project.planned("paper")
    # e1, e10, two-five, tilted, tangential, rigid, peak, two densities, three steps
    assert planned["sweep"] == 12


def test_repeats_causes_and_the_other_blade_are_targets(project):
    repeats = project.planned("paper_uncertainty")
    assert repeats["grid_row"] == 27 and repeats["repeat_sweep"] == 18
    assert project.planned("paper_causes")["stiffness_row"] == 3
    assert project.planned("paper_rotor37")["paper_numbers"] == 1


def test_the_table_takes_in_what_has_been_run(project):
    put(project, "reference", AS_IN_THE_PAPER)
    alone = judged(project)
    assert len(alone) == 26
    assert alone["C12"]["uncertainty"] == {} and alone["C12"]["other"] == {}
    put(project, "half-step", with_change("e10.peaks.4.amplitude", 0.9))
    put(project, "rotor37", with_change("tangential.ratio", 0.3))
    beside = judged(project)
    assert list(beside["C12"]["uncertainty"].values()) == pytest.approx([0.6])
    assert beside["C12"]["verdict"] == "undecided"  # 1.5 is more than 1, but not by 0.6
    assert beside["C21"]["other"]["rotor37"]["verdict"] == "differs"
    assert beside["C21"]["verdict"] == "calibrated"
