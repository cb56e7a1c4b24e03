import json
import os
import shutil
import signal
import subprocess
import time

import numpy as np
import pytest
from projects import SPEEDS, Project, make_project

from rom.check import RomCheck
from rom.model import Rom
from simulate.sweep import load

BLADE = "results/reference"


@pytest.fixture
def touched(project, tmp_path) -> Project:
    """The finished project with its results and Snakemake's memory, to be edited."""
    shutil.copytree(project.folder, tmp_path / "copy", symlinks=True)
    return Project(tmp_path / "copy")


def test_end_to_end_delivers_models_sweeps_and_figures(project):
    rom = Rom.load(project.folder / BLADE / "rom-rtz.nc")
    check = RomCheck.load(project.folder / BLADE / "rom-check.nc")
    assert abs(check.error[:, :7]).max() < 0.01
    assert rom.n <= 90
    for scene in ("paper-e1", "paper-e10"):
        sweep = load(project.folder / BLADE / scene / "sweep.nc")
        np.testing.assert_allclose(sweep.speed_over_f1, SPEEDS, rtol=1e-12)
        assert set(sweep.status.values) == {"ok"}
        assert sweep.wear.max() > 0
    figures = {path.name for path in (project.folder / "results/figures").iterdir()}
    for stem in ("fig10a", "fig10b", "fig11a", "fig11b", "fig12"):
        assert {f"{stem}.png", f"{stem}.pdf"} <= figures
    assert any(name.startswith("fig03") for name in figures)
    assert any(name.startswith("fig09") for name in figures)


def test_a_finished_project_has_nothing_to_do(project):
    assert project.planned() == {}


def test_a_blade_without_a_scene_has_figures_that_nobody_else_asks_for(project):
    planned = project.planned(*(f"results/figures/{fig}-rotor37.png" for fig in ("fig03", "fig09")))
    assert planned["build_mesh"] == planned["fig03"] == planned["fig09"] == 1
    assert not (project.folder / "results/rotor37").exists()


def test_frequencies_of_both_prestresses_are_a_study_of_their_own(project):
    project.run(f"{BLADE}/frequencies.json")
    found = json.loads((project.folder / BLADE / "frequencies.json").read_text())
    check = RomCheck.load(project.folder / BLADE / "rom-check.nc")
    at = np.isin(check.speeds, found["speeds_rad_s"])
    assert at.sum() == 3
    # the blade's own prestress, by the same matrices: round-off of the eigensolver
    np.testing.assert_allclose(found["nonlinear_rad_s"], check.full[at, :8], rtol=1e-8)
    nonlinear, linear = (np.array(found[f"{name}_rad_s"]) for name in ("nonlinear", "linear"))
    np.testing.assert_allclose(linear[0], nonlinear[0], rtol=1e-8)
    # they differ with the deflection: f1 at full speed by 0.1 to 1 %
    assert 1e-4 < abs(linear[2, 0] / nonlinear[2, 0] - 1) < 1e-2


def test_nothing_half_written_stays(project):
    hidden = [path for path in (project.folder / "results").rglob(".*")]
    assert hidden == []


def test_a_changed_liner_reruns_its_sweep_and_no_mesh(touched):
    touched.edit("workflow/scenes/paper-e10.yaml", lambda scene: scene["liner"].update(K=9.09))
    planned = touched.planned()
    assert planned["sweep_block"] == 2  # of the other scene none
    assert planned["sweep"] == 1
    assert not {"build_mesh", "assemble", "reduce", "check_rom"} & set(planned)


def test_a_changed_figure_reruns_no_sweep(touched):
    (module,) = (touched.folder / "workflow/figures").glob("fig12*.py")
    module.write_text(module.read_text() + "\n# a change\n")
    planned = touched.planned()
    assert sum(planned.values()) == 1, planned
    assert all("fig12" in rule or "profile" in rule for rule in planned), planned


def test_there_are_no_more_blocks_than_speeds(touched):
    touched.edit("workflow/config.yaml", lambda config: config.update(blocks=1000))
    assert touched.planned("sweeps")["sweep_block"] == 2 * len(SPEEDS)


def test_a_changed_basis_reruns_no_mesh(touched):
    touched.edit(
        "workflow/blades/reference.yaml",
        lambda blade: blade["basis"].update(fixed_interface_modes=8),
    )
    planned = touched.planned("sweeps")
    assert planned["reduce"] == 1
    assert planned["sweep_block"] == 4
    assert not {"build_mesh", "assemble"} & set(planned)


def test_an_edited_package_reruns_its_stage(touched):
    law = touched.folder / "simulate/plastic.py"
    law.write_text(law.read_text() + "\n# a change\n")
    planned = touched.planned("sweeps")
    assert planned["sweep_block"] == 4
    assert not {"build_mesh", "assemble", "reduce"} & set(planned)


@pytest.mark.parametrize(
    ("path", "key", "value", "words"),
    [
        ("workflow/scenes/paper-e1.yaml", "rouns", 3, "paper-e1.yaml: rouns: unknown key"),
        (
            "workflow/blades/reference.yaml",
            "max_speed",
            3,
            "reference.yaml: max_speed: unknown key",
        ),
        ("workflow/config.yaml", "scenes", ["none"], "workflow/scenes/none.yaml: cannot be read"),
        ("workflow/config.yaml", "block", 3, "config.yaml: block: unknown key"),
        ("workflow/scenes/paper-e1.yaml", "blade", "none", "paper-e1.yaml: blade: 'none'"),
        ("workflow/config.yaml", "blocks", 0, "config.yaml: blocks: allowed 1 to 1000"),
    ],
)
def test_bad_input_stops_before_any_job(touched, path, key, value, words):
    touched.edit(path, lambda values: values.update({key: value}))
    output = touched.run(expect=1)
    assert words in output
    assert "Traceback" not in output


def test_a_speed_beyond_the_reduced_model_fails_with_one_sentence(touched):
    touched.edit(
        "workflow/scenes/paper-e1.yaml", lambda scene: scene.update(speeds={"over_f1": [0.6]})
    )
    output = touched.run(f"{BLADE}/paper-e1/sweep.nc", expect=1)
    assert "sweep_block: speeds.over_f1: 0.6: allowed up to 0.39" in output


def test_a_killed_sweep_goes_on_where_it_was(project, tmp_path):
    """Snakemake killed with -9: finished blocks are kept, those in flight and the rest are made."""
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
    deadline = time.monotonic() + 120
    while len(blocks := sorted(folder.glob("block-*.nc"), key=os.path.getmtime)) < 3:
        assert process.poll() is None and time.monotonic() < deadline
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    # two run at a time: when a third block is there, Snakemake has booked the first two
    written = [path.stat().st_mtime_ns for path in blocks[:2]]
    assert not (folder / "sweep.nc").exists()
    killed.run(target)
    assert [path.stat().st_mtime_ns for path in blocks[:2]] == written
    assert len(load(folder / "sweep.nc").speed) == len(SPEEDS)
