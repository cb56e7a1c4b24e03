"""How cost grows: exponents of time and memory, where each way of running many ends, the figure."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from geometry.project import read_json
from workflow import markdown
from workflow.figures import style
from workflow.study.scaling_budget import breaks, large_mesh, million, on_gpu

LAST = 3  # points of a fit: growth in the end, not at the start
LEAST_MB = 20.0  # growth of memory that is told from what loading the libraries takes
UNITS = {"mesh": "nodes", "patches": "patches", "speeds": "speeds"}
UNITS |= {"strips": "strips", "rods": "rods per round", "rounds": "rounds"}
UNITS |= {"rows": "rows", "jobs": "sweep blocks"}
MEANINGS = {
    "mesh": "mesh",
    "assemble": "matrices at four speeds",
    "reduce": "reduced model",
    "full_model": "full model at three speeds",
    "strips": "one run",
    "rods": "one run",
    "rounds": "one run, with its history",
    "merge": "merge of a sweep",
    "design": "a block of a design, beside its runs",
    "tables": "tables of a design",
    "plan": "plan of the workflow",
}
PANELS = (  # title, x label, axes of the study
    ("up to the reduced model", "nodes", ("mesh",)),
    ("one run", "over the least value", ("march",)),
    ("many", "speeds, rows, blocks", ("speeds", "rows", "jobs")),
)
WIDTH = 130  # of a line of a page
LINES = ("o-", "s-", "^-", "D-", "v--", "<--")

type Points = Sequence[Mapping[str, Any]]  # of a stage, x ascending


def numbers(files: Any) -> dict[str, Any]:
    """All points, exponents over the last points of each stage, and the plans made from them."""
    points = {Path(path).stem: read_json(path) for path in files.axes}
    exponents = {
        axis: {stage: _exponents(of) for stage, of in stages.items()}
        for axis, stages in points.items()
    }
    return {
        "points": points,
        "exponents": exponents,
        "large_mesh": large_mesh(points, exponents),
        "breaks": breaks(points),
        "million": million(points),
        "gpu": on_gpu(points),
    }


def _exponents(points: Points) -> dict[str, float | None]:
    """Exponents of time, and of memory above that of the first point if it grows."""
    last, least = points[-LAST:], points[0]["peak_MB"] + LEAST_MB
    grown = [p for p in points[1:] if p["peak_MB"] > least][-LAST:]
    x, above = [p["x"] for p in grown], [p["peak_MB"] - points[0]["peak_MB"] for p in grown]
    return {
        "seconds": slope([p["x"] for p in last], [p["seconds"] for p in last]),
        "peak_MB": slope(x, above) if len(grown) > 1 else None,
    }


def slope(x: Sequence[float], y: Sequence[float]) -> float:
    """Exponent p of y = c x^p by least squares of the logarithms."""
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def table(study: Mapping[str, Any]) -> str:
    """Markdown: time and memory of each stage at the ends of its range, with their exponents."""
    head = ["stage", "over", "from", "to", "CPU (s)", "exponent", "peak memory (MB)", "exponent"]
    rows = [
        _row(axis, stage, of, study["exponents"][axis][stage])
        for axis, stages in study["points"].items()
        for stage, of in stages.items()
    ]
    return markdown.table(head, rows)


def _row(
    axis: str,
    stage: str,
    points: Sequence[Mapping[str, Any]],
    exponents: Mapping[str, float | None],
) -> list[str]:
    first, last = points[0], points[-1]
    return [
        MEANINGS[stage],
        UNITS.get(stage) or UNITS[axis],
        f"{first['x']:,}",
        f"{last['x']:,}",
        f"{first['seconds']:.2g} to {_number(last['seconds'])}",
        f"{exponents['seconds']:.2f}",
        f"{first['peak_MB']:.0f} to {last['peak_MB']:.0f}",
        "-" if exponents["peak_MB"] is None else f"{exponents['peak_MB']:.2f}",
    ]


def _number(value: float) -> str:
    """Three digits at most, without an exponent."""
    return f"{float(f'{value:.2g}'):,.15g}"


def plans(study: Mapping[str, Any]) -> str:
    """Markdown: what breaks first, a million runs, ten million on a GPU."""
    plan = study["million"]
    first = _first(study["breaks"], plan, study["large_mesh"])
    said = first, _of_million(plan), _of_gpu(study["gpu"])
    return "\n\n".join(fill(paragraph, WIDTH) for paragraph in said)


def _first(
    limits: Mapping[str, float], plan: Mapping[str, float], mesh: Mapping[str, float]
) -> str:
    return (
        f"**What breaks first.** By its exponents, not measured, a mesh of {mesh['nodes']:,} nodes "
        f"takes {mesh['GB']:.0f} GB and {_number(mesh['min'])} min in the full model at three "
        f"speeds; 24 GB end at {_number(mesh['nodes_in_memory'])} nodes. A sweep holds all its "
        "runs when it is merged: "
        f"{limits['run_kB']:.0f} kB a run, so that {_number(limits['speeds_in_2_GB'])} speeds take "
        f"2 GB and {_number(limits['speeds'])} take 24. Snakemake plans {limits['job_ms']:.1f} ms "
        f"and {limits['job_MB']:.2f} MB a block: {_number(limits['jobs_in_a_minute'])} blocks take "
        "a minute before anything starts, each with three files. Runs as a design leave numbers "
        "only, but every block reads and checks all rows of its design: with a million rows "
        f"{_number(plan['one_block_s'])} s and {plan['one_block_GB']:.1f} GB in each block, and "
        f"{plan['one_tables_GB']:.1f} GB in the job that makes the tables."
    )


def _of_million(plan: Mapping[str, float]) -> str:
    walls = ", ".join(
        f"{_number(plan['core_h'] * (1 + plan['beside_share']) / cores)} h on {cores} cores"
        for cores in (16, 128)
    )
    return (
        f"**A million runs** of {plan['run_s'] * 1e3:.0f} ms are {_number(plan['core_h'])} core "
        f"hours: {walls}. As {plan['designs']:.0f} designs of {plan['rows']:,.0f} rows, "
        f"{plan['blocks']:.0f} blocks in all: {plan['block_s'] / 60:.0f} min a block, "
        f"{plan['beside_share']:.1%} of it beside the runs, {plan['block_MB']:.0f} MB a block and "
        f"{plan['tables_MB']:.0f} MB for its tables, {_number(plan['files'])} files, "
        f"{plan['runs_GB']:.2f} GB of runs and {plan['rows_GB']:.1f} GB of rows, "
        f"{_number(plan['plan_s'])} s to plan. As sweeps the same runs would be "
        f"{_number(plan['sweep_GB'])} GB."
    )


def _of_gpu(gpu: Mapping[str, float]) -> str:
    bounds = {
        "a tenth of the peak rate of float64 (34 TFLOP/s)": gpu["rate_s"],
        "the bandwidth, if rods under the tip alone are moved": gpu["bandwidth_s"],
        "the chain of steps of 3 µs, 16 runs on each of 132 processors": gpu["chain_s"],
    }
    said = ", ".join(f"{_number(seconds / 60)} min by {by}" for by, seconds in bounds.items())
    return (
        f"**Ten million on a GPU**, on paper: a step is {gpu['step_flops']:,.0f} operations, a run "
        f"{gpu['run_Gflop']:.2f} GFLOP (a core does {gpu['core_Gflops']:.1f} GFLOP/s). All are "
        f"{_number(gpu['core_h'])} core hours; on one H100 {said}. The longest of these is the "
        "estimate; branches of contact may cost a few times as much. "
        f"The rods of a run take {gpu['rods_MB']:.1f} MB: {_number(gpu['in_memory'])} runs fit."
    )


def load(files: Any) -> tuple[dict[str, Any]]:
    """Read the numbers of the study, ``files.study``."""
    return (read_json(files.study),)


@style.styled
def draw(study: dict[str, Any]) -> Figure:
    """Above CPU time, below peak memory, of each stage over what its cost depends on."""
    drawn, grid = style.subplots(style.DOUBLE, 4.6, 2, len(PANELS), sharex="col", sharey="row")
    for column, (title, label, axes) in zip(grid.T, PANELS, strict=True):
        stages = [
            (UNITS[stage] if axis == "march" else MEANINGS[stage], of)
            for axis in axes
            for stage, of in study["points"][axis].items()
        ]
        for (name, of), line in zip(stages, LINES, strict=False):
            x = np.array([point["x"] for point in of])
            x = x / x[0] if axes == ("march",) else x
            _lines(column, x, of, line, name)
        column[0].set_title(title)
        column[1].set_xlabel(label)
        column[1].legend(loc="upper center", bbox_to_anchor=(0.5, -0.3))
    grid[0, 0].set_ylabel("CPU time (s)")
    grid[1, 0].set_ylabel("peak memory (MB)")
    return drawn


def _lines(column: Sequence[Axes], x: Any, points: Points, line: str, name: str) -> None:
    for axes, number in zip(column, ("seconds", "peak_MB"), strict=True):
        axes.plot(x, [point[number] for point in points], line, label=name)
        axes.set(xscale="log", yscale="log")
        for of in (axes.xaxis, axes.yaxis):
            of.set_minor_formatter(NullFormatter())
