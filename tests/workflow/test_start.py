"""Ctrl-C: a run ends in one line that says how it goes on."""

import logging
import os
import signal
import subprocess
import sys
from time import sleep

import pytest

from geometry.base import command
from workflow import start
from workflow.targets.messages import Stop


def interrupt(*_, **__):
    raise KeyboardInterrupt


def test_before_there_are_jobs(monkeypatch, capsys):
    monkeypatch.setattr(start.runpy, "run_module", interrupt)
    with pytest.raises(SystemExit) as ended:
        start.main()
    assert (ended.value.code, capsys.readouterr().err) == (130, f"{start.STOPPED}\n")


def test_of_another_command(capsys):
    assert command(interrupt)() == 130
    assert capsys.readouterr().err == "interrupted; the same command begins again\n"


@pytest.mark.parametrize("of_run", [True, False])
def test_with_jobs_that_are_ended_where_ctrl_c_did_not_reach_them(monkeypatch, of_run):
    said, ended = [], []
    monkeypatch.setattr(os, "getpgrp", lambda: os.getpid() + (not of_run))
    monkeypatch.setattr(os, "killpg", lambda *given: ended.append(given))
    monkeypatch.setattr(signal, "signal", lambda *_: None)
    stop = Stop()
    for words in ("Job 3", "Terminating processes on user request, this ...", "Error in rule a"):
        record = logging.LogRecord("snakemake", logging.INFO, "", 0, words, (), None)
        if stop(record):
            said.append(record.getMessage())
    assert said == ["Job 3", start.STOPPED] and len(ended) == of_run


@pytest.mark.slow
def test_a_run_ends_in_one_line_and_its_jobs_with_it(project):
    """The group is that of Snakemake, as of ./run."""
    wanted = ["-F", "--cores", "1", "results/paper/paper-e1/sweep.nc"]
    with subprocess.Popen(
        [sys.executable, "-m", "workflow.start", *wanted],
        cwd=project.folder,
        env=project.environment,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        for line in process.stderr:
            if "Mesh of blade" in line:
                break
        sleep(2.0)
        process.send_signal(signal.SIGINT)
        left = process.stderr.read()  # until the jobs have ended, too
    assert process.returncode == 1
    assert left.splitlines()[-1] == start.STOPPED
    assert "Traceback" not in left and "Error" not in left
