import json
import os
import re
import shutil
import signal
import subprocess
import time
from zipfile import ZipFile

import meshio
import numpy as np
import pytest
from projects import ROOT, SPEEDS, Project, make_project

from geometry.base import read_json, write_json
from rom.check import RomCheck
from rom.model import Rom
from simulate.sweeps.dataset import load

BLADE = "results/paper"
E1, E10, PEAK = (f"workflow/scenes/{name}.yaml" for name in ("paper-e1", "paper-e10", "peak-e1"))
CONFIG, REFERENCE = "workflow/config.yaml", "workflow/blades/reference.yaml"


@pytest.fixture
def touched(project, tmp_path) -> Project:
    """The finished project with its results and Snakemake's metadata, to be edited."""
    return Project(shutil.copytree(project.folder, tmp_path / "copy", symlinks=True))


@pytest.mark.slow
def test_end_to_end_delivers_models_sweeps_and_figures(project):
    rom = Rom.load(project.folder / BLADE / "rom-r.nc")
    RomCheck.load(project.folder / BLADE / "rom-check-r.nc").require(0.1)
    assert rom.n <= 65
    for scene in ("paper-e1", "paper-e10"):
        sweep = load(project.folder / BLADE / scene / "sweep.nc")
        np.testing.assert_allclose(sweep.speed_over_f1, SPEEDS, rtol=1e-12)
        assert set(sweep.status.values) == {"ok"}
        assert sweep.wear.max() > 0
        page = (project.folder / BLADE / scene / "explore.html").read_text()
        assert f"Rub of paper, {scene}" in page and '"shapes"' in page
    stems = {path.stem for path in (project.folder / "results/figures").iterdir()}
    assert stems >= {"fig03", "fig09", "fig10a", "fig10b", "fig11a", "fig11b", "fig12"}
    assert stems >= {"stress-paper-e1", "loads-paper", "haigh-paper-e1"}
    # nothing is left half made, nothing is to be done
    assert "states" not in sweep
    assert list((project.folder / "results").rglob(".*")) == []
    assert project.planned() == {}


@pytest.mark.slow
def test_the_summary_has_every_scene_and_is_the_last_that_is_said(project):
    summary = read_json(project.folder / "results/summary.json")
    assert [of["scene"] for of in summary["scenes"]] == ["paper-e1", "paper-e10", "peak-e1"]
    rows = [row for of in summary["scenes"] for row in of["rows"]]
    assert all(row["values"]["force"] > 0 and row["word"] for row in rows)
    assert all(
        ("alternating" in row["values"]) is (row["course"]["trend"] != "growing") for row in rows
    )
    assert any(row["values"].get("alternating", 0) > 1e6 for row in rows)
    assert len((project.folder / "results/summary.csv").read_text().splitlines()) == 1 + len(rows)
    (project.folder / "results/summary.json").unlink()
    said = project.run()
    assert "Summary: results/summary.md" in said[said.index("paper-e1: blade paper") :]


@pytest.mark.slow
def test_the_report_has_the_pages_to_explore_as_files(project):
    """Browsers block a page of over 2 MB within a page."""
    (archive,) = re.findall(r"--report (\S+)", (ROOT / "workflow/README.md").read_text())
    project.run("--report", archive)
    with ZipFile(project.folder / archive) as report:
        names = [name for name in report.namelist() if name.endswith("/explore.html")]
        pages = {report.read(name) for name in names}
    for scene in ("paper-e1", "paper-e10"):
        assert (project.folder / BLADE / scene / "explore.html").read_bytes() in pages


@pytest.mark.slow
@pytest.mark.parametrize(("explored", "pages"), [("peak-e1", 1), ("", 0)])
def test_a_page_is_made_of_the_sweep_that_is_there(project, explored, pages):
    """Of a scene without one before; none that was there is missed by its sweep."""
    planned = project.planned("--config", f"explore=[{explored}]")
    assert planned["explore"] == pages
    assert not planned.keys() & {"check_scene", "sweep_block", "sweep", "answers", "stress"}


@pytest.mark.slow
def test_a_change_of_settings_is_shown_by_a_hash(touched):
    """Not by all values of the scene."""
    touched.edit("workflow/scenes/paper-e10.yaml", lambda scene: scene.update(rounds=5))
    said = touched.run("-n", "sweeps")
    (reason,) = {line for line in said.splitlines() if "Params have changed" in line}
    assert len(reason) < 400 and "before: settings " in reason


@pytest.mark.slow
def test_the_pages_example_gives_the_stress_at_a_recorded_time(project, monkeypatch):
    """The Python in fem/README.md, run where the results are."""
    page = (ROOT / "fem/README.md").read_text()
    (code,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    monkeypatch.chdir(project.folder)
    names = {}
    exec(compile(code, "fem/README.md", "exec"), names)
    mesh = meshio.read(project.folder / "field.vtu")
    (project.folder / "field.vtu").unlink()
    assert mesh.point_data["von Mises (Pa)"].max() == names["found"].total.von_mises.max() > 1e7
    assert abs(mesh.point_data["vibration (m)"]).max() > 0


# jobs of targets that are made on demand alone
ON_DEMAND = {
    # matrices of each further size, no reduced model, no run
    ("study_mesh",): {
        "assemble": 4,
        "experiment_block": 2,
        "experiment": 1,
        "draw_mesh_convergence": 1,
        "study_mesh": 1,
        "reduce": 0,
        "modes": 0,
    },
    # a blade without a scene
    ("results/figures/campbell-rotor37.png", "results/figures/modes-rotor37.png"): {
        "build_mesh": 1,
        "draw_campbell_blade": 1,
        "draw_modes_blade": 1,
    },
    # a scene that starts from another waits for it: a block for each sweep
    (f"{BLADE}/run-down/sweep.nc",): {"sweep": 2, "sweep_block": 2, "build_mesh": 0},
    # three long ones, up, down, over the worn liner
    ("results/figures/long-times.png",): {"draw_long_times": 1, "sweep": 6},
}


@pytest.mark.slow
@pytest.mark.parametrize("targets", ON_DEMAND)
def test_targets_on_demand_have_their_jobs(project, targets):
    planned = project.planned(*targets)
    assert {rule: planned[rule] for rule in ON_DEMAND[targets]} == ON_DEMAND[targets]
    for made in ("results/rotor37", f"{BLADE}/mesh-convergence"):
        assert not (project.folder / made).exists()


@pytest.mark.slow
def test_frequencies_of_both_prestresses_are_rows_of_an_experiment(project):
    """On the blade, and on a variant of it that has no file of its own."""
    mine = project.folder / "workflow/experiments/mine.yaml"
    rows = {"linear": {}, "nonlinear": {"blade": "paper-nonlinear"}}
    values = {"of": ["paper-e1"], "rows": rows, "marched": False, "needs": ["mesh", "matrices"]}
    mine.write_text(json.dumps(values | {"numbers": "study.frequencies:numbers"}))
    project.run("results/experiments/mine/table.json")
    table = read_json(project.folder / "results/experiments/mine/table.json")
    f = {row["row"]: np.array(row["numbers"]["frequencies_Hz"]) for row in table}
    check = RomCheck.load(project.folder / BLADE / "rom-check-r.nc")
    at = np.isclose(check.speeds[:, None], table[0]["numbers"]["speeds_rad_s"]).any(axis=1)
    assert at.sum() == 3
    # the blade's own prestress, by the same matrices: round-off of the eigensolver
    np.testing.assert_allclose(2 * np.pi * f["linear"], check.full[at], rtol=1e-8)
    np.testing.assert_allclose(f["linear"][0], f["nonlinear"][0], rtol=1e-8)
    # they differ with the deflection: f1 at full speed by 0.1 to 1 %
    assert 1e-4 < abs(f["linear"][2, 0] / f["nonlinear"][2, 0] - 1) < 1e-2
    assert not (project.folder / "results/paper-nonlinear/rom-r.nc").exists()


@pytest.mark.slow
def test_the_papers_own_model_is_a_blade_of_its_own(project):
    """Eight points with six modes at three speeds."""
    of_model = "results/paper/paper-model.json"
    project.run(of_model)
    of_paper = Rom.load(project.folder / f"{BLADE}-points/rom-rtz.nc")
    ours = Rom.load(project.folder / f"{BLADE}/rom-r.nc")
    model = read_json(project.folder / of_model)["model"]
    assert model["n"] == of_paper.n > ours.n
    assert model["error"] > model["error_default"]


def edited(path, **values):
    """A change of a file of settings."""
    return lambda project: project.edit(path, lambda of: of.update(values))


def with_a_comment(path):
    """A change of a module."""

    def change(project):
        module = project.folder / path
        module.write_text(module.read_text() + "\n# a change\n")

    return change


BEFORE_SWEEPS = ("build_mesh", "assemble", "reduce", "check_rom")
# the change, targets, jobs of these rules, and jobs that are not run again
CHANGES = {
    # two scenes in two blocks, one at a single speed
    "a law": (
        with_a_comment("simulate/scene/laws/plastic.py"),
        ["sweeps"],
        {"sweep_block": 5},
        BEFORE_SWEEPS,
    ),
    # of the other scene none
    "a liner": (
        lambda project: project.edit(E10, lambda scene: scene["liner"]["law"].update(K=9.09)),
        [],
        {"sweep_block": 2, "sweep": 1},
        BEFORE_SWEEPS,
    ),
    "a basis": (
        edited(REFERENCE, basis={"natural_modes": 15}),
        ["sweeps"],
        {"reduce": 1, "sweep_block": 5},
        ["build_mesh", "assemble"],
    ),
    # it decides at how many speeds the full model is assembled
    "a tolerance": (
        edited(REFERENCE, basis={"tolerance_percent": 1}),
        [],
        {"assemble": 1, "reduce": 1, "check_rom": 1, "sweep_block": 5},
        ["build_mesh"],
    ),
    # no more blocks than speeds; peak-e1 has its one
    "blocks": (
        edited(CONFIG, blocks=1000),
        ["sweeps"],
        {"sweep_block": 2 * len(SPEEDS)},
        BEFORE_SWEEPS,
    ),
}
# the module, and all jobs that are run again
ALONE = {
    "workflow/figures/loads.py": {"draw_loads_blade": 1},
    "fem/fields.py": {
        "draw_stress_scene": 3,
        "draw_haigh_scene": 3,
        "stress": 3,
        "answers": 3,
        "explore": 2,
        "draw_loads_blade": 1,
        "summary": 1,
    },
}


@pytest.mark.slow
@pytest.mark.parametrize("name", CHANGES)
def test_a_change_reruns_what_depends_on_it(touched, name):
    change, targets, jobs, kept = CHANGES[name]
    change(touched)
    planned = touched.planned(*targets)
    assert {rule: planned[rule] for rule in (*jobs, *kept)} == jobs | dict.fromkeys(kept, 0)


@pytest.mark.slow
@pytest.mark.parametrize("module", ALONE)
def test_a_changed_module_of_results_reruns_no_sweep(touched, module):
    with_a_comment(module)(touched)
    assert touched.planned() == ALONE[module]


@pytest.mark.slow
def test_nothing_is_marched_on_a_model_that_misses_its_tolerance(touched):
    edited(REFERENCE, basis={"tolerance_percent": 1e-6, "natural_modes": 9})(touched)
    output = touched.run("sweeps", expect=1)
    assert "above basis.tolerance_percent 1e-06; " in output
    assert "rule sweep_block" not in output


@pytest.mark.parametrize(
    "faults",
    [
        [
            (E1, "rouns", 3, "rouns: unknown key"),
            (REFERENCE, "max_speed", 3, "max_speed: unknown key"),
        ],
        [
            (CONFIG, "block", 3, "block: unknown key"),
            (CONFIG, "blocks", 0, "blocks: 0: should be greater than"),
        ],
        [
            (CONFIG, key, ["none"], f"{key}: 'none': no workflow/scenes/none.yaml")
            for key in ("scenes", "explore")
        ],
        [
            (
                E1,
                "speeds",
                {"over_f1": None, "rpm": [59000.0]},
                "speeds.rpm: 59000: allowed up to 6207.04",
            ),
            (E10, "start", {"scene": "none"}, "start.scene: 'none': no other scene of workflow/sc"),
            (PEAK, "blade", "none", "blade: 'none'"),
        ],
        [
            (
                E1,
                "start",
                {"scene": "paper-e10"},
                "start.scene: 'paper-e10': holds no ends; set `record: {end: true}`",
            )
        ],
    ],
    ids=["keys", "config", "scenes", "values", "start"],
)
def test_bad_input_stops_before_any_job(tmp_path, faults):
    """All faults that do not hide each other are said at once."""
    project = make_project(tmp_path)
    for path, key, value, _ in faults:
        project.edit(path, lambda values, of={key: value}: values.update(of))
    output = project.run(expect=1)
    for path, *_, words in faults:
        assert f"{path}: {words}" in output
    assert "Traceback" not in output and not (tmp_path / "results").exists()


@pytest.mark.slow
def test_files_of_odd_names_and_a_fault_of_a_base(tmp_path):
    """Names that no pattern takes break nothing; a fault of a base is one line for all above it."""
    project = make_project(tmp_path)
    for name in ("a(b", "{x}", "a+b"):
        for folder in ("blades", "scenes"):
            (tmp_path / f"workflow/{folder}/{name}.yaml").write_text("x: 1")
    assert project.planned("sweeps")["sweep"] > 1
    project.edit("workflow/scenes/paper.yaml", lambda scene: scene.update(rounds=0))
    output = project.run("-n", expect=1)
    assert output.count("rounds: 0") == 1
    assert "workflow/scenes/paper.yaml: rounds: 0: should be greater than or equal to 1" in output


def name_file(project, file):
    """The reference blade, which has scenes, from a table of sections in ``file``."""
    table = {"file": str(file), "unit": "mm", "edge_cut_percent": 1}
    edited(REFERENCE, sections=None, section_table=table)(project)


@pytest.mark.slow
def test_a_file_of_geometry_that_is_missing_is_refused_and_one_elsewhere_is_not(tmp_path):
    project = make_project(tmp_path)
    name_file(project, "none.csv")
    output = project.run("-n", expect=1)
    assert "workflow/blades/paper.yaml: section_table.file: 'none.csv': " in output
    assert "Traceback" not in output and "MissingInput" not in output
    name_file(project, shutil.copy(ROOT / "workflow/blades/rotor37-sections.csv", tmp_path))
    assert project.planned("mesh")["build_mesh"] == 1


@pytest.mark.slow
def test_what_cannot_be_made_is_refused_in_a_sentence_before_any_job(tmp_path):
    """Stresses of a design; a Snakefile that is started from elsewhere."""
    (tmp_path / "project").mkdir()
    project = make_project(tmp_path / "project")
    elsewhere = Project(tmp_path)
    sentences = {
        "workflow/scenes/five-factors.yaml: without the motion ": project.run(
            f"{BLADE}/five-factors/stress.json", expect=1
        ),
        f"{tmp_path}: no workflow/config.yaml; start in the folder of a project": elsewhere.run(
            "-s", str(project.folder / "Snakefile"), expect=1
        ),
        "--config: explore: 'rub': should be a valid list; ": project.run(
            "--config", "explore=rub", expect=1
        ),
    }
    for sentence, said in sentences.items():
        assert said.strip().splitlines()[-1].startswith(sentence)
        assert not any(
            word in said for word in ("Traceback", "Exception", "WorkflowError", 'File "')
        )
    assert not (project.folder / "results").exists()


@pytest.mark.slow
def test_a_running_geometry_is_brought_to_rest(tmp_path):
    """By a job of its own: blades at rest do not wait for the finite elements."""
    project = make_project(tmp_path)
    assert project.planned("mesh")["build_mesh"] == 1
    project.edit(REFERENCE, lambda blade: blade.update(geometry_at_rpm=5600))
    planned = project.planned("mesh")
    assert planned["build_mesh_at_rest"] == 1 and "build_mesh" not in planned
    project.run("mesh")
    log = (project.folder / "results/paper/logs/mesh.log").read_text()
    assert "at rest: nodes moved by up to 0.3781 mm; at 5600 rpm" in log


@pytest.mark.slow
def test_a_speed_above_omega_m_fails_with_one_sentence(touched):
    edited(E1, speeds={"over_f1": [0.6]})(touched)
    output = touched.run(f"{BLADE}/paper-e1/sweep.nc", expect=1)
    assert f"check_scene: {E1}: speeds.over_f1: 0.6: allowed up to 0.39" in output
    assert "sweep_block: workflow" not in output  # told once, not by each block
    assert "simulate/marching/run.py" not in output  # the modules that the job imports
    assert "Traceback" not in output


@pytest.mark.nightly
def test_a_killed_sweep_continues_with_the_missing_blocks(project, tmp_path):
    """Snakemake killed with -9: finished blocks are kept, all others are made."""
    killed = make_project(tmp_path)
    shutil.copytree(project.folder / BLADE, tmp_path / BLADE)
    shutil.rmtree(tmp_path / BLADE / "paper-e1")
    killed.edit("workflow/config.yaml", lambda config: config.update(blocks=4))
    shutil.copytree(project.folder / ".snakemake", tmp_path / ".snakemake", dirs_exist_ok=True)
    target = f"{BLADE}/paper-e1/sweep.nc"
    process = subprocess.Popen(
        killed.command(target),
        cwd=tmp_path,
        env=killed.environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    folder = tmp_path / BLADE / "paper-e1"
    deadline = (
        time.monotonic() + 300
    )  # hung: each block compiles its kernel, tens of seconds at most
    try:
        while len(blocks := sorted(folder.glob("block-*.nc"), key=os.path.getmtime)) < 3:
            assert process.poll() is None and time.monotonic() < deadline
            time.sleep(0.05)
    finally:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    # two run at a time: when a third block is there, Snakemake has booked the first two
    written = [path.stat().st_mtime_ns for path in blocks[:2]]
    assert not (folder / "sweep.nc").exists()
    killed.run(target)
    assert [path.stat().st_mtime_ns for path in blocks[:2]] == written
    assert len(load(folder / "sweep.nc").speed) == len(SPEEDS)


@pytest.mark.slow
def test_an_accuracy_adds_a_pilot_whose_choice_is_in_the_sweep(touched):
    folder = f"{BLADE}/one-percent"
    asked = (f"{folder}/sweep.nc", "--config", "scenes=[one-percent]")
    assert touched.planned(*asked) == {"pilot": 1, "sweep_block": 2, "sweep": 1}
    refused = touched.run(*asked, expect=1)
    assert "one-percent.yaml: accuracy: 0.01: the relative error of the mesh is 0.13" in refused
    # as if the mesh were fine, and a scene that no interface is too coarse for: it never touches
    mesh_error = touched.folder / BLADE / "mesh-error.json"
    write_json(read_json(mesh_error) | {"error": 0.002}, mesh_error)
    touched.edit(
        "workflow/scenes/one-percent.yaml", lambda scene: scene.update(casing={"scale": 0.5})
    )
    touched.run(*asked)
    choice = read_json(touched.folder / folder / "settings.json")
    found = load(touched.folder / folder / "sweep.nc")
    assert json.loads(found.attrs["accuracy"]) == choice
    assert 0 < choice["basis_error"] < choice["mesh_error"] < choice["accuracy"] == 0.01
    assert (found["status"] == "no-contact").all() and found["error"].max() <= 0.01
