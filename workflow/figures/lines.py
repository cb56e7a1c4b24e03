"""Curves of records over a quantity, in panels."""

from collections.abc import Sequence
from itertools import cycle
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatterSciNotation

from workflow.figures import style
from workflow.figures.records import NO_LABELS, Labels, Records, labelled, split, values_of

ROW, FOOTER, KEY = 1.9, 0.5, 0.08  # in: a row of panels, the axis below, a line in the legend
BELOW = -0.3  # of the height of a panel: place of a legend of its own
SHORT = 0.5, 0.25  # decades of an axis with numbers at some, and at all ticks
type Looks = Sequence[tuple[str, Any]]
LOOKS: Looks = (  # of lines, told apart without colour
    ("o-", style.BLACK),
    ("s--", style.VERMILLION),
    ("^:", style.BLUE),
    ("D-.", style.GREEN),
    ("v-", style.GREY),
    ("x--", style.BLACK),
)


@style.styled
def draw(
    records: Records,
    x: str,
    y: str | Sequence[str],
    *,
    line: str = "",
    panel: str = "",
    labels: Labels = NO_LABELS,
    log: str = "",
    looks: Looks = LOOKS,
) -> Figure:
    """Draw the records: panels across by a column, and down for each of the quantities ``y``.

    The legend is below all panels, or below each where they have different lines.

    Parameters
    ----------
    records : plain values by column. Points of a line are joined in their order; where a number
        is None, the line has a gap.
    x, y : columns of numbers.
    line : column; a line for each of its values.
    panel : column; a panel for each of its values.
    labels : what is written for a column, with its unit at the axes, or for a value. Without one
        they are written as they are.
    log : axes with a logarithmic scale: x, y or xy.
    looks : format and colour of each line in a panel.
    """
    down, panels = [y] if isinstance(y, str) else y, split(records, panel)
    width = style.SINGLE if len(panels) == 1 else style.DOUBLE
    lines = values_of(records, line) if line else []
    size = width, FOOTER + KEY * len(lines) + ROW * len(down)
    shared = {"sharex": "col", "sharey": "row", "squeeze": False}
    drawn, grid = style.subplots(*size, len(down), len(panels), **shared)
    for column, (name, these) in zip(grid.T, panels.items(), strict=True):
        for axes, quantity in zip(column, down, strict=True):
            curves(axes, these, x, quantity, line, labels, looks)
            for name_of_axis in log:
                _make_log(axes, name_of_axis)
        column[0].set_title(labelled(labels, name))
        column[-1].set_xlabel(labelled(labels, x))
    for row, quantity in zip(grid, down, strict=True):
        row[0].set_ylabel(labelled(labels, quantity))
    if line and all(values_of(these, line) == lines for these in panels.values()):
        style.legend(drawn, "lower center", ncols=2 if len(panels) > 1 else 1)
    elif line:
        for axes in grid[-1]:
            axes.legend(loc="upper center", bbox_to_anchor=(0.5, BELOW))
    return drawn


def _make_log(axes: Axes, name: str) -> None:
    """Make an axis logarithmic; ticks between powers of ten have numbers on a short one."""
    getattr(axes, f"set_{name}scale")("log")
    between = LogFormatterSciNotation(minor_thresholds=SHORT)
    getattr(axes, f"{name}axis").set_minor_formatter(between)


def curves(
    axes: Axes,
    records: Records,
    x: str,
    y: str,
    line: str = "",
    labels: Labels = NO_LABELS,
    looks: Looks = LOOKS,
    **look: Any,
) -> None:
    """Draw a line for each value of a column on ``axes``; the arguments are those of ``draw``.

    ``look``: of all lines. Those without a number are left out.
    """
    for (name, these), (fmt, color) in zip(
        split(records, line).items(), cycle(looks), strict=False
    ):
        at = np.array([[record[x], record[y]] for record in these], float)
        if np.isfinite(at).all(axis=1).any():
            axes.plot(*at.T, fmt, color=color, label=labelled(labels, name), **look)
