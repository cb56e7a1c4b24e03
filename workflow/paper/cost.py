"""Cost of the targets, from the benchmark files of their jobs, and CPU time from their logs."""

import csv
from collections.abc import Iterable, Mapping
from pathlib import Path

from workflow.markdown import table
from workflow.usage import cpu_seconds

HEAD = ["target", "jobs measured", "from first start to last end (s)", "CPU (s)", "longest job (s)"]


def cost(targets: Mapping[str, Iterable[str | Path]]) -> str:
    """Markdown table with a line for each target, from the benchmark files in its folders.

    The CPU time is that of their logs, where they have it: of a longer job a benchmark file has the
    first 15 s. If a target was made without interruption, first start to last end is its wall time.
    """
    return table(HEAD, [[target, *_sums(folders)] for target, folders in targets.items()]) + "\n"


def _sums(folders: Iterable[str | Path]) -> list[str]:
    """Number of the jobs of these folders, their wall and CPU time, and that of the longest."""
    jobs = [_job(file) for folder in folders for file in Path(folder).glob("benchmarks/*.tsv")]
    if not jobs:
        return ["not run", "", "", ""]
    starts, ends, cpu = zip(*jobs, strict=True)
    longest = max(end - start for start, end, _ in jobs)
    wall = max(ends) - min(starts)
    return [str(len(jobs)), f"{wall:.0f}", f"{sum(cpu):.0f}", f"{longest:.0f}"]


def _job(file: Path) -> tuple[float, float, float]:
    """Start and end of a job, s, and its CPU time, s."""
    with file.open(newline="") as text:
        row = next(csv.DictReader(text, delimiter="\t"))
    end = file.stat().st_mtime  # written when the job has ended
    log = file.parents[1] / "logs" / f"{file.stem}.log"
    sampled = float(row["cpu_time"].replace("-", "") or 0)
    return end - float(row["s"]), end, cpu_seconds(log, sampled)
