"""Blades that are reduced models or matrices from elsewhere: jobs, and refusals."""

import re
import shlex

import pytest
import yaml
from projects import ROOT, make_project
from refused import refused

from geometry.base import check_settings
from geometry.elsewhere import MatricesElsewhere
from rom.elsewhere import read_elsewhere
from rom.model import Rom, RomError
from workflow.jobs.elsewhere import take

PAGE = (ROOT / "rom/README.md").read_text()
FOREIGN = ("--config", "scenes=[foreign]")


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    return make_project(tmp_path_factory.mktemp("given"))


@pytest.fixture
def full_matrices(project):
    """The example of the page, as a blade; and its files, which are not there."""
    text = next(b for b in re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL) if "M.mtx" in b)
    blades = project.folder / "workflow/blades"
    (blades / "plain.yaml").write_text(text)
    return [
        blades / file for file in check_settings(MatricesElsewhere, yaml.safe_load(text), "").files
    ]


def test_foreign_model_serves_a_scene_without_a_mesh(project):
    planned = project.planned(*FOREIGN)
    assert planned == {
        "take_rom": 1, "check_scene": 1, "sweep_block": 2, "sweep": 1, "answers": 1, "summary": 1,
        "draw_spectra_scene": 1, "draw_wear_scene": 1, "draw_loads_blade": 1,
    }  # fmt: skip
    project.run("results/foreign/rom-r.nc", *FOREIGN)
    rom = Rom.load(project.folder / "results/foreign/rom-r.nc")
    assert rom.elsewhere and rom.provenance.blade == "foreign"


def test_measured_frequencies_are_those_of_the_model_that_is_taken(project, tmp_path, capsys):
    """Told in the log of its job; a shift beyond 10 % is refused by its key."""
    blades = project.folder / "workflow/blades"
    source, blade, made = blades / "foreign.nc", blades / "tuned.yaml", tmp_path / "rom-r.nc"
    f1 = read_elsewhere(source, "foreign").f1
    blade.write_text(f"reduced_model: foreign.nc\nfrequencies_Hz: {{1: {0.97 * f1}}}\n")
    take(str(blade), str(source), "r", str(made))
    rom = Rom.load(made)
    assert rom.f1 == pytest.approx(0.97 * f1)
    assert rom.provenance.settings["frequencies_Hz"] == {"1": 0.97 * f1}
    assert "-3 % from the" in capsys.readouterr().out
    blade.write_text(f"reduced_model: foreign.nc\nfrequencies_hz: {{1: {0.8 * f1}}}\n")
    error = refused(RomError, take, str(blade), str(source), "r", str(made))
    assert error.key == "frequencies_Hz.1"


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        pytest.param(
            "reduced_model: broken.nc\n",
            "take_rom: workflow/blades/mine.yaml: workflow/blades/broken.nc: cannot be read",
            marks=pytest.mark.slow,
        ),
        (
            "reduced_model: foreign.nc\nmax_speed_rad_s: 650\n",
            "workflow/blades/mine.yaml: max_speed_rad_s: unknown key",
        ),
    ],
)
def test_foreign_model_that_is_damaged_or_has_other_keys_is_refused(project, settings, said):
    (project.folder / "workflow/blades/broken.nc").write_text("no model")
    (project.folder / "workflow/blades/mine.yaml").write_text(settings)
    assert said in project.run("results/mine/rom-r.nc", expect=1)


@pytest.mark.slow
def test_foreign_model_without_the_direction_of_the_scene_is_refused(project):
    said = project.run("results/foreign/rom-rt.nc", *FOREIGN, expect=1)
    assert "the reduced model has no tangential interface DoFs" in said


@pytest.mark.parametrize(
    ("change", "explored", "said"),
    [
        ({"record": {"states_rounds": 1}}, "", "record.states_rounds: blade 'foreign' is"),
        (
            {"record": {"gauges": [{"name": "a", "at": [1, 0, 0], "direction": [1, 0, 0]}]}},
            "",
            "record.gauges: blade 'foreign' is",
        ),
        ({"record": {}}, "mine", "explore: blade 'foreign' is"),
    ],
)
def test_pictures_of_the_whole_blade_are_refused(change, explored, said, project):
    path = project.folder / "workflow/scenes/mine.yaml"
    path.write_text(yaml.safe_dump({"base": "foreign"} | change))
    given = ("--config", "scenes=[mine]", f"explore=[{explored}]")
    assert said in project.run("-n", *given, expect=1)


def test_full_matrices_are_reduced_and_checked_at_their_speeds(project, full_matrices):
    """Once their files are there; the command of a new scene of theirs can run."""
    target = "results/plain/rom-check-r.nc"
    fault = "workflow/blades/plain.yaml: full_matrices: 'M.mtx': no such file"
    assert fault in project.run("-n", target, expect=1)
    for file in full_matrices:
        file.touch()
    jobs = {"read_matrices": 1, "modes": 1, "reduce": 1, "check_rom": 1}
    assert project.planned(target) == jobs
    said = project.call("workflow.new", str(project.folder), "scene", "rub-plain", "plain")
    run, snakemake, *arguments = shlex.split(said.split("then: ")[1])
    assert (run, snakemake) == ("./run", "snakemake")
    assert project.planned(*arguments)["read_matrices"] == 1
