"""A matrix of numbers: a cell for each record, coloured by a number, with a text in it."""

from collections.abc import Sequence
from math import ceil
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.image import AxesImage

from workflow.figures import style
from workflow.figures.lines import NO_LABELS, Labels, Records, labelled, split
from workflow.markdown import cell as number_in

GREY_WEIGHTS = (0.299, 0.587, 0.114)  # of red, green and blue in the luma (ITU-R BT.601)
DARK = 0.5  # luma of a cell below which its text is white
LINE, HEADER, FOOTER = 0.19, 0.62, 0.6  # in: a row, the names of columns, the colour bar
UPRIGHT = 10  # most columns with upright names


@style.styled
def draw(
    records: Records,
    x: str,
    y: str,
    value: str,
    *,
    panel: str = "",
    labels: Labels = NO_LABELS,
    log: bool | str = False,
) -> Figure:
    """Draw the records in panels, two beside one another, with one colour bar below.

    Parameters
    ----------
    records : plain values by column, a record for each cell; others are white.
    x, y : columns that name columns and rows of the matrix, in the order in which they occur.
    value : column of the number that stands in a cell and colours it; white where it is None.
    panel : column; a panel for each of its values, with all columns and rows.
    labels : text for a column or for one of its values: of ``value`` at the colour
        bar, of ``x`` and ``y`` at the axes. Values without one are written as they are.
    log : whether the scale of the colours, from the least to the largest number, is logarithmic;
        any text says so. A linear scale begins at 0 where no number is below.
    """
    frame = pd.DataFrame(records).copy()
    for name in (x, y):  # where a column has no value, its name is empty
        frame[name] = frame[name].astype(object).where(frame[name].notna(), "")
    panels, columns, rows = (split(frame, column) for column in (panel, x, y))
    height = FOOTER + ceil(len(panels) / 2) * (HEADER + LINE * len(rows))
    drawn = style.panels(len(panels), style.DOUBLE, height)
    scale = LogNorm() if log else Normalize(min(0.0, frame[value].min()))
    for axes, (name, these) in zip(drawn.axes, panels.items(), strict=True):
        image = matrix(
            axes,
            these.to_dict("records"),
            x,
            y,
            value,
            [*columns],
            [*rows],
            labels=labels,
            colours=style.MAP if log else style.MAP_FROM_ZERO,
            scale=scale,
        )
        axes.set_title(labelled(labels, name), fontweight="bold")
        axes.set(xlabel=labels.get(x, ""), ylabel=labels.get(y, ""))
        axes.xaxis.set_label_position("top")
        axes.grid(which="minor", color="0.8", linewidth=0.3)
        axes.tick_params(labeltop=True, labelbottom=False, labelsize=7)
        axes.tick_params(axis="x", rotation=90 if len(columns) > UPRIGHT else 0)
        axes.spines[:].set_visible(False)
    drawn.colorbar(
        image,
        ax=drawn.axes,
        label=labelled(labels, value),
        location="bottom",
        aspect=60,
        format="{x:g}",
    )
    return drawn


def matrix(
    axes: Axes,
    records: Records,
    x: str,
    y: str,
    value: str,
    columns: Sequence[Any],
    rows: Sequence[Any],
    *,
    text: str = "",
    bold: str = "",
    labels: Labels = NO_LABELS,
    colours: Colormap = style.MAP,
    scale: Normalize | None = None,
) -> AxesImage:
    """Colour the cells of all ``columns`` and ``rows`` on ``axes``, and write into them.

    The arguments are those of ``draw``; ``scale`` is that of the ``colours``.

    Parameters
    ----------
    text : column of the text in a cell; without it the number of ``value``
    bold : column of whether the text is bold
    """
    places = {(rows.index(record[y]), columns.index(record[x])): record for record in records}
    values = np.full((len(rows), len(columns)), np.nan)
    for cell, record in places.items():
        values[cell] = record[value]
    image = axes.imshow(np.ma.masked_invalid(values), colours, scale, aspect="auto")
    for axis, names in ((axes.xaxis, columns), (axes.yaxis, rows)):
        axis.set_ticks(range(len(names)), [labelled(labels, name) for name in names])
        axis.set_ticks(np.arange(len(names) + 1) - 0.5, minor=True)
    axes.grid(which="minor", color="white", linewidth=1.0)
    axes.tick_params(which="both", length=0)
    faces = image.to_rgba(image.get_array())
    for (row, column), record in places.items():
        shown = record[text] if text else number_in(record[value], unknown="")
        if shown:
            dark = np.dot(GREY_WEIGHTS, faces[row, column, :3]) < DARK
            axes.text(
                column,
                row,
                shown,
                color="white" if dark else style.BLACK,
                fontweight="bold" if bold and record[bold] else "normal",
                ha="center",
                va="center",
                fontsize=7,
            )
    return image
