"""Blades that are reduced models or matrices from elsewhere: jobs, and refusals."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from projects import make_project

from geometry.given import GivenMatrices
from geometry.settings import check_settings
from rom.model import Rom

PAGE = (Path(__file__).parents[2] / "rom/README.md").read_text()
FOREIGN = ("--config", "scenes=[foreign]")


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    return make_project(tmp_path_factory.mktemp("given"))


@pytest.fixture
def full_matrices():
    """The example of the page."""
    text = next(b for b in re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL) if "M.mtx" in b)
    return yaml.safe_load(text)


def test_foreign_model_serves_a_scene_without_a_mesh(project):
    planned = project.planned(*FOREIGN)
    assert planned == {
        "take_rom": 1, "check_scene": 1, "sweep_block": 2, "sweep": 1, "answers": 1, "fig10": 1,
        "fig11": 1, "loads": 1, "summary": 1, "summary_of_run": 1,
    }  # fmt: skip
    project.run("results/foreign/rom-r.nc", *FOREIGN)
    rom = Rom.load(project.folder / "results/foreign/rom-r.nc")
    assert rom.foreign and rom.provenance.blade == "foreign"


@pytest.mark.slow
def test_foreign_model_that_is_damaged_is_refused(project):
    file = project.folder / "workflow/blades/broken.nc"
    file.write_text("no model")
    (file.with_suffix(".yaml")).write_text("reduced_model: broken.nc\n")
    said = project.run("results/broken/rom-r.nc", expect=1)
    assert "take_rom: workflow/blades/broken.yaml: workflow/blades/broken.nc: cannot be rea" in said


@pytest.mark.slow
def test_foreign_model_without_the_direction_of_the_scene_is_refused(project):
    said = project.run("results/foreign/rom-rt.nc", *FOREIGN, expect=1)
    assert "the reduced model has no tangential interface DoFs" in said


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"record": {"states_rounds": 1}}, "record.states_rounds: blade 'foreign' is a model or m"),
        ({"record": {}}, "explore: blade 'foreign' is a model or matrices from else"),
    ],
)
def test_pictures_of_the_whole_blade_are_refused(change, said, project):
    path = project.folder / "workflow/scenes/mine.yaml"
    path.write_text(yaml.safe_dump({"base": "foreign"} | change))
    explored = ["explore=[mine]"] if "explore" in said else ["explore=[]"]
    assert said in project.run("-n", "--config", "scenes=[mine]", *explored, expect=1)


def test_full_matrices_are_reduced_and_checked_at_their_speeds(project, full_matrices):
    blades = project.folder / "workflow/blades"
    (blades / "mine.yaml").write_text(yaml.safe_dump(full_matrices))
    fault = "workflow/blades/mine.yaml: full_matrices: 'M.mtx': no such file"
    assert fault in project.run("-n", "results/mine/rom-check-r.nc", expect=1)
    for file in check_settings(GivenMatrices, full_matrices, "the page").files:
        (blades / file).touch()
    planned = project.planned("results/mine/rom-check-r.nc")
    assert planned == {"read_matrices": 1, "reduce": 1, "solve_given_model": 1, "check_rom": 1}


def test_command_of_a_new_scene_of_matrices_can_run(project, full_matrices):
    blades = project.folder / "workflow/blades"
    (blades / "plain.yaml").write_text(yaml.safe_dump(full_matrices))
    for file in check_settings(GivenMatrices, full_matrices, "the page").files:
        (blades / file).touch()
    module = [sys.executable, "-m", "workflow.new", str(project.folder)]
    said = subprocess.run(
        [*module, "scene", "rub-plain", "plain"],
        cwd=project.folder,
        env=project.environment,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    ).stdout
    run, snakemake, *arguments = shlex.split(said.split("then: ")[1])
    assert (run, snakemake) == ("./run", "snakemake")
    assert project.planned(*arguments)["read_matrices"] == 1


def test_other_keys_beside_a_reduced_model_are_refused(project):
    blade = project.folder / "workflow/blades/both.yaml"
    blade.write_text("reduced_model: foreign.nc\nmax_speed_rad_s: 650\n")
    said = project.run("-n", "results/both/rom-r.nc", expect=1)
    assert "workflow/blades/both.yaml: max_speed_rad_s: unknown key" in said
