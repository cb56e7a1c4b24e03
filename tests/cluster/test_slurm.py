"""The chain through SLURM by its profile alone; cluster.py brings SLURM up and takes it down."""

import os
import re
import subprocess
import sys
import time
from pathlib import Path

import pytest
from projects import Project, make_project
from test_kills import require_same_models, require_same_sweep

BLADE = "results/paper"
SWEEP = f"{BLADE}/paper-e1/sweep.nc"
BLOCKS = 4  # as two, the local ones, they check the same speeds
DEADLINE_S = 480.0
POLLED = ("--slurm-init-seconds-before-status-checks", "1")  # its jobs are short


def start(project: Project, slurm, log: Path) -> subprocess.Popen:
    """Snakemake with the profile, as a user of a cluster starts it."""
    command = ["-m", "snakemake", "--workflow-profile", "profiles/slurm", *POLLED, "--", SWEEP]
    with log.open("wb") as file:
        return subprocess.Popen(
            [sys.executable, *command],
            cwd=project.folder,
            env=project.environment | slurm.environment,
            stdout=file,
            stderr=file,
        )


def cancel_a_block_at_work(slurm, begun: Path, snakemake: subprocess.Popen) -> str:
    """Cancel the last task of the array once its script runs; return its number in SLURM."""
    until = time.monotonic() + DEADLINE_S
    while time.monotonic() < until and snakemake.poll() is None:
        tasks = re.findall(r"^(\d+_\d+) R$", slurm.ask("squeue", "-h", "-o", "%i %t"), re.M)
        if begun.exists() and tasks:
            slurm.ask("scancel", tasks[-1])
            return tasks[-1]
        time.sleep(0.1)
    raise AssertionError("no block was seen at work")


@pytest.mark.nightly
def test_a_sweep_through_slurm_survives_a_killed_job_and_has_the_bits_of_a_local_one(
    slurm, tmp_path, record_property
):
    for name in ("cluster", "local"):
        (tmp_path / name).mkdir()
    there, here = make_project(tmp_path / "cluster"), make_project(tmp_path / "local")
    there.edit("workflow/config.yaml", lambda config: config.update(blocks=BLOCKS))

    log, begun = tmp_path / "log", time.monotonic()
    snakemake = start(there, slurm, log)
    try:
        last = there.folder / BLADE / f"paper-e1/logs/block-{BLOCKS - 1}.log"
        task = cancel_a_block_at_work(slurm, last, snakemake)
        snakemake.wait(timeout=DEADLINE_S)
    finally:
        snakemake.kill()
        snakemake.wait()
    text = log.read_text()
    record_property("s through SLURM", round(time.monotonic() - begun))
    assert snakemake.returncode == 0, text[-6000:]

    assert text.count("Submitted array job") == 1
    assert f"The individual task IDs are 1-{BLOCKS}." in text
    assert f"SLURM-job '{task}' failed, SLURM status is: 'CANCELLED'" in text
    assert text.count("Trying to restart job") == 1
    assert not re.search(r"Job \d+ has been submitted.*rule_check_scene", text)  # those are local
    again = re.search(r"with SLURM jobid (\d+) \(log: \S+/rule_sweep_block/", text)[1]
    memory = dict(map(str.split, slurm.ask("squeue", "-aht", "all", "-o", "%i %m").splitlines()))
    assert memory[again] == "4000M" and memory[task] == "2001M"  # 1 MB for the array's commands

    here.run("--cores", str(os.cpu_count()), SWEEP)
    require_same_sweep(there.folder / SWEEP, here.folder / SWEEP)
    require_same_models(there.folder / BLADE, here.folder / BLADE)
