"""Study of cost: what a process uses, exponents, the study itself on tiny blades and scenes."""

import re
import subprocess
import sys
import time

import pytest
import yaml
from projects import ROOT

from geometry.blade import Blade
from geometry.project import UserError, read_json
from simulate.scene import Scene
from simulate.scene.design import Design
from workflow import usage
from workflow.study import scaling

PLAN = ROOT / "workflow/study/scaling.yaml"
X = [1000, 2000, 4000, 8000]
PROGRAM = """
import subprocess, sys, time
from workflow.usage import cpu_time, usage
begun = cpu_time()
time.sleep(1)
b = b"x" * 300_000_000
until = time.process_time() + 0.5
while time.process_time() < until: pass
if "child" in sys.argv: subprocess.run([sys.executable, *sys.argv[2:]])
print(usage(begun))
"""
CHILD = "b = b'x' * 500_000_000"


def used_by(log, *arguments):
    """What the program used, started by a process of 600 MB, and the time that passed."""
    ballast, begun = b"x" * 600_000_000, time.perf_counter()
    with log.open("w") as file:
        command = [sys.executable, "-c", PROGRAM, *arguments]
        subprocess.run(command, cwd=ROOT, stdout=file, check=True)
    assert len(ballast) == 600_000_000
    return usage.read_usage(log), time.perf_counter() - begun


def test_the_cpu_time_and_peak_memory_of_a_process_are_its_own(tmp_path):
    """A sleep costs no time; 300 MB are touched; the 600 MB of what starts it do not count."""
    used, passed = used_by(tmp_path / "log")
    assert 0.5 <= used["seconds"] <= passed - 1
    assert 300 < used["peak_MB"] < 450


def test_processes_that_a_job_has_waited_for_count(tmp_path):
    """One of 500 MB."""
    used, _ = used_by(tmp_path / "log", "child", "-c", CHILD)
    assert 500 < used["peak_MB"] < 650


def test_a_log_is_of_its_last_job_and_one_of_an_older_version_is_refused(tmp_path):
    log = tmp_path / "mesh.log"
    lines = [f"used {seconds} s of CPU, 215 MB at most\n" for seconds in (1.25, 2.5)]
    log.write_text("words\n".join(lines))
    assert usage.read_usage(log) == {"seconds": 2.5, "peak_MB": 215}
    log.write_text("words of the job\n")
    with pytest.raises(UserError, match=re.escape(str(log))):
        usage.read_usage(log)


def test_exponents_are_over_the_last_points_and_memory_is_counted_from_the_first():
    """What the libraries take is no growth: 100 MB + 1e-4 x^2 has the exponent 2 from 10 x0 on."""
    points = [
        {"x": x, "seconds": 5.0 if x == 100 else 0.2 * x**1.37, "peak_MB": 100 + 1e-4 * x**2}
        for x in (100, 1000, 3000, 9000)
    ]
    found = scaling.exponents(points)
    assert found["seconds"] == pytest.approx(1.37, abs=1e-12)
    assert found["peak_MB"] == pytest.approx(2, abs=0.01)
    assert scaling.exponents(points[:2])["peak_MB"] is None


@pytest.fixture
def study(tmp_path, monkeypatch):
    """Numbers of the study from made logs: times grow as the place in `of` squared."""
    monkeypatch.chdir(tmp_path)
    for stage in yaml.safe_load(PLAN.read_text()):
        for place, name in enumerate(stage["of"], 1):
            log = tmp_path / stage["log"].format(name)
            log.parent.mkdir(parents=True, exist_ok=True)
            used = f"used {place**2:.2f} s of CPU, {200 + 100 * place} MB at most"
            log.write_text(f"5 cells, {1000 * 2**place} nodes, fine\n{used}\n")
    return scaling.numbers(type("files", (), {"plan": PLAN}))


def test_the_table_has_every_stage_with_its_numbers(study):
    rows = [row[2:-2].split(" | ") for row in scaling.table(study).splitlines()[2:]]
    assert len(rows) == len(yaml.safe_load(PLAN.read_text()))
    assert rows[0][:5] == ["mesh", "nodes", "2,000", "16,000", "1 to 16"]
    assert rows[0][6] == "300 to 600"
    assert rows[4][:4] == ["matrices", "patches", "8", "32"]


NUMBERS = {
    "strips": lambda scene, path: scene.liner.strips,
    "rods per round": lambda scene, path: scene.liner.rods_per_round,
    "rounds": lambda scene, path: scene.rounds,
    "speeds": lambda scene, path: scene.speeds.count,
    "rows": lambda scene, path: len(Design.of(scene, path).scenes),
}


def test_every_blade_and_scene_of_the_plan_has_the_number_that_it_stands_for():
    for stage in yaml.safe_load(PLAN.read_text()):
        for name, x in zip(stage["of"], stage.get("x", stage["of"]), strict=True):
            if stage["over"] in NUMBERS:
                scene = stage["log"].split("/")[2].format(name)
                path = ROOT / f"workflow/scenes/{scene}.yaml"
                assert NUMBERS[stage["over"]](Scene.load(path), path) == x
            if stage["over"] == "patches":
                path = ROOT / f"workflow/blades/{name}.yaml"
                assert Blade.load(path).interface.patches == x


def tiny(plan):
    """Two small numbers for each kind of stage; meshes of two sizes."""
    of = {"nodes": ["reference-coarse", "reference"], "strips": [8, 16], "speeds": [100, 1000]}
    of |= {"rows": [128, 1024], "blocks": [2, 4]}
    kept = [stage | {"of": of[stage["over"]]} for stage in plan if stage["over"] in of]
    plan[:] = [stage for stage in kept if stage["stage"] not in ("reduced model", "full model")]


def short(scenes):
    for strips in (8, 16):
        scenes[f"scale-strips-{strips}"]["rounds"] = 5
    for count, speeds in ((3, 100), (6, 1000)):
        scenes[f"scale-speeds-{speeds}"]["speeds"]["over_f1"]["count"] = count


def test_the_study_runs_over_the_jobs_of_the_workflow(project):
    """On blades and scenes with few elements, rounds, speeds and rows."""
    project.edit("workflow/study/scaling.yaml", tiny)
    project.edit("workflow/scenes/variants.yaml", short)
    project.edit(
        "workflow/blades/variants.yaml",
        lambda blades: blades["reference-coarse"]["mesh"].update(element_size_mm=14),
    )
    project.edit("workflow/designs/scale-128.yaml", lambda design: design.update(samples=2))
    project.edit("workflow/designs/scale-1024.yaml", lambda design: design.update(samples=4))
    project.run("scaling")
    assert (project.folder / "results/scaling/scaling.png").stat().st_size > 10_000
    study = read_json(project.folder / "results/scaling/scaling.json")
    assert len(study) == 7
    for row in study:
        x, y = ([point[of] for point in row["points"]] for of in ("x", "seconds"))
        assert x == sorted(x) and all(0 < seconds < 60 for seconds in y)
        assert all(50 < point["peak_MB"] < 2000 for point in row["points"])
    project.edit("workflow/scenes/variants.yaml", lambda scenes: scenes.pop("scale-blocks"))
    assert "cannot be planned" in project.run("results/scaling/plan-3.json", expect=1)
