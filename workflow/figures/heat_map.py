"""Maps over two quantities with a cell for each case: coloured, labelled, hatched and ringed.

A cell is (row, column), counted from the lower left.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, ListedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.patches import Ellipse, Patch, Rectangle
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from simulate.marching.status import SENSITIVE_FROM
from workflow.figures import style
from workflow.figures.marks import NO_RESULT, NOT_PREDICTABLE, SIZES

GREY_WEIGHTS = (0.299, 0.587, 0.114)  # of red, green and blue in the luma (ITU-R BT.601)
DARK = 0.5  # luma of a cell below which its text is white
# the darkest colours, on which hatches are invisible, are left out; white where there is no number
MAP = ListedColormap(style.MAP(np.linspace(0, 0.75, 256))).with_extremes(bad="white")
RING = 0.86  # of a cell's height and of its width
# Marks of a number, and the hatches of its cell
NO_PEAK, SENSITIVE = "no run near a peak has a result", "not predictable"
HATCHES = {NO_PEAK: NO_RESULT, SENSITIVE: NOT_PREDICTABLE}
RISE, STAR = "a sweep ends on the rise", "*"  # written after the number

type Case = dict[str, Any]
type Cell = tuple[int, int]


def by_cell(table: Mapping[str, Any], across: str, up: str) -> dict[Cell, Case]:
    """Cases of a table by cell; ``across`` and ``up`` are the keys of its two quantities."""
    return {
        (table[up].index(case[up]), table[across].index(case[across])): case
        for case in table["cases"]
    }


def is_sensitive(peak: Case) -> bool | None:
    """Whether the peak's spectrum cannot be predicted; None where no twin was marched.

    JSON has no inf: where run and twin end differently, the departure is None and the status is
    `sensitive`.
    """
    if peak["departure"] is None:
        return True if peak["status"] == "sensitive" else None
    return peak["departure"] > SENSITIVE_FROM


def marks_of(peak: Case | None) -> set[str]:
    """Marks of the numbers of a peak."""
    if peak is None:
        return {NO_PEAK}
    names = {RISE: peak["at_end"], SENSITIVE: is_sensitive(peak)}
    return {name for name, holds in names.items() if holds}


def heat_map(
    axes: Axes,
    across: Sequence[float],
    up: Sequence[float],
    numbers: Mapping[Cell, float | None],
    **bar: Any,
) -> None:
    """Colour the cells by ``numbers``, white without one.

    Columns and rows are labelled by the values ``across`` and ``up``; ``bar``: arguments of the
    colour bar.
    """
    columns, rows = ([f"{value:g}" for value in values] for values in (across, up))
    image = cells(axes, columns, rows, numbers, MAP)
    look = {"pad": 0.01, "aspect": 15, "ticks": MaxNLocator(5)}
    axes.figure.colorbar(image, ax=axes, **look, **bar)


def cells(
    axes: Axes,
    columns: Sequence[str],
    rows: Sequence[str],
    numbers: Mapping[Cell, float | None],
    colours: Colormap,
    norm: Normalize | None = None,
) -> AxesImage:
    """Colour the cells of named ``columns`` and ``rows`` by ``numbers``, white without one."""
    values = np.full((len(rows), len(columns)), np.nan)
    for cell, number in numbers.items():
        values[cell] = np.nan if number is None else number
    look = {"cmap": colours, "norm": norm, "origin": "lower", "aspect": "auto"}
    image = axes.imshow(np.ma.masked_invalid(values), **look)
    for axis, names in ((axes.xaxis, columns), (axes.yaxis, rows)):
        axis.set_ticks(range(len(names)), names)
        axis.set_ticks(np.arange(len(names) + 1) - 0.5, minor=True)
    axes.grid(which="minor", color="white", linewidth=1.0)
    axes.tick_params(which="both", length=0)
    return image


def face_of(axes: Axes, cell: Cell) -> NDArray[np.float64]:
    """Colour (4,) of a cell."""
    (image,) = axes.images
    return image.to_rgba(image.get_array())[cell]


def ink(face: Any) -> str:
    """Black or white, whichever is legible on the colour ``face``."""
    return "white" if np.dot(GREY_WEIGHTS, face[:3]) < DARK else style.BLACK


def write(axes: Axes, cell: Cell, text: str, higher: float = 0.0, **look: Any) -> None:
    """Write into a cell, ``higher`` than its middle, on a background without hatch."""
    face = face_of(axes, cell)
    look = {"ha": "center", "va": "center", "fontsize": 7, "color": ink(face)} | look
    behind = {"facecolor": face, "edgecolor": "none", "pad": 1.0}
    axes.text(cell[1], cell[0] + higher, text, bbox=behind, **look)


def fill(
    axes: Axes, numbers: Mapping[Cell, float | None], marks: Mapping[Cell, set[str]], digits: int
) -> None:
    """Write ``numbers`` into their cells and hatch cells by ``marks``, in grey without a number."""
    for cell, number in numbers.items():
        hatch = "".join(HATCHES.get(name, "") for name in marks[cell])
        edge = style.GREY if number is None else ink(face_of(axes, cell))
        box = {"hatch": hatch, "fill": False, "edgecolor": edge, "linewidth": 0}
        axes.add_patch(Rectangle((cell[1] - 0.5, cell[0] - 0.5), 1, 1, **box))
        if number is not None:
            write(axes, cell, f"{number:.{digits}f}{STAR if RISE in marks[cell] else ''}")


def ring(axes: Axes, cell: Cell) -> None:
    """Ring a cell in the colour of its text."""
    look = {"fill": False, "edgecolor": ink(face_of(axes, cell)), "linewidth": 1.4}
    axes.add_patch(Ellipse(cell[::-1], RING, RING, **look))


def square(axes: Axes, cell: Cell, label: str) -> Line2D:
    """Mark a cell by a dashed square in the colour of its text; return its key."""
    dashed = {"fill": False, "linestyle": (0, (3, 2)), "linewidth": 1.4}
    corner = (cell[1] - RING / 2, cell[0] - RING / 2)
    axes.add_patch(Rectangle(corner, RING, RING, edgecolor=ink(face_of(axes, cell)), **dashed))
    look = {"color": style.BLACK, "linestyle": "none", "markerfacecolor": "none", "label": label}
    return Line2D([], [], marker="s", markersize=8, markeredgewidth=0.8, **look)


def explain(drawn: Figure, ringed: str, marks: Mapping[Any, set[str]], *more: Line2D) -> None:
    """Add the legend below the figure: the ring, and the marks that occur."""
    there = set().union(*marks.values())
    black = {"color": style.BLACK, "linestyle": "none"}
    circle = Line2D([], [], label=ringed, marker="o", markersize=8, markerfacecolor="none", **black)
    star = {"marker": f"${STAR}$", "markersize": 5, "markeredgewidth": 0} | black
    plain = {"facecolor": "white", "edgecolor": style.GREY, "linewidth": 0}
    keys = {RISE: Line2D([], [], label=RISE, **star)}
    keys |= {name: Patch(hatch=hatch, label=name, **plain) for name, hatch in HATCHES.items()}
    handles = [circle, *more, *(key for name, key in keys.items() if name in there)]
    drawn.legend(handles=handles, loc="outside lower center", ncols=min(4, len(handles)), **SIZES)
