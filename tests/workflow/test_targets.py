"""What the rules ask of a project, without Snakemake."""

import pickle
import shutil
from logging import LogRecord
from types import SimpleNamespace

import pytest
import yaml
from projects import ROOT

from geometry.base import SettingsError, sources_of
from workflow.targets.experiments import Experiments
from workflow.targets.inputs import ROOT as OF_CODE, Once, Told, code_of, here, one_of
from workflow.targets.messages import without_traceback
from workflow.targets.paper import Further
from workflow.targets.project import Project, pictures

BLADE = "results/paper"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The users' files of a project, in the working directory."""
    for name in ("blades", "scenes", "experiments", "designs", "config.yaml"):
        source = ROOT / "workflow" / name
        copy = shutil.copytree if source.is_dir() else shutil.copy
        (tmp_path / "workflow").mkdir(exist_ok=True)
        copy(source, tmp_path / "workflow" / name)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def write(folder):
    """Write a file of settings."""

    def write(name, **values):
        (folder / "workflow" / f"{name}.yaml").write_text(yaml.safe_dump(values))

    return write


def of(scene="paper-e1", blade="paper", **more):
    """Wildcards of a job."""
    return SimpleNamespace(scene=scene, blade=blade, **more)


def project(*scenes, **given):
    return Project.read({"scenes": [*scenes] or ["paper-e1"], "explore": []} | given)


def test_files_of_a_scene_are_those_that_it_needs(folder):
    scenes = project().scenes
    assert scenes.rom(of()) == f"{BLADE}/rom-r.nc" and scenes.basis(of()) == f"{BLADE}/basis-r.h5"
    assert scenes.check(of()) == f"{BLADE}/rom-check-r.nc"
    assert scenes.checked(of()) == f"{BLADE}/paper-e1/checked"
    assert scenes.stress(of()) == f"{BLADE}/paper-e1/stress.json"
    assert scenes.settings(of()) == scenes.start(of()) == scenes.mesh_error(of()) == []
    accurate = of("one-percent")
    assert scenes.settings(accurate) == f"{BLADE}/one-percent/settings.json"
    assert scenes.mesh_error(accurate) == f"{BLADE}/mesh-error.json"
    assert scenes.checked(accurate) == []
    assert scenes.start(of("run-down")) == f"{BLADE}/run-up/sweep.nc"
    foreign = of("foreign", "foreign")
    assert scenes.check(foreign) == scenes.stress(foreign) == []
    assert scenes.rom_of_blade(foreign) == "results/foreign/rom-r.nc"


def test_a_scene_with_strain_gauges_has_a_model_of_its_own(write):
    gauge = {"name": "root", "at": [440, 1.8, 0], "direction": [1, 0, 0]}
    write("scenes/gauged", base="paper-e1", record={"gauges": [gauge]})
    scenes = project().scenes
    assert scenes.rom(of("gauged")) == f"{BLADE}/gauged/gauges.nc"
    assert scenes.rom_of_blade(of("gauged")) == f"{BLADE}/rom-r.nc"
    assert [one["name"] for one in scenes.told_of_gauges(of("gauged"))["gauges"]] == ["root"]
    with pytest.raises(SettingsError, match=r"scenes/paper-e1.yaml: record.gauges: missing"):
        scenes.told_of_gauges(of())


def test_a_sweep_of_a_meshed_blade_keeps_its_motion(folder):
    scenes = project().scenes
    assert scenes.told(of())["record"]["motion"] and scenes["paper-e1"].record.motion is None
    assert not scenes.told(of("foreign", "foreign"))["record"]["motion"]
    assert scenes.sweep_with_motion(of()) == f"{BLADE}/paper-e1/sweep.nc"
    with pytest.raises(SettingsError, match="without the motion of a meshed blade"):
        scenes.sweep_with_motion(of("five-factors"))


def test_there_are_no_more_blocks_than_speeds_rows_or_asked_for(write):
    write("scenes/three", base="paper-e1", speeds={"over_f1": [0.3, 0.32, 0.34]}, peaks=None)
    scenes = project(blocks=2).scenes
    assert scenes.block_count(of("three")) == 2
    assert scenes.of_blocks("{blade}/{scene}-{block}.nc")(of("three")) == [
        "paper/three-0.nc",
        "paper/three-1.nc",
    ]
    assert project(blocks=9).scenes.block_count(of("three")) == 3
    assert scenes.block_count(of("run-up")) == 1  # speeds in turn
    count = scenes.design(of("five-factors")).count
    each = [scenes.rows_of_block(of("five-factors", block=block)) for block in "01"]
    assert sum(each) == count and max(each) - min(each) <= 1
    with pytest.raises(SettingsError, match=r"paper-e1.yaml: design: missing: it is no table"):
        scenes.table(of())


def test_rows_of_a_design_on_other_blades_have_their_models(folder, write):
    (folder / "workflow/scenes/two.csv").write_text("blade\npaper\nreference\nforeign\n")
    write("scenes/two", base="paper-e1", design="two.csv", peaks=None)
    scenes = project().scenes
    others = scenes.of_other_blades("rom-check", scenes.blades.foreign)
    assert others(of("two")) == ["results/reference/rom-check-r.nc"]
    rom = scenes.of_row(scenes.rom, "rom")
    check = scenes.of_row(scenes.check, "rom-check", scenes.blades.foreign)
    rows = [of("two", row=str(row)) for row in (1, 2, 3)]
    assert [rom(row) for row in rows] == [
        f"results/{blade}/rom-r.nc" for blade in ("paper", "reference", "foreign")
    ]
    assert check(rows[2]) == []
    (folder / "workflow/scenes/two.csv").write_text("blade\npaper\nnone\n")
    with pytest.raises(SettingsError, match=r"two.csv: column blade: 'none': no workflow/bl"):
        project("two")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"blade": "none"}, "blade: 'none': no workflow/blades/none.yaml"),
        ({"start": {"scene": "bad"}}, "start.scene: 'bad': no other scene of workflow/scenes"),
        ({"start": {"scene": "foreign"}}, "start.scene: 'foreign': its blade is 'foreign'"),
        ({"start": {"scene": "paper-e10"}}, "start.scene: 'paper-e10': holds no ends; set"),
    ],
)
def test_a_scene_that_does_not_fit_is_refused_with_its_file(write, change, said):
    write("scenes/bad", base="paper-e1", **change)
    with pytest.raises(SettingsError) as refused:
        project("bad")
    assert str(refused.value).startswith(f"workflow/scenes/bad.yaml: {said}")


def test_all_faults_are_said_at_once(write):
    for name in ("bad", "worse"):
        write(f"scenes/{name}", base="paper-e1", blade=name)
    with pytest.raises(SettingsError) as refused:
        project("bad", "worse")
    assert [line.split(":")[0] for line in str(refused.value).splitlines()] == [
        "workflow/scenes/bad.yaml",
        "workflow/scenes/worse.yaml",
    ]


def test_a_page_needs_a_mesh_and_one_gap(folder):
    with pytest.raises(SettingsError, match=r"foreign.yaml: explore: blade 'foreign' is a mod"):
        project("foreign", explore=["foreign"])
    with pytest.raises(SettingsError, match="explore: 'at-rest': its page has one gap"):
        project("at-rest", explore=["at-rest"])
    with pytest.raises(SettingsError, match="explore: 'five-factors' is a design"):
        project("five-factors", explore=["five-factors"])


def test_a_folder_without_a_project_is_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SettingsError) as refused:
        Project.read({})
    assert str(refused.value).startswith(f"{tmp_path}: no workflow/config.yaml; start in")
    assert str(refused.value).endswith(f"--directory {ROOT}") and OF_CODE == ROOT


def test_blades_are_told_apart_by_what_they_are_made_of(write):
    write("blades/hot", base="reference", geometry_at_rpm=5000)
    blades = project().blades
    assert blades.foreign == ["foreign"] and "hot" in blades.as_it_runs
    assert (
        "reference" not in blades.as_it_runs
        and "hot" in blades.meshed
        and "foreign" not in blades.reduced
    )
    foreign, plain = of(blade="foreign"), of(blade="reference")
    assert blades.source(foreign) == "workflow/blades/foreign.nc" and blades.source(plain) == []
    assert blades.contents(foreign).keys() == {"workflow/blades/foreign.nc"}
    assert blades.mesh(foreign) == blades.mesh_error(foreign) == []
    assert blades.uses("mesh", "none")(plain).keys() == {"mesh"}
    assert "tolerance_percent" not in blades.uses_of_basis(plain)
    between, basis = blades.speeds_between(plain), blades.speeds_of_basis(plain)[0]
    assert sorted([*basis, *between])[::2] == basis
    assert blades.between(foreign) == [] and blades.modes_of_basis(plain) == 24


def test_a_run_delivers_sweeps_tables_figures_and_a_summary(folder):
    files = project("paper-e1", "five-factors").delivered_files(None)
    design = "results/reference/five-factors"
    assert f"{BLADE}/paper-e1/sweep.nc" in files and f"{design}/design.csv" in files
    assert f"{design}/sweep.nc" not in files
    assert {"results/summary.json", *pictures(["loads-paper"])} <= {*files}
    assert project("paper-e1").others_with_results(None) == []
    (folder / BLADE / "paper-e10").mkdir(parents=True)
    (folder / BLADE / "paper-e10/answers.json").touch()
    assert project("paper-e1").others_with_results(None) == ["paper-e10"]


def test_models_of_blades_have_the_directions_of_their_scenes(folder):
    found = project("paper-e1", "foreign")
    assert found.directions("paper") == "r" and found.directions("rotor37") == "rtz"
    assert found.roms() == [
        *("results/foreign/rom-r.nc", f"{BLADE}/rom-r.nc", f"{BLADE}/rom-check-r.nc")
    ]


def test_jobs_of_an_experiment_have_the_models_and_code_of_its_rows(folder):
    found = project()
    experiments = Experiments(found.blades, 3)
    grid = SimpleNamespace(experiment="grid")
    assert experiments.models(grid) == [f"{BLADE}/rom-r.nc"]
    assert experiments.checks(grid) == [f"{BLADE}/rom-check-r.nc"]
    assert experiments.blocks(grid)[-1] == "results/experiments/grid/block-2.json"
    plan = experiments.plan(grid)
    assert plan["blocks"] == 3 and len(plan["cases"]) == len(experiments.rows(grid))
    functions = {case.function.partition(":")[0] for case in experiments.rows(grid)}
    asked = sources_of("workflow.scripts.experiment_block", *functions)
    assert experiments.code(grid) == here(ROOT / file for file in asked)
    with pytest.raises(SettingsError, match=r"grid.yaml: picture: missing: give lines or cells"):
        experiments.picture(grid)


def test_further_files_of_the_claims_are_those_that_exist(folder):
    further = Further(project().scenes)
    growth = [f"results/experiments/repeats/{name}.json" for name in ("table", "growth")]
    assert further.files("paper_uncertainty", "all")(None) == growth
    assert further.existing(None) == further.times(None) == {}
    (folder / growth[0]).parent.mkdir(parents=True)
    for file in growth:
        assert further.existing(None) == {}  # a group is whole or missing
        (folder / file).touch()
    table, coatings = growth
    assert further.existing(None) == {"repeats": {"table": table, "growth": coatings}}
    assert [*further.times(None)] == growth


def test_settings_are_read_once_and_all_of_their_faults_are_told():
    read = []
    settings = Once("ab", lambda name: read.append(name) or name.upper())
    assert settings.all("aab") == {"a": "A", "b": "B"} and read == ["a", "b"]
    assert "c" not in settings


def test_settings_of_a_job_are_shown_by_a_hash_and_are_a_dictionary_for_it():
    told = Told(rounds=4)
    assert repr(told).startswith("settings ") and repr(told) == repr(Told(rounds=4))
    assert repr(told) != repr(Told(rounds=5)) and type(pickle.loads(pickle.dumps(told))) is dict


def test_code_of_a_script_is_what_that_imports():
    pilot = code_of("pilot")(None)
    assert pilot == here(ROOT / file for file in sources_of("workflow.scripts.pilot"))
    assert {"workflow/jobs/march.py", "workflow/scripts/pilot.py"} <= {
        file.removeprefix(f"{ROOT}/") for file in pilot
    }
    assert "adapter.py" not in " ".join(pilot)  # which changes no result


def test_a_pattern_without_names_matches_nothing():
    assert one_of(["a+b", "c"]) == r"a\+b|c" and one_of([]) == "(?!)"


def test_of_a_refusal_the_terminal_has_the_sentence_alone():
    refused = "InputFunctionException in rule a in file b, line 1:\nError:\n  SettingsError: c: d\n"
    record = LogRecord("", 0, "", 0, f"{refused}Wildcards:\n  scene=c\nTraceback:\n", (), None)
    assert without_traceback(record) and record.msg == "c: d"
    record.msg = "a bug"
    assert without_traceback(record) and record.msg == "a bug"
