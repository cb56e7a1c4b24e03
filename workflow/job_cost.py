"""CPU time and memory of a job: written to the end of its log, and read from there.

Snakemake's own benchmark files sample a job twice a second for 15 s, and then every 30 s: of a job
of 40 s they have the first 15.
"""

import os
import re
from pathlib import Path
from resource import RUSAGE_CHILDREN, RUSAGE_SELF, getrusage

STATUS = Path("/proc/self/status")  # of Linux; `VmHWM`: the largest memory of this program, kB
USED = re.compile(r"^used (?P<seconds>[\d.]+) s of CPU, (?P<peak_MB>\d+) MB at most$", re.MULTILINE)


def usage() -> str:
    """The line of a log: CPU time and peak memory of this process and those that it waited for.

    The time is from its first import on. Until it has its program, a process that is started
    counts the memory of its parent.
    """
    peak = re.search(r"VmHWM:\s+(\d+)", STATUS.read_text() if STATUS.is_file() else "")
    kB = int(peak[1]) if peak else getrusage(RUSAGE_SELF).ru_maxrss
    peak_MB = max(kB, getrusage(RUSAGE_CHILDREN).ru_maxrss) * 1024 / 1e6
    return f"used {sum(os.times()[:4]):.2f} s of CPU, {peak_MB:.0f} MB at most"


def read_usage(log: str | Path) -> dict[str, float]:
    """CPU time (``seconds``) and peak memory (``peak_MB``) of the last job that wrote the log.

    Empty where there is no log yet, or one of an older version or of a job that has failed.
    """
    uses = [*USED.finditer(Path(log).read_text())] if Path(log).is_file() else []
    return {name: float(value) for use in uses[-1:] for name, value in use.groupdict().items()}


def cpu_seconds(log: str | Path, otherwise: float = 0.0) -> float:
    """CPU time of the last job that wrote the log, s; ``otherwise`` where the log has none."""
    return read_usage(log).get("seconds", otherwise)
