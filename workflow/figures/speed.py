"""Work and precision: error of what users read against the CPU time of a run."""

import json
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from workflow.figures import style
from workflow.study.speed import OBSERVABLES

TITLES = {"default": "scenes' model", "paper": "paper's basis"}
LINES = {
    ("piecewise-exact", False): ("o-", style.BLUE, "piecewise-exact"),
    ("central-difference", False): ("s--", style.VERMILLION, "central differences"),
    ("central-difference", True): (
        "^:",
        style.GREEN,
        "central differences, mass-scaled above 25 kHz",
    ),
}


def load(files: Any) -> tuple[dict[str, Any]]:
    """Read the study, ``files.study``."""
    return (json.loads(Path(files.study).read_text()),)


@style.styled
def draw(study: dict[str, Any]) -> Figure:
    """One column for each scene, one row for each observable; the model of the scenes."""
    scenes = study["default"]
    drawn = style.figure(style.DOUBLE, 5.2)
    grid = drawn.subplots(len(OBSERVABLES), len(scenes), sharex=True, sharey="row", squeeze=False)
    for row, observable in zip(grid, OBSERVABLES, strict=True):
        for axes, (name, scene) in zip(row, scenes.items(), strict=True):
            _panel(axes, scene, observable)
            if observable == OBSERVABLES[0]:
                axes.set_title(f"{name}, $\\Omega/f_1(0)$ = {scene['speed_over_f1']:g}")
            if observable == OBSERVABLES[-1]:
                axes.set_xlabel("CPU time of 20 rounds, ms")
        row[0].set_ylabel(f"error of {observable}")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside lower center", ncols=2)
    return drawn


def _panel(axes: Axes, scene: dict[str, Any], observable: str) -> None:
    for (scheme, scaled), (line, color, label) in LINES.items():
        runs = [
            run
            for run in scene["runs"]
            if run["scheme"] == scheme and (run["mass_scaling_hz"] is not None) == scaled
        ]
        runs.sort(key=lambda run: run["cpu_s"])
        axes.plot(
            [1e3 * run["cpu_s"] for run in runs],
            [run["error"][observable] for run in runs],
            line,
            color=color,
            label=label,
            markerfacecolor="white" if scaled else color,
        )
    spread = scene["spread"][observable]
    label = "below: unknown, two references differ by this"
    axes.axhspan(0, spread, color=style.GREY, alpha=0.3, linewidth=0, label=label)
    axes.axhline(0.01, color="black", linewidth=0.6)
    axes.set(xscale="log", yscale="log")
    axes.yaxis.set_major_formatter(FuncFormatter(lambda error, _: f"{100 * error:g} %"))
