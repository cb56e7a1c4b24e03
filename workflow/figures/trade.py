"""Which settings pay: worst error against CPU time of every run, their front, the three levels."""

from collections.abc import Sequence
from typing import Any

import matplotlib.patheffects as effects
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from geometry.files import read_json
from workflow.figures import style

TITLES = {
    "amplitude": r"amplitude $\|Y\|$",
    "wear": "wear map",
    "force": "peak force",
    "history": "first five rounds",
}  # of the observables that a run is judged by
SCHEMES = {
    ("piecewise-exact", False): ("o-", style.BLUE, "piecewise-exact, by step"),
    ("central-difference", False): ("s--", style.VERMILLION, "central differences, by step"),
    ("central-difference", True): ("^:", style.GREEN, "the same, mass-scaled, by step"),
}
CHOICES = ("rods", "modes", "interface", "mesh")  # studied one at a time
MODELS = "PXdph*<>8Hov^s"  # marks of the models on a front
OVERALL = "finest"  # errors of a run that are against the scene's reference
FAINT = {"color": "0.78", "linewidth": 0.4, "marker": ".", "markersize": 2.5, "zorder": 1.8}
LEVEL = {"marker": "o", "linestyle": "none", "markersize": 7, "markerfacecolor": "none"}
TIME = "CPU time of a run (s): median, least to most"
HALO = [effects.withStroke(linewidth=2, foreground="white")]
BELOW = 0.35  # of the smallest band: lower end of an axis
ROOM = 0.03  # of an axis
UNKNOWN = 1e-4  # lower end of an axis without a band


def load(files: Any) -> tuple[dict[str, Any]]:
    """Read the study, ``files.trade``."""
    return (read_json(files.trade),)


@style.styled
def draw(trade: dict[str, Any]) -> Figure:
    """One panel for each scene: largest error of the four observables over CPU time."""
    drawn = style.figure(style.DOUBLE, 6.6)
    columns = 2 if len(trade["scenes"]) > 1 else 1
    rows = -(-len(trade["scenes"]) // columns)
    grid = drawn.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for axes in grid.flat[len(trade["scenes"]) :]:
        axes.remove()
    floor = lowest([worst(scene["uncertainty"]) for scene in trade["scenes"].values()])
    for axes, name, letter in zip(grid.flat, trade["scenes"], "abcdefgh", strict=False):
        _panel(axes, trade, name, floor)
        axes.set_title(title(trade, name), loc="right")
        style.panel_letter(axes, letter)
    for axes in grid[:, 0]:
        axes.set_ylabel("largest error: amplitude, wear, force, history")
    for axes in grid[-1]:
        axes.set_xlabel(TIME)
    grid[0, 0].set_ylim(bottom=floor)
    make_room(grid[0, 0])
    legend(drawn, 3)
    return drawn


def title(trade: dict[str, Any], name: str) -> str:
    """Scene and its speed."""
    return f"{name}, $\\Omega/f_1(0)$ = {trade['scenes'][name]['speed_over_f1']:g}"


def worst(errors: dict[str, float | None]) -> float | None:
    """Largest of the four errors; None where one was not measured."""
    four = [errors.get(observable) for observable in TITLES]
    return None if None in four else max(four)


def uncertainty(scene: dict[str, Any], run: dict[str, Any]) -> dict[str, float | None]:
    """What is not known of a run's errors: of one choice alone, what another scheme changes."""
    return scene["uncertainty"] if run.get("against") == OVERALL else scene["another_scheme"]


def lowest(bands: Sequence[float | None]) -> float:
    """Lower end of an axis that shows the top of every band."""
    return BELOW * min((band for band in bands if band), default=UNKNOWN / BELOW)


def make_room(axes: Axes) -> None:
    """Leave room at the left for the name of the cheapest level, at its left."""
    left, right = axes.get_xlim()
    axes.set_xlim(left / (right / left) ** ROOM, right)


def band(axes: Axes, height: float | None, floor: float) -> None:
    """Shade the errors that are not known; scales of both axes."""
    axes.set(xscale="log", yscale="log")
    if height:
        label = "not known: below the reference's uncertainty"
        axes.axhspan(floor, height, color="0.85", linewidth=0, zorder=0, label=label)
    axes.grid(True, color="0.9", linewidth=0.4)
    axes.set_axisbelow(True)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda seconds, _: f"{seconds:g}"))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda error, _: f"{100 * error:g} %"))


def schemes(
    axes: Axes, runs: list[dict[str, Any]], errors: list[float | None], floor: float
) -> None:
    """Join the runs of each scheme in order of step; whiskers from least to most CPU time."""
    study = [(run, e) for run, e in zip(runs, errors, strict=True) if run["study"] == "scheme"]
    labelled = set()
    for kind in dict.fromkeys((run["scheme"], run["mass_scaling_hz"]) for run, _ in study):
        same = [pair for pair in study if (pair[0]["scheme"], pair[0]["mass_scaling_hz"]) == kind]
        same.sort(key=lambda pair: pair[0]["steps"])
        line, color, label = SCHEMES[kind[0], kind[1] is not None]
        marks(
            axes,
            *zip(*same, strict=True),
            floor,
            fmt=line,
            color=color,
            label="_again" if label in labelled else label,
            markerfacecolor="white" if kind[1] else color,
        )
        labelled.add(label)


def marks(
    axes: Axes,
    runs: Sequence[dict[str, Any]],
    errors: Sequence[float | None],
    floor: float,
    **look: Any,
) -> None:
    """Mark runs at their median CPU time; errors below ``floor`` on it, whiskers of CPU time."""
    seconds = np.reshape([run["cpu_s"] for run in runs], (-1, 3))
    spread = np.abs(seconds[:, [0, 2]] - seconds[:, [1]]).T
    heights = [np.nan if error is None else max(error, floor) for error in errors]
    axes.errorbar(seconds[:, 1], heights, xerr=spread, elinewidth=0.5, **look)


def _panel(axes: Axes, trade: dict[str, Any], name: str, floor: float) -> None:
    band(axes, worst(trade["scenes"][name]["uncertainty"]), floor)
    runs = [run for run in trade["runs"] if run["scene"] == name and run["study"] == "front"]
    _combinations(axes, runs, floor)
    _front(axes, trade, name, floor)
    _levels(axes, [level for level in trade["levels"] if name in level["cpu_s"]], name, floor)


def _combinations(axes: Axes, runs: list[dict[str, Any]], floor: float) -> None:
    """Join runs of one model and number of rods in order of step, faintly."""
    label = "same model and rods, by step"
    for kind in dict.fromkeys((model_text(run), run["rods"]) for run in runs):
        same = [run for run in runs if (model_text(run), run["rods"]) == kind]
        same.sort(key=lambda run: run["steps"])
        heights = [np.nan if e is None else max(e, floor) for e in _worst_of(same)]
        axes.plot([run["cpu_s"][1] for run in same], heights, label=label, **FAINT)
        label = "_again"


def _front(axes: Axes, trade: dict[str, Any], name: str, floor: float) -> None:
    """Stair through the runs of the front, marked by model."""
    front = [trade["runs"][i] for i in trade["front"].get(name, [])]
    axes.step(
        [run["cpu_s"][1] for run in front],
        [max(error or 0, floor) for error in _worst_of(front)],
        where="post",
        color="0.55",
        linewidth=2,
        zorder=1.9,
        label="front: no run cheaper and better",
    )
    named = {i: model_text(trade["runs"][i]) for of in trade["front"].values() for i in of}
    for mark, model in zip(MODELS, sorted(set(named.values())), strict=False):
        these = [run for run in front if model_text(run) == model]
        if these:
            look = {"color": style.BLUE, "markersize": 4.5, "linestyle": "none", "label": model}
            marks(axes, these, _worst_of(these), floor, fmt=mark, zorder=3, **look)


def model_text(run: dict[str, Any]) -> str:
    """Patches of a reduced model, and the strips it is marched on."""
    return f"{run['patches']} patches, {run['strips']} strips"


def legend(drawn: Figure, columns: int) -> None:
    """Below the figure, what any of its panels shows, once."""
    found: dict[str, Any] = {}
    for axes in drawn.axes:
        found |= dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    drawn.legend(found.values(), found.keys(), loc="outside lower center", ncols=columns)


def _worst_of(runs: list[dict[str, Any]]) -> list[float | None]:
    return [worst(run["errors"]) for run in runs]


def level_text(level: dict[str, Any]) -> str:
    """What a level costs where the paper's results are wanted."""
    minutes = float(f"{level['paper_min']:.2g}")
    return f"{level['level']}: paper in {minutes:g} CPU min"


def _levels(axes: Axes, levels: list[dict[str, Any]], name: str, floor: float) -> None:
    """Ring each level; at the foot of the axes its name, in one line those of one time."""
    named: dict[float, list[str]] = {}
    for level in levels:
        at = level["cpu_s"][name], max(worst(level["errors"].get(name, {})) or 0, floor)
        axes.plot(*at, color=style.BLACK, zorder=4, label=level_text(level), **LEVEL)
        axes.vlines(at[0], floor, at[1], color="0.3", linewidth=0.6, linestyle=":", zorder=1.95)
        named.setdefault(at[0], []).append(level["level"])
    for seconds, names in named.items():
        text = axes.annotate(
            ", ".join(names), (seconds, floor), (-1, 3), textcoords="offset points", zorder=1.95
        )
        text.set(ha="right", va="bottom", fontweight="bold", fontsize=7.5, path_effects=HALO)
        text.set_rotation(90)
