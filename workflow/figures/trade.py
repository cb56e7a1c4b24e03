"""Error against CPU time of runs with different settings: Pareto front and the three levels."""

from collections.abc import Callable, Iterator, Sequence
from math import inf, nan
from typing import Any

import matplotlib.patheffects as effects
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter
from numpy.typing import ArrayLike, NDArray

from workflow.figures import style
from workflow.study.trade_levels import cost
from workflow.study.trade_plan import OVERALL
from workflow.study.trade_runs import Errors, worst

TITLES = {
    "amplitude": r"amplitude $\|Y\|$",
    "wear": "wear map",
    "force": "peak force",
    "history": "first five rounds",
}  # of the observables whose errors are compared
MODELS = "PXdph*<>8Hov^s"  # markers of the models on a front
FAINT = {"color": "0.78", "linewidth": 0.4, "marker": ".", "markersize": 2.5, "zorder": 1.8}
LEVEL = {"marker": "o", "linestyle": "none", "markersize": 7, "markerfacecolor": "none"}
TIME = "CPU time of a run (s): median, least to most"
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
def draw(study: dict[str, Any]) -> Figure:
    """One panel for each scene: largest error of the four observables over CPU time."""
    drawn = style.panels(len(study["scenes"]), style.DOUBLE, 6.6)
    floor = lowest([worst(scene["uncertainty"]) for scene in study["scenes"].values()])
    for axes, name in zip(drawn.axes, study["scenes"], strict=True):
        _panel(axes, study, name, floor)
        axes.set_title(title(study, name), loc="right")
        axes.set(xlabel=TIME, ylabel="largest error: amplitude, wear, force, history")
        axes.label_outer()
    first = drawn.axes[0]
    left, right = first.get_xlim()  # room for the name of the cheapest level, at its left
    first.set(xlim=(left / (right / left) ** ROOM, right), ylim=(floor, None))
    style.legend(drawn, "lower center", ncols=3)
    return drawn


def title(trade: dict[str, Any], name: str) -> str:
    """Scene and its speed."""
    return f"{name}, $\\Omega/f_1(0)$ = {trade['scenes'][name]['speed_over_f1']:g}"


def uncertainty(scene: dict[str, Any], run: Run) -> Errors:
    """Uncertainty of a run's errors by observable.

    Of a run compared with the overall reference, the uncertainty of that; of a run that differs
    from its reference in one choice alone, the difference made by the other scheme.
    """
    return scene["uncertainty"] if run["against"] == OVERALL else scene["another_scheme"]


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
    axes.yaxis.set_major_formatter(FuncFormatter(lambda error, _: f"{100 * error:g} %"))


def marks(
    axes: Axes,
    runs: Sequence[Run],
    errors: Sequence[float | None],
    floor: float,
    **look: Any,
) -> None:
    """Mark runs at their median CPU time, with its range; errors below ``floor`` drawn there."""
    seconds = np.reshape([run["cpu_s"] for run in runs], (-1, 3))
    spread = np.abs(seconds[:, [0, 2]] - seconds[:, [1]]).T
    axes.errorbar(seconds[:, 1], heights(errors, floor), xerr=spread, elinewidth=0.5, **look)


def heights(errors: ArrayLike, floor: float) -> NDArray[np.float64]:
    """Heights at which errors are drawn: ``floor`` at least; nan, not drawn, for unknown errors."""
    known = np.array(errors, float)  # None becomes nan
    return np.where(known < inf, np.maximum(known, floor), nan)


def by_step(runs: Sequence[Run], kind: Callable[[Run], Any]) -> Iterator[list[Run]]:
    """Runs of each kind, by steps per round."""
    for name in dict.fromkeys(map(kind, runs)):
        yield sorted((run for run in runs if kind(run) == name), key=lambda run: run["steps"])


def _panel(axes: Axes, trade: dict[str, Any], name: str, floor: float) -> None:
    band(axes, worst(trade["scenes"][name]["uncertainty"]), floor)
    runs = [run for run in trade["runs"] if run["scene"] == name and run["study"] == "front"]
    for same in by_step(runs, lambda run: (model_text(run), run["rods"])):
        axes.plot(*_at(same, floor), label="same model and rods, by step", **FAINT)
    _front(axes, trade, name, floor)
    _levels(axes, [level for level in trade["levels"] if name in level["cpu_s"]], name, floor)


def _at(runs: Sequence[Run], floor: float) -> tuple[list[float], list[float]]:
    """CPU times and largest errors."""
    return [cost(run) for run in runs], heights([worst(run["errors"]) for run in runs], floor)


def _front(axes: Axes, trade: dict[str, Any], name: str, floor: float) -> None:
    """Stepped line through the runs of the Pareto front, with a marker for each model."""
    front = [trade["runs"][i] for i in trade["front"][name]]
    look = {"label": "Pareto front of error and CPU time", "color": "0.55", "linewidth": 2}
    axes.step(*_at(front, floor), where="post", zorder=1.9, **look)
    named = {model_text(trade["runs"][i]) for of in trade["front"].values() for i in of}
    for mark, model in zip(MODELS, sorted(named), strict=False):
        look = {"color": style.BLUE, "markersize": 4.5, "linestyle": "none", "label": model}
        these = [run for run in front if model_text(run) == model]
        errors = [worst(run["errors"]) for run in these]
        marks(axes, these, errors, floor, fmt=mark, zorder=3, **look)


def model_text(run: Run) -> str:
    """Patches of a reduced model, and the strips it is marched on."""
    return f"{run['patches']} patches, {run['strips']} strips"


def _levels(axes: Axes, levels: list[dict[str, Any]], name: str, floor: float) -> None:
    """Ring each level; write its name at the foot of the axes, levels of equal time in one line."""
    named: dict[float, list[str]] = {}
    for level in levels:
        at = level["cpu_s"][name], heights(worst(level["errors"][name]), floor)
        minutes = float(f"{level['paper_min']:.2g}")
        label = f"{level['level']}: paper in {minutes:g} CPU min"
        axes.plot(*at, color=style.BLACK, zorder=4, label=label, **LEVEL)
        axes.vlines(at[0], floor, at[1], color="0.3", linewidth=0.6, linestyle=":", zorder=1.95)
        named.setdefault(at[0], []).append(level["level"])
    for seconds, names in named.items():
        text = ", ".join(names)
        axes.annotate(text, (seconds, floor), (-1, 3), textcoords="offset points", **NAME)
