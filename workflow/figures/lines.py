"""Curves of records over a quantity, in panels.

Records, of which ``cells`` draws, too, are plain values by the name of their column.
"""

from collections.abc import Mapping, Sequence
from itertools import cycle
from numbers import Real
from types import MappingProxyType
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatterSciNotation

from workflow.figures import style

type Records = pd.DataFrame | Sequence[Mapping[str, Any]]
type Labels = Mapping[Any, str]  # by column or value
NO_LABELS: Labels = MappingProxyType({})
ROW, FOOTER, KEY = 1.9, 0.5, 0.08  # in: a row of panels, the axis below, a line in the legend
BELOW = -0.3  # of the height of a panel: place of a legend of its own
# Decades of a logarithmic axis with numbers at some, and at all ticks between powers of ten
SHORT = 0.5, 0.25
type Looks = Sequence[tuple[str, Any]]
LOOKS: Looks = (  # of lines, distinct without colour
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
    labels : text for a column, with its unit at the axes, or for a value. Without one
        they are written as they are, and the legend has no title.
    log : axes with a logarithmic scale: x, y or xy.
    looks : format and colour of each line in a panel.
    """
    down, panels = [y] if isinstance(y, str) else y, split(records, panel)
    width = style.SINGLE if len(panels) == 1 else style.DOUBLE
    lines = [*split(records, line)] if line else []
    height = FOOTER + KEY * len(lines) + ROW * len(down)
    drawn, grid = style.subplots(
        width, height, len(down), len(panels), sharex="col", sharey="row", squeeze=False
    )
    for row, quantity in zip(grid, down, strict=True):
        for axes, these in zip(row, panels.values(), strict=True):
            curves(axes, these, x, quantity, line, labels, looks)
            axes.set(xlabel=labelled(labels, x), ylabel=labelled(labels, quantity))
            axes.label_outer()
            for name in log:
                getattr(axes, f"set_{name}scale")("log")
                between = LogFormatterSciNotation(minor_thresholds=SHORT)
                getattr(axes, f"{name}axis").set_minor_formatter(between)
    for axes, name in zip(grid[0], panels, strict=True):
        axes.set_title(labelled(labels, name))
    title = labels.get(line)
    if line and all([*split(these, line)] == lines for these in panels.values()):
        style.legend(drawn, "lower center", ncols=2 if len(panels) > 1 else 1, title=title)
    elif line:
        for axes in grid[-1]:
            axes.legend(loc="upper center", bbox_to_anchor=(0.5, BELOW), title=title)
    return drawn


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
    by_line = split(records, line).items()
    for (name, these), (fmt, color) in zip(by_line, cycle(looks), strict=False):
        points = these[[x, y]].to_numpy(float)
        if np.isfinite(points).all(axis=1).any():
            axes.plot(*points.T, fmt, color=color, label=labelled(labels, name), **look)


def split(records: Records, column: str) -> dict[Any, pd.DataFrame]:
    """Records by their value of a column, in the order in which these occur; without one by ""."""
    frame = pd.DataFrame(records)
    values = frame[column].fillna("") if column else pd.Series("", frame.index)
    return dict([*frame.groupby(values, sort=False)])


def labelled(labels: Labels, name: Any) -> str:
    """Text for a column or a value: its label, or itself."""
    return labels.get(name, f"{name:g}" if isinstance(name, Real) else str(name))
