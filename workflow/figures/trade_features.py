"""What a scene requires: how its results change, and what is saved, without each feature."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from geometry.files import read_json
from workflow.figures import style
from workflow.figures.trade import panels

COLUMNS = {
    "amplitude": "ampli-\ntude",
    "Omega_c": r"$\Omega_c$",
    "wear": "wear\nmap",
    "lobes": "lobes",
    "force": "peak\nforce",
    "history": "first\nrounds",
}
LOBES = "lobes"
NORM = LogNorm(1e-3, 1)  # of the shades; white below
DARK = 0.42  # of the shades, from which numbers are white
LINE, HEADER = 0.19, 0.62  # in: a feature; what stands over and under the features of a scene
GAP = 0.25  # of a column, before the time saved
MINUS = "\N{MINUS SIGN}"
FEWEST = 5e-4  # a change that rounds to zero

Entry = dict[str, Any]


def load(files: Any) -> tuple[list[Entry]]:
    """Read the study, ``files.features``."""
    return (read_json(files.features)["features"],)


@style.styled
def draw(features: list[Entry]) -> Figure:
    """One matrix for each scene: features down, observables and time saved across."""
    rows = list(dict.fromkeys((entry["feature"], entry["instead"]) for entry in features))
    shown = [key for key in COLUMNS if any(_changed(entry, key) for entry in features)]
    scenes = list(dict.fromkeys(entry["scene"] for entry in features))
    down = -(-len(scenes) // 2)
    drawn = style.figure(style.DOUBLE, 0.6 + down * (HEADER + LINE * len(rows)))
    _, named = panels(drawn, scenes)
    for axes, scene in named:
        mesh = _matrix(axes, [e for e in features if e["scene"] == scene], rows, shown)
        axes.set_title(scene, fontweight="bold")
    bar = drawn.colorbar(mesh, ax=drawn.axes, location="bottom", aspect=60, extend="both")
    bar.set_label("change without the feature (%; of lobes: their number); CPU time saved (%)")
    bar.ax.xaxis.set_major_formatter(FuncFormatter(lambda change, _: f"{100 * change:g}"))
    return drawn


def percent(change: float) -> str:
    """Size of a change in % with at most two digits; 0 where it rounds to nothing."""
    size = 100 * abs(change)
    if size < 100 * FEWEST:
        return "0"
    return f"{size:.0f}" if size >= 9.95 else f"{size:.1f}"


def _changed(entry: Entry, key: str) -> bool:
    return entry["changes"][key] is not None


def _matrix(axes: Axes, entries: list[Entry], rows: list[Any], shown: list[str]) -> Any:
    values = np.full((len(rows), len(shown)), np.nan)
    time_at = len(shown) + GAP
    for entry in entries:
        row = rows.index((entry["feature"], entry["instead"]))
        for column, key in enumerate(shown):
            if _changed(entry, key):
                values[row, column] = _cell(axes, row, column, key, entry["changes"][key])
        if entry["time_ratio"] is not None:
            _number(
                axes, row, time_at, f"{100 * (1 - entry['time_ratio']):.0f}".replace("-", MINUS)
            )
    edges = np.arange(len(shown) + 1) - 0.5, np.arange(len(rows) + 1) - 0.5
    mesh = axes.pcolormesh(
        *edges, values, cmap=style.MAP, norm=NORM, edgecolor="0.8", linewidth=0.3, clip_on=False
    )
    heads = [COLUMNS[key] for key in shown]
    axes.set_xticks([*range(len(shown)), time_at], [*heads, "time\nsaved"])
    axes.set_yticks(range(len(rows)), [f"{feature} → {instead}" for feature, instead in rows])
    axes.tick_params(length=0, labeltop=True, labelbottom=False, labelsize=7)
    axes.set(xlim=(-0.5, time_at + 0.5), ylim=(len(rows) - 0.5, -0.5))
    axes.spines[:].set_visible(False)
    return mesh


def _cell(axes: Axes, row: int, column: int, key: str, change: float) -> float:
    """Write a change; its shade, none for a number of lobes."""
    if key == LOBES:
        _number(axes, row, column, f"{int(change)}".replace("-", MINUS))
        return np.nan
    size = abs(change)
    _number(axes, row, column, percent(size), "white" if NORM(size) > DARK else "black")
    return size


def _number(axes: Axes, row: int, column: float, text: str, color: str = "black") -> None:
    axes.text(column, row, text, color=color, ha="center", va="center", fontsize=7)
