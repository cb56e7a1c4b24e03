"""What each choice of rods, basis, interface and mesh costs and brings, one at a time."""

from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter

from workflow.figures import style
from workflow.figures.trade import CHOICES, TITLES, load, title

__all__ = ["draw", "load"]

MARKS = {
    "amplitude": ("o", style.BLUE),
    "wear": ("s", style.VERMILLION),
    "force": ("^", style.GREEN),
    "history": ("D", style.BLACK),
}
SETTINGS = ("scheme", "mass_scaling_hz", "steps", "rods", "blade", "directions", "basis", "n")
SETTINGS += ("nodes", "mesh_mm")
LOOK = {"linestyle": "none", "markersize": 3.4, "markeredgewidth": 0.7}
SHADE = {"facecolor": "0.9", "linewidth": 0}
DODGE = (-0.21, -0.07, 0.07, 0.21)  # of a line: marks at the same error stay apart
TIME_AT = -1  # line of the column's head
LINE, HEADER = 0.18, 0.95  # in: a choice; all that is no choice
FLOOR = 1e-4

Run = dict[str, Any]
Rows = dict[tuple[str, str], float]


@style.styled
def draw(trade: dict[str, Any]) -> Figure:
    """One panel for each scene, one line for each choice: errors, and time over the default's."""
    scenes = trade["scenes"]
    rows = lines(trade["runs"])
    drawn = style.figure(style.DOUBLE, HEADER + LINE * (len(rows) + len(CHOICES)))
    panels = drawn.subplots(1, len(scenes), sharex=True, sharey=True, squeeze=False)[0]
    for axes, name in zip(panels, scenes, strict=True):
        runs = [run for run in trade["runs"] if run["scene"] == name and run["study"] in CHOICES]
        _panel(axes, runs, rows, scenes[name]["uncertainty"])
        axes.set_title(title(trade, name).replace(", ", "\n"), loc="left")
        axes.set_xlabel("error")
    _name(panels[0], rows)
    handles = panels[0].get_legend_handles_labels()[0]
    drawn.legend(handles=[*handles, *_keys()], loc="outside lower center", ncols=3)
    return drawn


def lines(runs: Sequence[Run]) -> Rows:
    """Height of each choice, (study, label), downwards, a gap between studies."""
    choices = dict.fromkeys((run["study"], run["label"]) for run in runs)
    heights, at = {}, 0.0
    for study in CHOICES:
        for choice in (choice for choice in choices if choice[0] == study):
            heights[choice] = at
            at += 1
        at += 1
    return heights


def default_of(runs: Sequence[Run]) -> Run:
    """The run of ``runs``, one choice changed in each, that changes nothing: the middle of all."""
    usual = {key: Counter(run.get(key) for run in runs).most_common(1)[0][0] for key in SETTINGS}
    return max(runs, key=lambda run: sum(run.get(key) == usual[key] for key in SETTINGS))


def _panel(axes: Axes, runs: Sequence[Run], rows: Rows, uncertainty: dict[str, Any]) -> None:
    default = default_of(runs)
    _time(axes, TIME_AT, "time", fontsize=7)
    for run in runs:
        at = rows[run["study"], run["label"]]
        same = _same(run, default)
        weight = "bold" if same else "normal"
        _time(axes, at, f"{run['cpu_s'][1] / default['cpu_s'][1]:.2f}", fontweight=weight)
        if same:
            axes.axhspan(at - 0.5, at + 0.5, **SHADE, zorder=0)
    for dodge, observable in zip(DODGE, TITLES, strict=True):
        mark, color = MARKS[observable]
        errors = np.array([run["errors"].get(observable) for run in runs], float)
        heights = np.array([rows[run["study"], run["label"]] for run in runs]) + dodge
        known = ~(errors <= (uncertainty.get(observable) or 0))
        look = LOOK | {"color": color, "marker": mark}
        axes.plot(errors[known], heights[known], label=TITLES[observable], **look)
        hidden = np.maximum(errors[~known], FLOOR)
        axes.plot(hidden, heights[~known], label="_not known", markerfacecolor="white", **look)
    axes.set(xscale="log")
    axes.xaxis.set_major_formatter(FuncFormatter(lambda error, _: f"{100 * error:g} %"))
    axes.grid(True, axis="x", color="0.85", linewidth=0.4)
    axes.set_axisbelow(True)
    axes.tick_params(axis="y", length=0)


def _time(axes: Axes, at: float, text: str, **look: Any) -> None:
    """Write in the column right of the axes."""
    place = {"transform": axes.get_yaxis_transform(), "ha": "left", "va": "center"}
    axes.text(1.04, at, text, **{"fontsize": 6.5} | place | look)


def _keys() -> list[Any]:
    """What the legend says beyond the observables."""
    hollow = Line2D([], [], **LOOK, marker="o", color=style.BLUE, markerfacecolor="white")
    hollow.set_label("hollow: not known, below the reference's uncertainty")
    return [hollow, Patch(**SHADE, label="default; time is over its CPU time")]


def _name(axes: Axes, rows: Rows) -> None:
    """Write labels at their lines and the study over them."""
    axes.set_yticks(list(rows.values()), [label for _, label in rows])
    axes.set_ylim(max(rows.values()) + 0.7, -1.5)
    for study in CHOICES:
        heights = [at for (of, _), at in rows.items() if of == study]
        if heights:
            axes.annotate(
                study,
                (0, min(heights) - 1),
                (-4, 0),
                xycoords=axes.get_yaxis_transform(),
                textcoords="offset points",
                **{"ha": "right", "va": "center", "fontweight": "bold", "fontsize": 7.5},
            )


def _same(one: Run, other: Run) -> bool:
    return all(one.get(key) == other.get(key) for key in SETTINGS)
