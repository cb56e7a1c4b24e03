"""What every script shares: its output goes to the rule's log, errors and warnings outside too."""

import os
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from geometry.errors import MeshWarning


@contextmanager
def stage(snakemake: Any) -> Iterator[None]:
    """Send both streams, also of compiled code, to the log; repeat what users must see outside."""
    outside = os.dup(2)
    log = os.open(str(snakemake.log[0]), os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(log, 1)
    os.dup2(log, 2)
    _repeat_warnings(outside, snakemake.rule)
    try:
        yield
    except Exception as error:
        os.write(outside, f"{snakemake.rule}: {error}\n".encode())
        raise
    finally:
        sys.stdout.flush()


def _repeat_warnings(outside: int, rule: str) -> None:
    """Write a ``MeshWarning`` outside too: nobody reads the log of a job that succeeds."""
    log = warnings.showwarning

    def show(message: Warning | str, category: type[Warning], *where: Any) -> None:
        log(message, category, *where)
        if issubclass(category, MeshWarning):
            os.write(outside, f"{rule}: {message}\n".encode())

    warnings.showwarning = show
