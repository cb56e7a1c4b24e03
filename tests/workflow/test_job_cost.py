"""What a job used: CPU time and memory of its process, and the last line of its log."""

import subprocess
import sys
import time

from projects import ROOT

from workflow import job_cost

PROGRAM = """
import subprocess, sys, time
until = time.process_time() + 0.5  # a slow import
while time.process_time() < until: pass
from workflow.job_cost import usage
time.sleep(1)
b = b"x" * 300_000_000
if "child" in sys.argv: subprocess.run([sys.executable, *sys.argv[2:]])
print(usage())
"""
CHILD = "b = b'x' * 500_000_000"


def used_by(log, *arguments):
    """What the program used, started by a process of 600 MB, and the time that passed."""
    ballast, begun = b"x" * 600_000_000, time.perf_counter()
    with log.open("w") as file:
        command = [sys.executable, "-c", PROGRAM, *arguments]
        subprocess.run(command, cwd=ROOT, stdout=file, check=True)
    assert len(ballast) == 600_000_000
    return job_cost.read_usage(log), time.perf_counter() - begun


def test_the_cpu_time_and_peak_memory_of_a_process_are_its_own(tmp_path):
    """Imports cost time, a sleep none; 300 MB are touched; the parent's 600 do not count."""
    used, passed = used_by(tmp_path / "log")
    assert 0.5 <= used["seconds"] <= passed - 1
    assert 300 < used["peak_MB"] < 450


def test_processes_that_a_job_has_waited_for_count(tmp_path):
    """One of 500 MB."""
    used, _ = used_by(tmp_path / "log", "child", "-c", CHILD)
    assert 500 < used["peak_MB"] < 650


def test_a_log_is_of_its_last_job_and_one_of_an_older_version_has_nothing(tmp_path):
    log = tmp_path / "mesh.log"
    lines = [f"used {seconds} s of CPU, 215 MB at most\n" for seconds in (1.25, 2.5)]
    log.write_text("words\n".join(lines))
    assert job_cost.read_usage(log) == {"seconds": 2.5, "peak_MB": 215}
    log.write_text("words of the job\n")
    assert job_cost.read_usage(log) == {}
    assert job_cost.read_usage(tmp_path / "none.log") == {}
