"""Pictures of the study of accuracy and time: errors over CPU time, changes by single choices."""

from collections.abc import Sequence
from itertools import product
from math import inf, isnan, nan
from typing import Any

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from workflow.experiment.row import ExperimentRow
from workflow.figures import cells, lines, style
from workflow.markdown import two_digits
from workflow.study.levels import (
    JUDGED,
    OTHER_SCHEME,
    SCENES,
    front,
    group_rows,
    levels,
    uncertainty,
)
from workflow.study.trade_table import COUNTED, scheme_of, with_ratios

LABELS = {
    "cpu_s": "CPU time of a run (s)",
    "worst": "largest error (%): amplitude, wear, force, history",
    "amplitude": "error of amplitude\n" + r"$\|Y\|$ (%)",
    "wear": "error of\nwear map (%)",
    "force": "error of\npeak force (%)",
    "history": "error of first\nfive revolutions (%)",
    "piecewise-exact": "piecewise-exact, by step",
    "central": "central differences, by step",
    "mass-scaled": "central differences, mass-scaled, by step",
}
# Format and colour of the schemes, by name
LOOKS = ("s--", style.VERMILLION), ("^:", style.GREEN), ("o-", style.BLUE)
MODELS = "PXdph*<>8Hv^1234"  # markers of the models on a front
RINGS = "osD"  # of the levels, around the marker of a model
FAINT = {"color": "0.78", "linewidth": 0.4, "marker": ".", "markersize": 2.5, "zorder": 1.8}
STAIR = {"color": "0.55", "linewidth": 2, "zorder": 1.9, "where": "post"}
MODEL = {"color": style.BLUE, "markersize": 4.5, "zorder": 3, "linestyle": "none"}
RING = MODEL | {"color": style.BLACK, "markersize": 9, "markerfacecolor": "none"}
BELOW = 0.35  # lower end of an axis over the smallest uncertainty
UNKNOWN = 0.01  # %, lower end of an axis without an uncertainty
FLOOR = "lower end"  # row of the uncertainties
COLUMNS = {
    "amplitude": "ampli-\ntude",
    "Omega_c": r"$\Omega_c$",
    "wear": "wear\nmap",
    "lobes": "lobes",
    "force": "peak\nforce",
    "history": "first\nrevolutions",
    "time": "time\nsaved",
}
SHOWN = 0.1, 100  # % at the ends of the colours; white below
MINUS = "\N{MINUS SIGN}"
FEWEST = 0.05  # %; changes below this are written as 0
SAID = "change (%; of lobes: their number); CPU time saved (%)"


@style.styled
def settings(study: Sequence[ExperimentRow]) -> Figure:
    """Error of each setting over CPU time, their Pareto front, and the three levels.

    ``study``: rows of the experiment. A panel for each scene; the error is the largest of four
    observables.
    """
    drawn, each_level = style.panels(len(SCENES), style.DOUBLE, 6.6), [*levels(study)]
    unsure = with_floor(uncertainty(study))
    tried = shown(group_rows(study, "front"), unsure)
    best = shown(pd.concat(front(study, name) for name in SCENES), unsure)
    marks = dict(zip(sorted({*best["model"]}), MODELS, strict=False))
    for axes, name in zip(drawn.axes, SCENES, strict=True):
        for _, same in tried[tried["scene"] == name].groupby(["model", "rods"]):
            axes.plot(same["cpu_s"], same["worst"], label="same model and rods, by step", **FAINT)
        stair = best[best["scene"] == name].sort_values("cpu_s")
        axes.step(stair["cpu_s"], stair["worst"], label="Pareto front of error and time", **STAIR)
        for model, runs in stair.groupby("model"):
            axes.plot(runs["cpu_s"], runs["worst"], marker=marks[model], label=model, **MODEL)
        for ring, level in zip(RINGS, each_level, strict=True):
            chosen = shown(level["of"][level["of"]["scene"] == name], unsure)
            label = f"{level['level']}: paper in {float(f'{level["paper_min"]:.2g}'):g} CPU min"
            axes.plot(chosen["cpu_s"], chosen["worst"], marker=ring, label=label, **RING)
        axes.set(xscale="log", yscale="log", xlabel=LABELS["cpu_s"], ylabel=LABELS["worst"])
        axes.set_title(title(study, name), loc="right")
        axes.label_outer()
    _shade(drawn, unsure, ["worst"])
    style.legend(drawn, "lower center", ncols=3)
    return drawn


def steps(study: Sequence[ExperimentRow]) -> Figure:
    """Error of each observable, one to a row, over CPU time by scheme and step.

    ``study``: rows of the experiment. A column for each scene; all on one reduced model.
    """
    tried = group_rows(study, "scheme")
    other = tried[tried["row"] == OTHER_SCHEME].set_index("scene")[JUDGED].reindex(SCENES)
    unsure = with_floor(other)
    records = shown(tried, unsure)
    records["panel"] = [title(study, name) for name in records["scene"]]
    drawn = lines.draw(
        records,
        "cpu_s",
        JUDGED,
        line="scheme",
        panel="panel",
        labels=LABELS,
        log="xy",
        looks=LOOKS,
    )
    _shade(drawn, unsure, JUDGED)
    return drawn


def title(study: Sequence[ExperimentRow], name: str) -> str:
    """Scene and its speed."""
    settings = next(row["settings"] for row in study if row["scene"] == name)
    return f"{name}, $\\Omega/f_1(0)$ = {settings['speeds']['over_f1'][0]:g}"


def with_floor(unsure: pd.DataFrame) -> pd.DataFrame:
    """Uncertainties of the reference, %, by scene and observable; nan where not known.

    The last row has the lower ends of axes that show the least of them.
    """
    percent = 100 * unsure.replace([0, inf], nan)
    percent.loc[FLOOR] = (BELOW * percent.min()).fillna(UNKNOWN)
    return percent


def shown(runs: pd.DataFrame, unsure: pd.DataFrame) -> pd.DataFrame:
    """Runs by scene, scheme and step, with their model and rods, and their errors in %.

    Errors are drawn at the lower end of their axis at least; those not known are nan.
    """
    floor, names = unsure.loc[FLOOR], runs["names"].str
    errors = (100 * runs[floor.index].replace(inf, nan)).clip(lower=floor, axis="columns")
    described = runs.assign(
        **errors,
        scheme=runs["settings"].map(scheme_of),
        steps=runs["numbers"].str["steps"],
        model=names[0],
        rods=names[-1],
    )
    return described.sort_values(["scene", "scheme", "steps"])


def _shade(drawn: Figure, unsure: pd.DataFrame, errors: Sequence[str]) -> None:
    """Shade errors below the uncertainty of the reference; panels of ``errors``, then of scenes."""
    for axes, (error, name) in zip(drawn.axes, product(errors, SCENES), strict=True):
        floor, top = unsure.at[FLOOR, error], unsure.at[name, error]
        axes.axhspan(floor, top, color="0.85", linewidth=0, zorder=0)
        axes.set_ylim(bottom=floor)
        axes.grid(True, color="0.9", linewidth=0.4)
        axes.set_axisbelow(True)
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.yaxis.set_major_formatter("{x:g}")
    drawn.suptitle("shaded: below the uncertainty of the reference", fontsize=7)


def changes(study: Sequence[ExperimentRow], groups: Sequence[str] = ("feature",)) -> Figure:
    """One matrix for each scene: rows of the ``groups`` down, observables and time saved across."""
    changed = with_ratios(study, *groups)
    saved, named = 100 * (1 - changed["time_ratio"]), changed["row"].str.replace(": ", " → ")
    changed = changed.assign(time=saved, row=named)
    columns = changed[[*COLUMNS]].dropna(axis=1, how="all")
    records = [
        {"scene": row["scene"], "row": row["row"], "of": key} | _cell(key, row[key])
        for row in changed.to_dict("records")
        for key in columns
    ]
    return cells.draw(
        records,
        "of",
        "row",
        "change",
        text="text",
        panel="scene",
        labels=COLUMNS | {"change": SAID},
        limits=SHOWN,
        log=True,
    )


def _cell(key: str, value: float) -> dict[str, Any]:
    """A change, coloured by its size in %; number of lobes and time saved are written alone."""
    if isnan(value):
        return {"change": nan, "text": ""}
    if key in (COUNTED, "time"):
        return {"change": nan, "text": f"{value:.0f}".replace("-", MINUS)}
    size = 100 * abs(value)
    return {"change": size, "text": two_digits(size) if size >= FEWEST else "0"}
