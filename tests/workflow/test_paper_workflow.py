"""The paper's targets: jobs of one command, and results that its table includes."""

import re

import pytest

from geometry.base import read_json, write_json
from tests.workflow.projects import make_project
from tests.workflow.test_claims import AS_IN_THE_PAPER, with_change
from workflow.paper import page
from workflow.paper.claims import CLAIMS as CLAIMS_OF_PAPER

CLAIMS, TABLE = "results/paper/claims.json", "results/paper/claims.md"


@pytest.fixture
def project(tmp_path):
    return make_project(tmp_path)


NUMBERS, TABLE_OF = "results/paper/numbers.json", "results/experiments/{}/table.json".format
PARTS = ("e1", "e10", "two_five", "tilted", "tangential")  # of an edition
EDITIONS = {
    "repeats": ("half the step", "richer basis", "twice the density"),
    "rotor37": ("rotor37",),
}


def rows(experiment, numbers):
    """Rows of an experiment as if they had been marched, the same for all editions."""
    parts = {part: numbers[part] for part in PARTS if part in numbers}
    return [
        {"names": [name], "scene": part, "numbers": of}
        for name in EDITIONS[experiment]
        for part, of in parts.items()
    ]


def put(folder, experiment, numbers):
    """Results of an experiment as if it had been run."""
    write_json(rows(experiment, numbers), folder / TABLE_OF(experiment))
    write_json({}, folder / f"results/experiments/{experiment}/growth.json")
    write_json({}, folder / "results/rotor37-fast/paper-model.json")


def claims(project):
    """Rows of the claims table by claim."""
    return {row["id"]: row for row in read_json(project.folder / CLAIMS)}


def judged(project):
    """Make only the claims table, from the numbers that exist."""
    project.run(CLAIMS, TABLE, "--allowed-rules", "paper_claims")
    assert ("on rotor37" in (project.folder / TABLE).read_text()) == (
        (project.folder / TABLE_OF("rotor37")).exists()
    )
    return claims(project)


def test_one_command_plans_every_figure_and_the_table_once(project):
    """Also the figures that the page shows."""
    planned = project.planned("paper")
    assert planned["experiment_block"] == 2 and planned["paper_claims"] == 1
    # 02 to 09, 10a, 10b, 11a, 11b, 12, 13, 13-k6, 14, 15, 15-without, 16, stress, worst
    assert sum(count for rule, count in planned.items() if rule.startswith("draw_")) == 21
    # e1, e10, two-five, tilted, tangential, two densities, three steps
    assert planned["sweep"] == 10
    shown = {*page.BESIDE, *(name for names in page.BESIDE.values() for name in names)}
    shown |= {claim.figure for claim in CLAIMS_OF_PAPER if claim.figure}
    files = [f"results/figures/{name}.png" for name in sorted(shown)]
    assert project.planned("paper", *files) == planned


@pytest.mark.slow
@pytest.mark.parametrize(
    ("target", "jobs"),
    [
        ("paper_beyond", {"sweep": 7, "draw_long_times": 1, "experiment_block": 0}),
        ("paper_uncertainty", {"experiment_block": 2, "growth": 1}),
        ("paper_causes", {"experiment_block": 2, "growth": 0}),
        ("paper_rotor37", {"experiment_block": 2, "growth": 1, "paper_model": 1}),
    ],
)
def test_repeats_causes_and_the_other_blade_are_targets(project, target, jobs):
    planned = project.planned(target)
    assert {rule: planned[rule] for rule in jobs} == jobs


@pytest.mark.slow
def test_a_users_file_is_never_part_of_the_paper(project):
    """Whatever its name and contents; its faults are reported when it is used."""
    planned = project.planned("paper", "paper_rotor37")
    for path in ("scenes/paper-mine", "scenes/rotor37-mine", "blades/rotor37-mine"):
        (project.folder / f"workflow/{path}.yaml").write_text("rouns: 3\n")
    assert project.planned("paper", "paper_rotor37") == planned
    used = {"reference/paper-mine/sweep.nc": "scenes/paper-mine"}
    for target, file in (used | {"rotor37-mine/blade.msh": "blades/rotor37-mine"}).items():
        output = project.run("-n", f"results/{target}", expect=1)
        assert f"workflow/{file}.yaml: rouns: unknown key" in output


@pytest.mark.slow
def test_the_table_includes_results_that_exist(project):
    write_json(AS_IN_THE_PAPER, project.folder / NUMBERS)
    alone = judged(project)
    assert len(alone) == 26
    assert alone["C12"]["uncertainty"] == {} and alone["C12"]["other"] == {}
    put(project.folder, "repeats", with_change("e10.peaks.4.amplitude", 0.9))
    put(project.folder, "rotor37", with_change("tangential.ratio", 0.3))
    beside = judged(project)
    assert list(beside["C12"]["uncertainty"].values()) == pytest.approx([0.6])
    assert beside["C12"]["verdict"] == "undecided"  # 1.5 is more than 1, but not by 0.6
    assert beside["C21"]["other"]["rotor37"]["verdict"] == "differs"
    assert beside["C21"]["verdict"] == "calibrated"


MADE = """

ruleorder: made > paper_numbers > experiment
ruleorder: made > growth


rule made:
    output:
        "results/{path}",
    wildcard_constraints:
        path="paper/numbers.json|experiments/.*",
    shell:
        "cp made/{wildcards.path} {output}"
"""


@pytest.mark.slow
def test_the_table_waits_for_results_of_the_same_command(project):
    """The paper and its repeats in one command: the table has all of them."""
    snakefile = project.folder / "Snakefile"
    snakefile.write_text(snakefile.read_text() + MADE)
    write_json(AS_IN_THE_PAPER, project.folder / "made/paper/numbers.json")
    put(project.folder, "repeats", with_change("e10.peaks.4.amplitude", 0.9))
    (project.folder / "results/experiments").rename(project.folder / "made/experiments")
    project.run(CLAIMS, "paper_uncertainty")
    assert claims(project)["C12"]["repeats"] == [*EDITIONS["repeats"]]


def test_no_stage_imports_the_paper_or_the_compiler(project):
    """A dry run only reads settings."""
    snakefile = project.folder / "Snakefile"
    at_end = '\nimport atexit, sys\natexit.register(lambda: print("IMPORTED", *sys.modules))\n'
    snakefile.write_text(snakefile.read_text() + at_end)
    said = project.python("-m", "snakemake", "-n")  # in a process of its own
    (imported,) = re.findall("^IMPORTED (.*)$", said, re.MULTILINE)
    assert "simulate.scene.scene" in imported.split()
    assert not [name for name in imported.split() if name.startswith(("numba", "workflow.paper"))]
