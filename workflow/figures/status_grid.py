"""Predictability over E and K: share of runs that end ok, and twin runs at the peaks."""

from collections import Counter

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import PercentFormatter

from workflow.figures import style
from workflow.figures.heat_map import (
    MAP,
    Case,
    by_cell,
    face_of,
    heat_map,
    ink,
    is_sensitive,
    write,
)

MARKERS = {  # by the state of a peak: marker, and whether it is filled
    "predictable": ("o", True),
    "sensitive": ("D", False),
    "no twin was marched": ("o", False),
    "no run near it has a result": ("x", True),
}
ABOVE, BELOW = 0.2, -0.24  # of a cell's height from its middle: share, symbols
SIDE, SYMBOL = 0.24, 0.07  # of its width: offsets of a peak, and of its label and symbol


@style.styled
def draw(grid: Case) -> Figure:
    """Share of the runs that are ok, and below it the state of each peak."""
    drawn, axes = style.subplots(style.DOUBLE, 3.0)
    cases, orders = by_cell(grid, "E", "K"), grid["orders"]
    share = {cell: case["statuses"].get("ok", 0) / case["runs"] for cell, case in cases.items()}
    bar = {"label": "share of runs that are ok", "format": PercentFormatter(1, decimals=0)}
    heat_map(axes, grid["E"], grid["K"], share, **bar)
    axes.images[0].set(cmap=MAP.reversed(), clim=(0, 1))
    there = set()
    for cell, case in cases.items():
        write(axes, cell, f"{100 * share[cell]:.0f} %", higher=ABOVE)
        colour, y = ink(face_of(axes, cell)), cell[0] + BELOW
        for order, side in zip(orders, np.linspace(-SIDE, SIDE, len(orders)), strict=True):
            x, state = cell[1] + side, state_of(case["peaks"][str(order)])
            look = {"ha": "center", "va": "center", "color": colour, "fontsize": 6.5}
            axes.text(x - SYMBOL, y, str(order), **look)
            axes.add_line(_symbol(state, colour, [x + SYMBOL], [y]))
            there.add(state)
    axes.set(
        xlabel="Young modulus $E$, paper's unit",
        ylabel="plastic modulus $K$",
        title=_totals(grid),
    )
    drawn.legend(
        handles=[_symbol(state, style.BLACK, [], []) for state in MARKERS if state in there],
        loc="outside lower center",
        ncols=len(MARKERS),
        title=f"response at the peaks $k$ = {' and '.join(map(str, orders))}",
        title_fontsize=7,
        handlelength=1.0,
    )
    return drawn


def state_of(peak: Case | None) -> str:
    """State of a peak, a key of ``MARKERS``."""
    if peak is None:
        return "no run near it has a result"
    states = {None: "no twin was marched", True: "sensitive", False: "predictable"}
    return states[is_sensitive(peak)]


def _symbol(state: str, colour: str, x: list[float], y: list[float]) -> Line2D:
    marker, filled = MARKERS[state]
    face = colour if filled else "none"
    look = {"color": colour, "markerfacecolor": face, "markersize": 4, "linestyle": "none"}
    return Line2D(x, y, marker=marker, label=state, **look)


def _totals(grid: Case) -> str:
    """Number of runs by status, and which of them have twins."""
    ends = sum((Counter(case["statuses"]) for case in grid["cases"]), Counter())
    listed = ", ".join(f"{count:,} {word}" for word, count in ends.most_common())
    return f"{ends.total():,} runs: {listed}; twins at the peaks alone"
