"""Pictures of the study of accuracy and time: errors over CPU time, changes by single choices."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from math import inf, nan
from typing import Any

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from workflow.figures import cells, lines, style
from workflow.markdown import two_digits
from workflow.study.levels import (
    JUDGED,
    OTHER_SCHEME,
    SCENES,
    Errors,
    front,
    levels,
    of_group,
    uncertainty,
    worst,
)
from workflow.study.trade_table import scheme_of

LABELS = {
    "cpu_s": "CPU time of a run (s)",
    "worst": "largest error (%): amplitude, wear, force, history",
    "amplitude": "error of amplitude\n" + r"$\|Y\|$ (%)",
    "wear": "error of\nwear map (%)",
    "force": "error of\npeak force (%)",
    "history": "error of first\nfive rounds (%)",
    "piecewise-exact": "piecewise-exact, by step",
    "central": "central differences, by step",
    "mass-scaled": "central differences, mass-scaled, by step",
}
SCHEMES = {  # format and colour
    "piecewise-exact": ("o-", style.BLUE),
    "central": ("s--", style.VERMILLION),
    "mass-scaled": ("^:", style.GREEN),
}
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
    "history": "first\nrounds",
    "time": "time\nsaved",
}
SHOWN = 0.1, 100  # % at the ends of the colours; white below
MINUS = "\N{MINUS SIGN}"
FEWEST = 0.05  # %; changes below this are written as 0
SAID = "change (%; of lobes: their number); CPU time saved (%)"

type Run = Mapping[str, Any]


@style.styled
def settings(study: Sequence[Run]) -> Figure:
    """Error of each setting over CPU time, their Pareto front, and the three levels.

    ``study``: rows of the experiment. A panel for each scene; the error is the largest of four
    observables.
    """
    drawn, of_levels = style.panels(len(SCENES), style.DOUBLE, 6.6), levels(study)
    unsure = uncertainties({name: uncertainty(study, name) for name in SCENES})
    floor = unsure.loc[FLOOR]
    tried = errors(of_group(study, "front"), floor)
    best = errors([run for name in SCENES for run in front(study, name)], floor)
    marks = dict(zip(sorted({*best["model"]}), MODELS, strict=False))
    for axes, name in zip(drawn.axes, SCENES, strict=True):
        for _, same in tried[tried["scene"] == name].groupby(["model", "rods"]):
            axes.plot(same["cpu_s"], same["worst"], label="same model and rods, by step", **FAINT)
        stair = best[best["scene"] == name].sort_values("cpu_s")
        axes.step(stair["cpu_s"], stair["worst"], label="Pareto front of error and time", **STAIR)
        for model, of in stair.groupby("model"):
            axes.plot(of["cpu_s"], of["worst"], marker=marks[model], label=model, **MODEL)
        for ring, level in zip(RINGS, of_levels, strict=True):
            at = errors([run for run in level["of"].values() if run["scene"] == name], floor)
            label = f"{level['level']}: paper in {float(f'{level["paper_min"]:.2g}'):g} CPU min"
            axes.plot(at["cpu_s"], at["worst"], marker=ring, label=label, **RING)
        axes.set(xscale="log", yscale="log", xlabel=LABELS["cpu_s"], ylabel=LABELS["worst"])
        axes.set_title(title(study, name), loc="right")
        axes.label_outer()
    _shade(drawn, unsure, ["worst"])
    style.legend(drawn, "lower center", ncols=3)
    return drawn


def steps(study: Sequence[Run]) -> Figure:
    """Error of each observable, one to a row, over CPU time by scheme and step.

    ``study``: rows of the experiment. A column for each scene; all on one reduced model.
    """
    tried = of_group(study, "scheme")
    other = {run["scene"]: run["errors"] for run in tried if run["row"] == OTHER_SCHEME}
    unsure = uncertainties({name: other.get(name, {}) for name in SCENES})
    found = errors(tried, unsure.loc[FLOOR])
    found["panel"] = [title(study, name) for name in found["scene"]]
    drawn = lines.draw(
        found.to_dict("records"),
        *("cpu_s", JUDGED),
        **{"line": "scheme", "panel": "panel", "labels": LABELS, "log": "xy"},
        looks=[*SCHEMES.values()],
    )
    _shade(drawn, unsure, JUDGED)
    return drawn


def title(study: Sequence[Run], name: str) -> str:
    """Scene and its speed."""
    settings = next(row["settings"] for row in study if row["scene"] == name)
    return f"{name}, $\\Omega/f_1(0)$ = {settings['speeds']['over_f1'][0]:g}"


def uncertainties(known: Mapping[str, Errors]) -> pd.DataFrame:
    """Uncertainties of the reference, %, by scene and observable; nan where not known.

    The last row has the lower ends of axes that show the least of them.
    """
    found = pd.DataFrame({name: _percent(of) for name, of in known.items()}).T
    found = found.mask(found == 0)
    found.loc[FLOOR] = (BELOW * found.min()).fillna(UNKNOWN)
    return found


def errors(runs: Sequence[Run], floor: pd.Series) -> pd.DataFrame:
    """Scene, scheme, model, rods, CPU time (s) and errors (%) of runs, by step.

    Errors are drawn at ``floor``, by observable, at least; those not known are nan.
    """
    order = [*SCHEMES]
    runs = sorted(runs, key=lambda run: (order.index(scheme_of(run)), run["numbers"]["steps"]))
    runs.sort(key=lambda run: SCENES.index(run["scene"]))
    about = [
        {"scene": run["scene"], "scheme": scheme_of(run), "cpu_s": run["cpu_s"]}
        | {"model": run["names"][0], "rods": run["names"][-1]}
        for run in runs
    ]
    found = pd.DataFrame([_percent(run["errors"]) for run in runs], columns=floor.index)
    return pd.DataFrame(about).join(found.clip(lower=floor, axis="columns"))


def _percent(of: Errors) -> dict[str, float]:
    """Errors of the observables and the largest of them, %; nan where not known."""
    judged = {name: of.get(name) for name in JUDGED}
    known = judged | {"worst": worst(judged)}
    return {name: nan if x in (None, inf) else 100 * x for name, x in known.items()}


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


def changes(study: Sequence[Run], groups: Sequence[str] = ("feature",)) -> Figure:
    """One matrix for each scene: rows of the ``groups`` down, observables and time saved across."""
    changed = of_group(study, *groups)
    times = {(row["scene"], row["row"]): row["cpu_s"] for row in study}
    shown = [key for key in COLUMNS if any(row["errors"].get(key) is not None for row in changed)]
    records = [
        {"scene": row["scene"], "row": row["row"].replace(": ", " → ")} | cell
        for row in changed
        for cell in _cells(row, shown, row["cpu_s"] / times[row["scene"], row["against"]])
    ]
    look = {"panel": "scene", "labels": COLUMNS | {"change": SAID}, "limits": SHOWN, "log": True}
    return cells.draw(records, "of", "row", "change", text="text", **look)


def _cells(row: Run, shown: Sequence[str], time_ratio: float) -> Iterator[dict[str, object]]:
    """Changes, coloured by their size in %; number of lobes and time saved are written alone."""
    for key in shown:
        change = row["errors"][key]
        size = None if change is None or key == "lobes" else 100 * abs(change)
        yield {"of": key, "change": size, "text": _text(change, size)}
    saved = f"{100 * (1 - time_ratio):.0f}"
    yield {"of": "time", "change": None, "text": saved.replace("-", MINUS)}


def _text(change: float | None, size: float | None) -> str:
    """The size in %, 0 below ``FEWEST``; without a size the number of lobes, if it is known."""
    if size is None:
        return "" if change is None else f"{int(change)}".replace("-", MINUS)
    return two_digits(size) if size >= FEWEST else "0"
