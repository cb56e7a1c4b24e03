"""What the terminal shows of a run: refusals as sentences, and its last words."""

import os
import re
import signal
import sys
from collections.abc import Collection, Iterator
from logging import LogRecord
from typing import Any

from geometry.base import WARNING
from workflow.many.table import last_words as words_of_table
from workflow.start import STOPPED
from workflow.summary import last_words
from workflow.targets.project import SUMMARY, Project

REFUSED = r"WorkflowError in file|InputFunctionException[\s\S]*?\n +SettingsError: "
AROUND = r"^[\s\S]*?(WorkflowError.*\n *|SettingsError: )|\nWildcards:[\s\S]*|\n +File \"[\s\S]*"


def without_sources(record: LogRecord) -> bool:
    """Leave the modules that a job imports out of a message: errors then name files of users."""
    if isinstance(files := getattr(record, "input", None), list):
        record.input = [file for file in files if not file.endswith(".py")]
    return True


def without_traceback(record: LogRecord) -> bool:
    """Of what is refused of files or requests of users, leave the sentences alone."""
    if re.match(REFUSED, text := str(record.msg)):
        record.msg = re.sub(AROUND, "", text)
    return True


class Stop:
    """Of a run that is stopped: one line, and its jobs end at once, for files are made whole."""

    stopped = False

    def __call__(self, record: LogRecord) -> bool:
        """Whether to show a message: none after the line."""
        if self.stopped:
            return False
        if str(record.msg).startswith("Terminating processes on user request"):
            record.msg, self.stopped = STOPPED, True
            if os.getpgrp() == os.getpid():  # as of ./run; else Ctrl-C has ended the jobs, too
                signal.signal(signal.SIGUSR2, signal.SIG_IGN)
                os.killpg(0, signal.SIGUSR2)  # MPI and PETSc handle SIGUSR1 and SIGTERM
        return True


def in_one_line(message: Warning | str, *_: Any, shown: bool, **__: Any) -> None:
    """Show a warning as a line, in place of ``warnings.showwarning``.

    Not ``shown`` by a job's own run of Snakemake: the first run has told it.
    """
    if shown:
        print(f"{WARNING}{message}", file=sys.stderr)


def closing_words(project: Project, made: Collection[str]) -> Iterator[str]:
    """Of tables of designs and experiments, and the summary, as far as they were ``made``."""
    for name, scene in project.designs.items():
        kinds, folder = ("design", "sensitivity", "distribution"), f"results/{scene.blade}/{name}"
        drawn = [f"results/figures/{kind}-{name}.png" for kind in kinds]
        files = [f"{folder}/design.csv", f"{folder}/quantiles.csv", *drawn]
        if found := [file for file in files if file in made]:
            yield f"Design of scene {name}: {', '.join(found)}; {words_of_table(files[0])}."
    for path in sorted(made):
        if re.fullmatch(r"results/experiments/[^/]+/table\.csv", path):
            yield f"Experiment: {path}; {words_of_table(path)}."
    if SUMMARY in made:
        yield last_words("results")
