"""CPU time and peak memory of processes: each is measured when it has ended, whatever else runs."""

import json
import os
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from subprocess import PIPE, STDOUT, run
from typing import Any

from geometry.errors import UserError

MB = 1e6

# A process counts the memory of what started it as its own peak, until it has its program: a small
# starter, for that of tests and studies is large.
SEPARATOR = "\nused: "
STARTER = f"""
import os, subprocess, sys
_, status, usage = os.wait4(subprocess.Popen(sys.argv[1:]).pid, 0)
print({SEPARATOR!r}, usage.ru_utime + usage.ru_stime, " ", usage.ru_maxrss, sep="")
sys.exit(os.waitstatus_to_exitcode(status))
"""


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
    ran = run(
        [sys.executable, "-I", "-S", "-c", STARTER, *command],
        cwd=folder,
        env=os.environ | dict(environment or {}),
        stdout=PIPE,
        stderr=STDOUT,
        text=True,
        check=False,
    )
    if ran.returncode != 0:
        raise StageError(f"{' '.join(command)}: {ran.stdout[-800:]}")
    output, _, used = ran.stdout.rpartition(SEPARATOR)
    seconds, kilobytes = map(float, used.split())
    return output, {"seconds": seconds, "peak_MB": kilobytes * 1024 / MB}
