"""Logging of all scripts: output goes to the rule's log, errors for users also to the terminal.

Where the terminal is one, it also shows how far the work is.
"""

import os
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic
from typing import Any

from geometry.errors import MeshWarning, UserError
from geometry.progress import WARNING

PAUSE = 5.0  # s, least time between two lines of progress on the terminal


class Teller:
    """Writes lines to the log; on a terminal some of them there, too, with the job's name.

    There a line is left out that comes sooner than ``PAUSE`` after the last; warnings are always
    written, also where it is no terminal.
    """

    def __init__(self, outside: int, name: str) -> None:
        self.outside, self.name = outside, name
        self.shows, self.last = os.isatty(outside), -PAUSE

    def __call__(self, line: str) -> None:
        """Tell how far the work is."""
        print(line, flush=True)
        due = self.shows and monotonic() - self.last >= PAUSE
        if due or line.startswith(WARNING):
            self.last = monotonic()
            os.write(self.outside, f"{self.name}: {line}\n".encode())

    def now(self, line: str) -> None:
        """Tell what is known once: on a terminal always."""
        self.last = -PAUSE
        self(line)
        self.last = -PAUSE


@contextmanager
def stage(snakemake: Any) -> Iterator[Teller]:
    """Redirect stdout and stderr, also of compiled code, to the log; gives what tells of the work.

    Errors for users are also written to the terminal, as their message with the YAML file that it
    is about; all others have their traceback in the log.
    """
    outside = os.dup(2)
    log = os.open(str(snakemake.log[0]), os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(log, 1)
    os.dup2(log, 2)
    _repeat_warnings(outside, snakemake)
    try:
        yield Teller(outside, name_of(snakemake))
    except Exception as error:
        line = _line(snakemake, error)
        os.write(outside, f"{line}\n".encode())
        if not isinstance(error, UserError):
            raise
        raise SystemExit(line) from None  # Python writes it to the log
    finally:
        sys.stdout.flush()


def name_of(snakemake: Any) -> str:
    """The job: its rule, and the scene or blade, block or row that it is about."""
    about = [str(value) for value in dict(snakemake.wildcards.items()).values()]
    return " ".join([snakemake.rule, *about[-2:]])


def _line(snakemake: Any, message: object) -> str:
    """The message with its rule, and the YAML file of blade or scene unless it names the file."""
    scene = snakemake.wildcards.get("scene")
    about = snakemake.params.get("blade") or (f"workflow/scenes/{scene}.yaml" if scene else "")
    named = not about or str(message).startswith(about)
    return f"{snakemake.rule}: {message}" if named else f"{snakemake.rule}: {about}: {message}"


def _repeat_warnings(outside: int, snakemake: Any) -> None:
    """Write a ``MeshWarning`` also to the terminal: logs of jobs that succeed are hardly read."""
    log = warnings.showwarning

    def show(message: Warning | str, category: type[Warning], *where: Any) -> None:
        log(message, category, *where)
        if issubclass(category, MeshWarning):
            os.write(outside, f"{_line(snakemake, message)}\n".encode())

    warnings.showwarning = show
