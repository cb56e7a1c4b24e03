"""Logging of all scripts: output goes to the rule's log, errors for users also to the terminal."""

import os
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from geometry.errors import MeshWarning, UserError


@contextmanager
def stage(snakemake: Any) -> Iterator[None]:
    """Redirect stdout and stderr, also of compiled code, to the log.

    Errors for users are also written to the terminal, as their message with the YAML file that it
    is about; all others have their traceback in the log.
    """
    outside = os.dup(2)
    log = os.open(str(snakemake.log[0]), os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(log, 1)
    os.dup2(log, 2)
    _repeat_warnings(outside, snakemake)
    try:
        yield
    except Exception as error:
        line = _line(snakemake, error)
        os.write(outside, f"{line}\n".encode())
        if not isinstance(error, UserError):
            raise
        raise SystemExit(line) from None  # Python writes it to the log
    finally:
        sys.stdout.flush()


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
