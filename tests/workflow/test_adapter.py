import os
import subprocess
import sys
from importlib import import_module
from textwrap import indent

import pytest
from projects import ROOT

from geometry.base import UserError, read_json

SCRIPTS = str(ROOT / "workflow/scripts")
SCRIPT = """
import sys, types, warnings
from adapter import stage
from geometry.base import MeshError, MeshWarning

job = types.SimpleNamespace(log=[sys.argv[1]], rule="build_mesh", params={}, wildcards={})
job.input, job.output = ["geometry/mesh.py", "b.step"], []
job.params["blade"] = "workflow/blades/b.yaml"
with stage(job) as tell:
"""


@pytest.fixture
def job(tmp_path):
    """Run the body of a script: exit status, output outside of the log, and the log."""

    def job(body, before="", stderr=subprocess.PIPE):
        script = SCRIPT.replace("with stage", f"{before}with stage") + indent(body, "    ")
        done = subprocess.run(
            [sys.executable, "-c", script, str(tmp_path / "log")],
            env={"PYTHONPATH": f"{ROOT}:{SCRIPTS}"},
            stdout=subprocess.PIPE,
            stderr=stderr,
            text=True,
        )
        assert done.stdout == ""
        return done.returncode, done.stderr, (tmp_path / "log").read_text()

    return job


def test_mesh_warnings_are_shown_and_all_warnings_are_logged(job):
    body = 'warnings.warn("cells were raised", MeshWarning)\n'
    body += 'warnings.warn("of a library")\nprint("words of the job")'
    status, outside, log = job(body)
    assert (status, outside) == (0, "build_mesh: workflow/blades/b.yaml: cells were raised\n")
    logged = ("MeshWarning: cells were raised", "of a library", "words of the job")
    assert all(words in log for words in logged)


@pytest.mark.parametrize("said", ["too coarse", "workflow/blades/b.yaml: mesh: too coarse"])
def test_error_for_users_is_one_line_that_names_the_yaml_once(job, said):
    status, outside, log = job(f'raise MeshError("{said}")')
    line = f"build_mesh: workflow/blades/b.yaml: {said.removeprefix('workflow/blades/b.yaml: ')}\n"
    assert (status, outside, log) == (1, line, line)


def test_bug_keeps_its_traceback_in_the_log(job):
    status, outside, log = job("1 / 0")
    assert (status, outside) == (1, "build_mesh: workflow/blades/b.yaml: division by zero\n")
    assert log.startswith("Traceback") and log.endswith("ZeroDivisionError: division by zero\n")


@pytest.mark.parametrize(
    "module",
    [
        "geometry.base.errors",
        "geometry.base.provenance",
        "fem.prestress",
        "rom.modes",
        "rom.model",
        "simulate.marching.setup",
    ],
)
def test_errors_of_the_packages_are_for_users(module):
    errors = [
        value for name, value in vars(import_module(module)).items() if name.endswith("Error")
    ]
    assert errors and all(issubclass(error, UserError) for error in errors)


@pytest.mark.parametrize(
    ("signal", "words"),
    [
        ("SIGSEGV", "a compiled library crashed on b.step, workflow/blades/b.yaml: check or make"),
        ("SIGKILL", "killed while it read b.step, workflow/blades/b.yaml, perhaps out of memory"),
    ],
)
def test_a_job_that_ends_without_a_word_has_a_sentence(job, tmp_path, signal, words):
    """A library's crash, and the system's killer of processes that take too much memory."""
    status, outside, log = job(f"import os, signal\nos.kill(os.getpid(), signal.{signal})")
    assert status < 0
    (line,) = outside.splitlines()
    assert line.startswith(f"build_mesh: {words}") and line.endswith(f"log: {tmp_path / 'log'}")
    assert ("Fatal Python error: Segmentation fault" in log) == (signal == "SIGSEGV")


def test_a_place_that_cannot_be_written_is_refused_before_the_job_begins(job, tmp_path):
    (tmp_path / "file").write_text("no folder")
    place = f"{tmp_path}/file/out.nc"
    status, outside, log = job("print('begun')", before=f'job.output.append("{place}")\n')
    assert status == 1 and "begun" not in log
    (line,) = outside.splitlines()
    assert f"{place}: cannot be written (File exists)" in line


TELLING = """
from geometry.base import WARNING
tell.report("what was meshed")
tell("compiled")
tell("loaded")
for done in range(3):
    tell(f"speed {done + 1} of 3")
tell(WARNING + "some 9 days")
"""


LINES = ["what was meshed", "compiled", "loaded", "speed 1 of 3", "speed 2 of 3", "speed 3 of 3"]


def test_a_terminal_shows_a_bar_and_other_lines_at_most_every_few_seconds(job):
    """Without a terminal only warnings leave the log."""
    warning = "build_mesh: warning: some 9 days"
    leader, follower = os.openpty()
    status, _, log = job(TELLING, stderr=follower)
    os.close(follower)
    said = os.read(leader, 10_000).decode()
    os.close(leader)
    *lines_of_log, used = log.splitlines()
    assert status == 0 and used.startswith("used 0.")
    assert lines_of_log == [*LINES, "warning: some 9 days"]
    shown = [line.strip("\r\n") for line in said.split("\x1b[2K")]
    lines = ["what was meshed", "compiled"]  # loaded comes too soon
    assert shown[0].splitlines() == [f"build_mesh: {line}" for line in lines]
    full = ("#" * 8 + "." * 16, "#" * 16 + "." * 8, "#" * 24)
    bars = [f"build_mesh [{bar}] speed {i} of 3" for i, bar in enumerate(full, 1)]
    assert shown[1:] == [*bars, warning]
    status, outside, log = job(TELLING)
    assert (status, outside, log.splitlines()[:-1]) == (0, f"{warning}\n", lines_of_log)


def test_the_result_of_a_job_is_written_with_its_texts(tmp_path):
    """As JSON, and what functions of it give, by the name of the output."""
    paths = [tmp_path / name for name in ("a.json", "a.csv", "log")]
    script = """
import sys, types
from adapter import job

def call(of, tell):
    return {"n": of.wildcards["n"] + 1}

snakemake = types.SimpleNamespace(log=[sys.argv[3]], rule="count", params={}, wildcards={"n": 1})
snakemake.input, snakemake.output = {}, {"json": sys.argv[1], "csv": sys.argv[2]}
job(snakemake, call, csv=lambda result: f"n\\n{result['n']}\\n")
"""
    environment = os.environ | {"PYTHONPATH": f"{ROOT}:{SCRIPTS}"}
    subprocess.run([sys.executable, "-c", script, *map(str, paths)], env=environment, check=True)
    assert read_json(paths[0]) == {"n": 2} and paths[1].read_text() == "n\n2\n"
