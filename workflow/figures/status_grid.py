"""Which cases of the grid over E and K can be predicted: ends of the runs, twins of the peaks."""

from collections import Counter
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import PercentFormatter

from workflow.figures import style
from workflow.figures.grid import MAP, Grid, axes_of, ink, is_sensitive, write

FACES = {  # of a peak's symbol: outline, filled or not
    "predictable": ("o", True),
    "sensitive": ("D", False),
    "no twin was marched": ("o", False),
    "no run near it has a result": ("x", True),
}
ABOVE, BELOW = 0.2, -0.24  # of a cell's height from its middle: share, symbols
SIDE, BESIDE = 0.24, 0.07  # of its width: a peak from the middle, its symbol from that


def load(files: Any) -> tuple[Grid]:
    """Read the cases, ``files.grid``."""
    return (Grid.read(files.grid),)


@style.styled
def draw(grid: Grid) -> Figure:
    """Share of the runs that are ok, and below it what is known of each peak."""
    drawn = style.figure(style.DOUBLE, 3.0)
    axes = drawn.subplots()
    share = grid.values(_share_ok)
    image = axes.imshow(share, cmap=MAP.reversed(), vmin=0, vmax=1, origin="lower", aspect="auto")
    bar = drawn.colorbar(image, ax=axes, label="share of runs that are ok", pad=0.01, aspect=18)
    bar.ax.yaxis.set_major_formatter(PercentFormatter(1, decimals=0))
    axes_of(axes, grid)
    for column, row, case in grid.cells():
        face = image.to_rgba(share[row, column])[:3]
        text = f"{100 * share[row, column]:.0f} %"
        write(axes, column, row + ABOVE, text, face, fontsize=7.5)
        for order, side in zip(grid.orders, _sides(grid), strict=True):
            _symbol(axes, (column + side, row + BELOW), order, case["peaks"][str(order)], ink(face))
    axes.set_title(_totals(grid))
    _legend(drawn, grid)
    return drawn


def _share_ok(case: dict[str, Any]) -> float:
    return case["statuses"].get("ok", 0) / case["runs"]


def _sides(grid: Grid) -> list[float]:
    """Where the peaks stand beside a cell's middle."""
    return list(np.linspace(-SIDE, SIDE, len(grid.orders)))


def state_of(peak: dict[str, Any] | None) -> str:
    """What is known of a peak; a key of ``FACES``."""
    if peak is None:
        return "no run near it has a result"
    sensitive = is_sensitive(peak)
    if sensitive is None:
        return "no twin was marched"
    return "sensitive" if sensitive else "predictable"


def _symbol(
    axes: Axes, at: tuple[float, float], order: int, peak: dict[str, Any] | None, colour: str
) -> None:
    """Write the engine order and the symbol of its peak's state."""
    x, y = at
    axes.text(x - BESIDE, y, str(order), ha="center", va="center", color=colour, fontsize=6.5)
    axes.add_line(_marker(state_of(peak), colour, [x + BESIDE], [y]))


def _marker(state: str, colour: str, x: list[float], y: list[float]) -> Line2D:
    marker, filled = FACES[state]
    face = colour if filled else "none"
    look = {"color": colour, "markerfacecolor": face, "markersize": 4, "linestyle": "none"}
    return Line2D(x, y, marker=marker, label=state, **look)


def _totals(grid: Grid) -> str:
    """How many runs there are, how they ended, and which of them have twins."""
    ends = sum((Counter(case["statuses"]) for case in grid.cases), Counter())
    listed = ", ".join(f"{count:,} {word}" for word, count in ends.most_common())
    return f"{ends.total():,} runs: {listed}; twins at the peaks alone"


def _legend(drawn: Figure, grid: Grid) -> None:
    """Explain the symbols that are there."""
    peaks = (case["peaks"][str(order)] for case in grid.cases for order in grid.orders)
    there = {state_of(peak) for peak in peaks}
    orders = " and ".join(str(order) for order in grid.orders)
    handles = [_marker(state, style.BLACK, [], []) for state in FACES if state in there]
    drawn.legend(
        handles=handles,
        loc="outside lower center",
        ncols=len(FACES),
        title=f"response at the peaks $k$ = {orders}",
        title_fontsize=7,
        handlelength=1.0,
    )
