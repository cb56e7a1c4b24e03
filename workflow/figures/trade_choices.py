"""Errors and CPU time of rods, modes, interface and mesh, each varied alone."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, LogLocator

from workflow.figures import style
from workflow.figures.trade import TITLES, Run, title, uncertainty
from workflow.study.trade_levels import cost

CHOICES = ("rods", "modes", "interface", "mesh")  # varied one at a time
MARKS = {  # marker, colour and offset from the line, so that markers of equal error do not overlap
    "amplitude": ("o", style.BLUE, -0.21),
    "wear": ("s", style.VERMILLION, -0.07),
    "force": ("^", style.GREEN, 0.07),
    "history": ("D", style.BLACK, 0.21),
}
SETTINGS = ("rods", "blade", "directions", "modes", "n", "patches", "strips", "mesh_mm")
LOOK = {"linestyle": "none", "markersize": 3.4, "markeredgewidth": 0.7}
SHADE = {"facecolor": "0.9", "linewidth": 0}
TIME_AT = -1  # line of the column's heading
LINE, HEADER = 0.18, 0.95  # in: height of a choice, and of all the rest
FLOOR = 1e-4

Rows = dict[tuple[str, str], float]


@style.styled
def draw(trade: dict[str, Any]) -> Figure:
    """One panel for each scene, one line for each choice: errors, and CPU time over the default."""
    scenes = trade["scenes"]
    rows = lines(trade["runs"])
    height = HEADER + LINE * (len(rows) + len(CHOICES))
    drawn, (panels,) = style.subplots(
        style.DOUBLE, height, 1, len(scenes), sharex=True, sharey=True, squeeze=False
    )
    for axes, name in zip(panels, scenes, strict=True):
        runs = [run for run in trade["runs"] if run["scene"] == name]
        _panel(axes, runs, rows, scenes[name])
        axes.set_title(title(trade, name).replace(", ", "\n"), loc="left")
        axes.set_xlabel("error (%)")
    _name(panels[0], rows)
    handles = panels[0].get_legend_handles_labels()[0]
    drawn.legend(handles=[*handles, *_keys()], loc="outside lower center", ncols=3)
    return drawn


def lines(runs: Sequence[Run]) -> Rows:
    """Line number of each choice, (study, label), with a gap between studies."""
    choices = dict.fromkeys((run["study"], run["label"]) for run in runs)
    of_study = {study: [choice for choice in choices if choice[0] == study] for study in CHOICES}
    places = (place for study in CHOICES for place in (*of_study[study], None))
    return {choice: at for at, choice in enumerate(places) if choice}


def defaults(runs: Sequence[Run], study: str) -> list[Run]:
    """Runs of a study that share most settings with the runs of the study of schemes."""
    usual = next(run for run in runs if run["study"] == "scheme")
    of_study = [run for run in runs if run["study"] == study]
    alike = [sum(run[key] == usual[key] for key in SETTINGS) for run in of_study]
    return [run for run, n in zip(of_study, alike, strict=True) if n == max(alike)]


def _panel(axes: Axes, all_runs: Sequence[Run], rows: Rows, scene: dict[str, Any]) -> None:
    runs = [run for run in all_runs if run["study"] in CHOICES]
    _time(axes, TIME_AT, "time", fontsize=7)
    for run in runs:
        _time_of(axes, run, defaults(all_runs, run["study"]), rows)
    for observable, (mark, color, dodge) in MARKS.items():
        errors = np.array([run["errors"][observable] for run in runs], float)
        heights = np.array([rows[run["study"], run["label"]] for run in runs]) + dodge
        known = ~(errors <= [uncertainty(scene, run)[observable] or 0 for run in runs])
        look = LOOK | {"color": color, "marker": mark}
        axes.plot(errors[known], heights[known], label=TITLES[observable], **look)
        hidden = np.maximum(errors[~known], FLOOR)
        axes.plot(hidden, heights[~known], label="_not known", markerfacecolor="white", **look)
    axes.set(xscale="log")
    axes.xaxis.set_major_locator(LogLocator(numticks=12))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda error, _: f"{100 * error:g}"))
    axes.grid(True, axis="x", color="0.85", linewidth=0.4)
    axes.set_axisbelow(True)
    axes.tick_params(axis="y", length=0)


def _time_of(axes: Axes, run: Run, default: Sequence[Run], rows: Rows) -> None:
    """Write a run's CPU time over that of its study's default; shade the line of the default."""
    at, same = rows[run["study"], run["label"]], run in default
    text = f"{cost(run) / cost(default[0]):.2f}"
    _time(axes, at, text, fontweight="bold" if same else "normal")
    if same:
        axes.axhspan(at - 0.5, at + 0.5, **SHADE, zorder=0)


def _time(axes: Axes, at: float, text: str, **look: Any) -> None:
    """Write in the column to the right of the axes."""
    place = {"transform": axes.get_yaxis_transform(), "ha": "left", "va": "center"}
    axes.text(1.04, at, text, **{"fontsize": 6.5} | place | look)


def _keys() -> list[Any]:
    """Entries of the legend besides the observables."""
    hollow = {"marker": "o", "color": style.BLUE, "markerfacecolor": "white"}
    below = "hollow: below the uncertainty of the reference"
    return [
        Line2D([], [], label=below, **LOOK, **hollow),
        Patch(**SHADE, label="default; time: CPU time over that of the default"),
    ]


def _name(axes: Axes, rows: Rows) -> None:
    """Label the lines with their choices, and groups of lines with their study."""
    axes.set_yticks(list(rows.values()), [label for _, label in rows])
    axes.set_ylim(max(rows.values()) + 0.7, -1.5)
    for study in CHOICES:
        heights = [at for (of, _), at in rows.items() if of == study]
        if heights:
            look = {"ha": "right", "va": "center", "fontweight": "bold", "fontsize": 7.5}
            at = (0, min(heights) - 1)
            style.note(axes, at, study, (-4, 0), xycoords=axes.get_yaxis_transform(), **look)
