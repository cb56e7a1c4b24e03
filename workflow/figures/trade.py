"""Error against CPU time of runs with different settings: Pareto front and the three levels."""

from collections.abc import Callable, Iterator, Sequence
from math import inf, nan
from typing import Any

import matplotlib.patheffects as effects
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter
from numpy.typing import ArrayLike, NDArray

from workflow.figures import style
from workflow.study.levels import SCENES, front, levels, of_group, uncertainty, worst

TITLES = {
    "amplitude": r"amplitude $\|Y\|$",
    "wear": "wear map",
    "force": "peak force",
    "history": "first five rounds",
}  # of the observables whose errors are compared
MODELS = "PXdph*<>8Hov^s"  # markers of the models on a front
FAINT = {"color": "0.78", "linewidth": 0.4, "marker": ".", "markersize": 2.5, "zorder": 1.8}
LEVEL = {"marker": "o", "linestyle": "none", "markersize": 7, "markerfacecolor": "none"}
TIME = "CPU time of a run (s)"
HALO = [effects.withStroke(linewidth=2, foreground="white")]
NAME = {
    "ha": "right",
    "va": "bottom",
    "rotation": 90,
    "fontweight": "bold",
    "fontsize": 7.5,
    "path_effects": HALO,
    "zorder": 1.95,
}
BELOW = 0.35  # lower end of an axis over the smallest uncertainty
ROOM = 0.03  # of an axis, free at its left
UNKNOWN = 1e-4  # lower end of an axis without an uncertainty

Run = dict[str, Any]


@style.styled
def draw(study: Sequence[Run]) -> Figure:
    """One panel for each scene: largest error of the four observables over CPU time.

    ``study``: rows of the experiment.
    """
    drawn, of_levels = style.panels(len(SCENES), style.DOUBLE, 6.6), levels(study)
    floor = lowest([worst(uncertainty(study, name)) for name in SCENES])
    for axes, name in zip(drawn.axes, SCENES, strict=True):
        _panel(axes, study, name, floor)
        _levels(axes, [of for of in of_levels if name in of["of"]], name, floor)
        axes.set_title(title(study, name), loc="right")
        axes.set(xlabel=TIME, ylabel="largest error: amplitude, wear, force, history")
        axes.label_outer()
    first = drawn.axes[0]
    left, right = first.get_xlim()  # room for the name of the cheapest level, at its left
    first.set(xlim=(left / (right / left) ** ROOM, right), ylim=(floor, None))
    style.legend(drawn, "lower center", ncols=3)
    return drawn


def title(study: Sequence[Run], name: str) -> str:
    """Scene and its speed."""
    settings = next(row["settings"] for row in study if row["scene"] == name)
    return f"{name}, $\\Omega/f_1(0)$ = {settings['speeds']['over_f1'][0]:g}"


def lowest(bands: Sequence[float | None]) -> float:
    """Lower end of an axis that shows the top of every band."""
    return BELOW * min((band for band in bands if band and band < inf), default=UNKNOWN / BELOW)


def band(axes: Axes, top: float | None, floor: float) -> None:
    """Shade errors below the uncertainty ``top``, and set the scales of both axes."""
    axes.set(xscale="log", yscale="log")
    if top and top < inf:
        label = "below the uncertainty of the reference"
        axes.axhspan(floor, top, color="0.85", linewidth=0, zorder=0, label=label)
    axes.grid(True, color="0.9", linewidth=0.4)
    axes.set_axisbelow(True)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda seconds, _: f"{seconds:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda error, _: f"{100 * error:g} %"))


def heights(errors: ArrayLike, floor: float) -> NDArray[np.float64]:
    """Heights at which errors are drawn: ``floor`` at least; nan, not drawn, for unknown errors."""
    known = np.array(errors, float)  # None becomes nan
    return np.where(known < inf, np.maximum(known, floor), nan)


def by_step(runs: Sequence[Run], kind: Callable[[Run], Any]) -> Iterator[list[Run]]:
    """Runs of each kind, by steps per round."""
    for name in dict.fromkeys(map(kind, runs)):
        same = [run for run in runs if kind(run) == name]
        yield sorted(same, key=lambda run: run["numbers"]["steps"])


def _panel(axes: Axes, study: Sequence[Run], name: str, floor: float) -> None:
    band(axes, worst(uncertainty(study, name)), floor)
    runs = [run for run in of_group(study, "front") if run["scene"] == name]
    for same in by_step(runs, lambda run: (run["names"][0], run["names"][2])):
        axes.plot(*_at(same, floor), label="same model and rods, by step", **FAINT)
    _front(axes, study, name, floor)


def _at(runs: Sequence[Run], floor: float) -> tuple[list[float], list[float]]:
    """CPU times and largest errors."""
    return [run["cpu_s"] for run in runs], heights([worst(run["errors"]) for run in runs], floor)


def _front(axes: Axes, study: Sequence[Run], name: str, floor: float) -> None:
    """Stepped line through the runs of the Pareto front, with a marker for each model."""
    best = front(study, name)
    look = {"label": "Pareto front of error and CPU time", "color": "0.55", "linewidth": 2}
    axes.step(*_at(best, floor), where="post", zorder=1.9, **look)
    named = {run["names"][0] for scene in SCENES for run in front(study, scene)}
    for mark, model in zip(MODELS, sorted(named), strict=False):
        look = {"color": style.BLUE, "markersize": 4.5, "linestyle": "none", "label": model}
        these = [run for run in best if run["names"][0] == model]
        axes.plot(*_at(these, floor), marker=mark, zorder=3, **look)


def _levels(axes: Axes, found: Sequence[Run], name: str, floor: float) -> None:
    """Ring each level; write its name at the foot of the axes, levels of equal time in one line."""
    named: dict[float, list[str]] = {}
    for level in found:
        run = level["of"][name]
        at = run["cpu_s"], heights(worst(run["errors"]), floor)
        minutes = float(f"{level['paper_min']:.2g}")
        label = f"{level['level']}: paper in {minutes:g} CPU min"
        axes.plot(*at, color=style.BLACK, zorder=4, label=label, **LEVEL)
        axes.vlines(at[0], floor, at[1], color="0.3", linewidth=0.6, linestyle=":", zorder=1.95)
        named.setdefault(at[0], []).append(level["level"])
    for seconds, names in named.items():
        text = ", ".join(names)
        axes.annotate(text, (seconds, floor), (-1, 3), textcoords="offset points", **NAME)
