"""CPU time and peak memory of processes: each is measured when it has ended, whatever else runs."""

import json
import os
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from subprocess import PIPE, STDOUT, Popen
from typing import Any

from geometry.errors import UserError

MB = 1e6


class StageError(UserError):
    """A measured process failed; the message has the end of its output."""


def run_stage(name: str, **values: Any) -> dict[str, Any]:
    """What a stage of ``scaling_stages`` told, with the peak memory of its process, MB.

    Raises
    ------
    StageError
        When it fails.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "values.json")
        path.write_text(json.dumps(values))
        command = [sys.executable, "-m", "workflow.study.scaling_stages", name, str(path)]
        output, of_process = measured(command)
    return of_process | json.loads(output.splitlines()[-1])


def measured(
    command: Sequence[str], folder: str | None = None, environment: Mapping[str, str] | None = None
) -> tuple[str, dict[str, float]]:
    """Output of a process, and its CPU time, s, and peak memory, MB, with those of its children.

    Raises
    ------
    StageError
        When it fails.
    """
    process = Popen(
        command,
        cwd=folder,
        env=os.environ | dict(environment or {}),
        stdout=PIPE,
        stderr=STDOUT,
        text=True,
    )
    with process.stdout:
        output = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise StageError(f"{' '.join(command)}: {output[-800:]}")
    return output, {
        "seconds": usage.ru_utime + usage.ru_stime,
        "peak_MB": usage.ru_maxrss * 1024 / MB,
    }
