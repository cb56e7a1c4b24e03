"""What the targets cost, from the benchmark files of their jobs."""

import csv
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

HEAD = ["target", "jobs", "seconds of all jobs", "CPU seconds", "longest job (s)"]


def cost(targets: Mapping[str, Iterable[str | Path]]) -> str:
    """Markdown table: a line for each target with the benchmark files of its jobs."""
    lines = [HEAD, ["---"] * len(HEAD)]
    for target, files in targets.items():
        jobs = [_job(file) for file in files]
        if not jobs:
            lines.append([target, "not run", "", "", ""])
            continue
        seconds, cpu = (sum(column) for column in zip(*jobs, strict=True))
        longest = max(job[0] for job in jobs)
        lines.append([target, str(len(jobs)), f"{seconds:.0f}", f"{cpu:.0f}", f"{longest:.0f}"])
    return "".join(_line(cells) for cells in lines)


def _job(file: str | Path) -> tuple[float, float]:
    """Wall and CPU time of a job, s; a job too short to be measured has none."""
    with open(file, newline="") as text:
        row = next(csv.DictReader(text, delimiter="\t"))
    return float(row["s"]), float(row["cpu_time"] or 0)


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |\n"
