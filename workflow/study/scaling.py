"""Growth of cost: CPU time and memory of jobs of the workflow over the quantities that set it."""

import re
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from subprocess import run
from typing import Any

import numpy as np
import yaml
from matplotlib.figure import Figure

from geometry.project import UserError
from workflow import markdown
from workflow.figures import lines
from workflow.usage import read_usage

LAST = 3  # points of a fit: growth in the end, not at the start
LEAST_MB = 20.0  # least growth of memory distinct from the load of the libraries
HEAD = ("stage", "over", "from", "to", "CPU (s)", "exponent", "peak memory (MB)", "exponent")
RUN = "one run"  # panel with several numbers, each over its least value
PANELS = {  # with their x labels
    "up to the reduced model": "nodes",
    RUN: "over the least value",
    "many": "speeds, rows, blocks",
}
AXES = {"seconds": "CPU time (s)", "peak_MB": "peak memory (MB)"}

type Row = dict[str, Any]  # plain values, of a JSON file
type Points = Sequence[Mapping[str, float]]  # of a stage, x ascending: x, seconds, peak_MB


def numbers(files: Any) -> list[Row]:
    """Points of each stage of the plan ``files.plan``, and exponents of its time and memory."""
    rows = []
    for stage in yaml.safe_load(Path(files.plan).read_text()):
        logs = [stage["log"].format(name) for name in stage["of"]]
        places = map(_nodes, logs) if stage["over"] == "nodes" else stage.get("x", stage["of"])
        points = [{"x": x} | read_usage(log) for x, log in zip(places, logs, strict=True)]
        rows.append(stage | {"points": points, "exponents": exponents(points)})
    return rows


def _nodes(log: str) -> int:
    """Nodes of a blade's mesh, from the log of its job, beside another of the blade."""
    return int(re.search(r"(\d+) nodes", Path(log).with_name("mesh.log").read_text())[1])


def exponents(points: Points) -> dict[str, float | None]:
    """Exponents of time over the last points, and of memory above that of the first if it grows."""
    least = points[0]["peak_MB"]
    grown = [
        p | {"peak_MB": p["peak_MB"] - least} for p in points if p["peak_MB"] > least + LEAST_MB
    ]
    return {
        "seconds": slope(points, "seconds"),
        "peak_MB": slope(grown, "peak_MB") if len(grown) > 1 else None,
    }


def slope(points: Points, name: str) -> float:
    """Exponent p of y = c x^p, by least squares of the logarithms of the ``LAST`` points."""
    x, y = (np.log([point[key] for point in points[-LAST:]]) for key in ("x", name))
    return float(np.polyfit(x, y, 1)[0])


def plan(files: Any, blocks: int) -> Row:
    """Plan a sweep in as many blocks, as `snakemake -n` does; the log of the job has its cost.

    Raises
    ------
    UserError
        When it cannot be planned.
    """
    asked = ["--config", "scenes=[scale-blocks]", f"blocks={blocks}", "--", "sweeps"]
    if run([sys.executable, "-m", "snakemake", "-n", "--quiet", "all", *asked]).returncode:
        raise UserError(f"a sweep of {blocks} blocks cannot be planned: see the log")
    return {"blocks": blocks}


def table(study: Sequence[Row]) -> str:
    """Markdown: time and memory of each stage at the ends of its range, with their exponents."""
    return markdown.table(HEAD, map(_cells, study))


def _cells(row: Row) -> list[str]:
    (first, *_, last), exponents = row["points"], row["exponents"]
    return [
        row["stage"],
        row["over"],
        f"{first['x']:,}",
        f"{last['x']:,}",
        f"{first['seconds']:.2g} to {markdown.two_digits(last['seconds'])}",
        f"{exponents['seconds']:.2f}",
        f"{first['peak_MB']:.0f} to {last['peak_MB']:.0f}",
        "-" if exponents["peak_MB"] is None else f"{exponents['peak_MB']:.2f}",
    ]


def draw(study: Sequence[Row]) -> Figure:
    """Above CPU time, below peak memory, of each stage over the quantity that sets it."""
    shown = [row for panel in PANELS for row in study if row.get("panel") == panel]
    records = [record for row in shown for record in _records(row)]
    drawn = lines.draw(
        records, "x", ["seconds", "peak_MB"], line="line", panel="panel", labels=AXES, log="xy"
    )
    for axes, label in zip(drawn.axes[len(PANELS) :], PANELS.values(), strict=True):
        axes.set_xlabel(label)
    return drawn


def _records(row: Row) -> list[Row]:
    """Points of a stage; of those of one run, over the least value."""
    is_run = row["panel"] == RUN
    least = row["points"][0]["x"] if is_run else 1
    labels = {"panel": row["panel"], "line": row["over"] if is_run else row["stage"]}
    return [point | labels | {"x": point["x"] / least} for point in row["points"]]
