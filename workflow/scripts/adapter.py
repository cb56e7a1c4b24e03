"""What every script shares: its output goes to the rule's log, errors and warnings outside too."""

import os
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from geometry.errors import MeshWarning, UserError


@contextmanager
def stage(snakemake: Any) -> Iterator[None]:
    """Send both streams, also of compiled code, to the log; repeat what users must see outside.

    Errors that tell the user what to do come as that sentence, with the YAML file it is about; all
    others keep their traceback in the log.
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
    """The message with its rule and the YAML of the blade or scene, where it has not named it."""
    scene = snakemake.wildcards.get("scene")
    about = snakemake.params.get("blade") or (f"workflow/scenes/{scene}.yaml" if scene else "")
    named = not about or str(message).startswith(about)
    return f"{snakemake.rule}: {message}" if named else f"{snakemake.rule}: {about}: {message}"


def _repeat_warnings(outside: int, snakemake: Any) -> None:
    """Write a ``MeshWarning`` outside too: nobody reads the log of a job that succeeds."""
    log = warnings.showwarning

    def show(message: Warning | str, category: type[Warning], *where: Any) -> None:
        log(message, category, *where)
        if issubclass(category, MeshWarning):
            os.write(outside, f"{_line(snakemake, message)}\n".encode())

    warnings.showwarning = show
