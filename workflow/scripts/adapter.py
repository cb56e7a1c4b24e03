"""What every script shares: its output goes to the rule's log, its user errors are one line."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def stage(snakemake: Any) -> Iterator[None]:
    """Send both streams, also of compiled code, to the log; repeat an error's message outside."""
    outside = os.dup(2)
    log = os.open(str(snakemake.log[0]), os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(log, 1)
    os.dup2(log, 2)
    try:
        yield
    except Exception as error:
        os.write(outside, f"{snakemake.rule}: {error}\n".encode())
        raise
    finally:
        sys.stdout.flush()
