"""The paper's targets: jobs of one command, and results that its table includes."""

import re

import pytest

from geometry.project import read_json, write_json
from tests.workflow.projects import make_project
from tests.workflow.test_claims import AS_IN_THE_PAPER, with_change
from workflow.paper import page
from workflow.paper.claims import CLAIMS as CLAIMS_OF_PAPER

CLAIMS, TABLE = "results/paper/claims.json", "results/paper/claims.md"


@pytest.fixture
def project(tmp_path):
    return make_project(tmp_path)


def put(project, edition, numbers):
    """Numbers of an edition as if they had been run."""
    write_json(numbers, project.folder / f"results/paper/{edition}/numbers.json")


def claims(project):
    """Rows of the claims table by claim."""
    return {row["id"]: row for row in read_json(project.folder / CLAIMS)}


def judged(project):
    """Make only the claims table, from the numbers that exist."""
    project.run(CLAIMS, TABLE, "--allowed-rules", "paper_claims")
    assert ("on rotor37" in (project.folder / TABLE).read_text()) == (
        (project.folder / "results/paper/rotor37").exists()
    )
    return claims(project)


def test_one_command_plans_every_figure_and_the_table_once(project):
    """Also the figures that the page shows."""
    planned = project.planned("paper")
    assert planned["table_row"] == 9 and planned["paper_claims"] == 1
    # 02 to 09, 10a, 10b, 11a, 11b, 12, 13, 13-k6, 14, 15, 15-without, 16, stress, which cases are
    # predictable, long times, worst
    assert sum(count for rule, count in planned.items() if rule.startswith("draw_")) == 23
    assert planned["repeat_sweep"] == planned["cause"] == 0  # targets of their own
    # e1, e10, two-five, tilted, tangential, rigid, peak, two densities, three steps, six long ones
    assert planned["sweep"] == 18
    shown = {*page.BESIDE, *(name for names in page.BESIDE.values() for name in names)}
    shown |= {claim.figure for claim in CLAIMS_OF_PAPER if claim.figure}
    files = [f"results/figures/{name}.png" for name in sorted(shown)]
    assert project.planned("paper", *files) == planned


@pytest.mark.slow
@pytest.mark.parametrize(
    ("target", "jobs"),
    [
        ("paper_uncertainty", {"table_row": 27, "repeat_sweep": 18}),
        ("paper_causes", {"cause": 36, "table_row": 0}),
        ("paper_rotor37", {"paper_numbers": 1}),
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
def test_an_unknown_edition_is_refused_with_the_known_ones(project):
    output = project.run("-n", "results/paper/rotor38/numbers.json", expect=1)
    assert "results/paper/rotor38: " in output
    assert "reference, rotor37, half-step" in output


@pytest.mark.slow
def test_the_table_includes_results_that_exist(project):
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


MADE = """

ruleorder: made > paper_numbers


rule made:
    output:
        "results/paper/{edition}/numbers.json",
    shell:
        "cp made/{wildcards.edition}.json {output}"
"""


@pytest.mark.slow
def test_the_table_waits_for_results_of_the_same_command(project):
    """The paper and its repeats in one command: the table has all of them."""
    snakefile = project.folder / "Snakefile"
    snakefile.write_text(snakefile.read_text() + MADE)
    repeats = ("half-step", "richer-basis", "twice-density")
    changed = dict.fromkeys(repeats, with_change("e10.peaks.4.amplitude", 0.9))
    for edition, numbers in ({"reference": AS_IN_THE_PAPER} | changed).items():
        write_json(numbers, project.folder / f"made/{edition}.json")
    project.run(CLAIMS, "paper_uncertainty")
    assert claims(project)["C12"]["repeats"] == [*repeats]


def test_no_stage_imports_the_paper_or_the_compiler(project):
    """A dry run only reads settings."""
    snakefile = project.folder / "Snakefile"
    at_end = '\nimport atexit, sys\natexit.register(lambda: print("IMPORTED", *sys.modules))\n'
    snakefile.write_text(snakefile.read_text() + at_end)
    (imported,) = re.findall("^IMPORTED (.*)$", project.run("-n"), re.MULTILINE)
    assert "simulate.scene.scene" in imported.split()
    assert not [name for name in imported.split() if name.startswith(("numba", "workflow.paper"))]
