"""Cost of the targets, from the benchmark files of their jobs, and CPU time from their logs."""

from collections.abc import Iterable, Mapping
from pathlib import Path

import pandas as pd

from workflow.job_cost import cpu_seconds
from workflow.markdown import table


def cost(targets: Mapping[str, Iterable[str | Path]]) -> str:
    """Markdown table with a line for each target, from the benchmark files in its folders.

    The CPU time is that of their logs, where they have it: of a longer job a benchmark file has the
    first 15 s. Times do not depend on when the jobs ran, at once or with pauses between them.
    """
    head = ["target", "jobs measured", "one after another (s)", "CPU (s)", "longest job (s)"]
    return table(head, ([target, *_sums(folders)] for target, folders in targets.items())) + "\n"


def _sums(folders: Iterable[str | Path]) -> list[str]:
    """Number of the jobs of these folders, their wall and CPU time, and that of the longest."""
    jobs = [_job(file) for folder in folders for file in Path(folder).glob("benchmarks/*.tsv")]
    if not jobs:
        return ["not run", "", "", ""]
    wall, cpu = zip(*jobs, strict=True)
    return [str(len(jobs)), f"{sum(wall):.0f}", f"{sum(cpu):.0f}", f"{max(wall):.0f}"]


def _job(file: Path) -> tuple[float, float]:
    """Wall and CPU time of a job, s."""
    (row,) = pd.read_csv(file, sep="\t", na_values="-").fillna(0.0).to_dict("records")
    log = file.parents[1] / "logs" / f"{file.stem}.log"
    return float(row["s"]), cpu_seconds(log, float(row["cpu_time"]))
