"""Fig. 13: amplitude and critical speed of a peak over the moduli E and K of the liner."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Ellipse, Patch
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from workflow.figures import style
from workflow.figures.grid import MAP, Grid, axes_of, hatch_cell, ink, is_sensitive, write
from workflow.figures.marks import NO_RESULT, NOT_PREDICTABLE

RING = 0.86  # of a cell's height and of its width


@style.styled
def draw(grid: Grid, order: int) -> Figure:
    """Two maps: ||Y|| and Omega_c, the worst case ringed in both."""
    drawn = style.figure(style.DOUBLE, 4.6)
    top, bottom = drawn.subplots(2, 1, sharex=True)
    amplitude = grid.peak_values(order, "amplitude")
    speed = grid.peak_values(order, "Omega_c")
    _map(top, grid, order, amplitude, "{:.2f}", rf"$\|Y\|$ {style.OVER_GAP}")
    _map(bottom, grid, order, speed, "{:.3f}", r"$\Omega_c/f_1(0)$")
    top.set_title(
        rf"amplitude $\|Y\|$ of the peak $k$ = {order} at {style.PLACE}, {style.OVER_GAP}"
    )
    bottom.set_title(
        rf"its critical speed $\Omega_c/f_1(0)$; $f_1$ = {order}$\Omega$ at "
        f"{_crossing(grid, order):.3f}"
    )
    for axes, letter in ((top, "a"), (bottom, "b")):
        style.panel_letter(axes, letter)
        _ring_worst(axes, amplitude)
    top.set_xlabel("")
    _legend(drawn, grid, order)
    return drawn


def _crossing(grid: Grid, order: int) -> float:
    """Linear crossing of the engine order, over f1(0): the same for all cases; nan without any."""
    at = grid.peak_values(order, "Omega_c") / grid.peak_values(order, "over_crossing")
    return float(at[np.isfinite(at)][0]) if np.isfinite(at).any() else np.nan


def _map(
    axes: Axes, grid: Grid, order: int, values: NDArray[np.float64], digits: str, label: str
) -> None:
    image = axes.imshow(np.ma.masked_invalid(values), cmap=MAP, origin="lower", aspect="auto")
    axes.figure.colorbar(image, ax=axes, label=label, pad=0.01, aspect=12, ticks=MaxNLocator(5))
    axes_of(axes, grid)
    for column, row, case in grid.cells():
        peak = case["peaks"][str(order)]
        if peak is None:
            hatch_cell(axes, column, row, NO_RESULT, style.GREY)
            continue
        face = image.to_rgba(values[row, column])[:3]
        if is_sensitive(peak):
            hatch_cell(axes, column, row, NOT_PREDICTABLE, ink(face))
        bound = r"$\geq$" if peak["at_end"] else ""
        text = bound + digits.format(values[row, column])
        write(axes, column, row, text, face, fontsize=7.5)


def _ring_worst(axes: Axes, amplitude: NDArray[np.float64]) -> None:
    """Ring the case of the largest amplitude, in the colour of its text."""
    if not np.isfinite(amplitude).any():
        return
    row, column = np.unravel_index(np.nanargmax(amplitude), amplitude.shape)
    image = axes.images[0]
    edge = ink(image.to_rgba(image.get_array()[row, column])[:3])
    axes.add_patch(Ellipse((column, row), RING, RING, fill=False, edgecolor=edge, linewidth=1.4))


def _legend(drawn: Figure, grid: Grid, order: int) -> None:
    """Explain the ring, and what else the maps mark."""
    peaks = [case["peaks"][str(order)] for case in grid.cases]
    seen = [peak for peak in peaks if peak]
    ring = {"marker": "o", "markersize": 8, "markerfacecolor": "none", "linestyle": "none"}
    bound = {"marker": r"$\geq$", "markersize": 5, "markeredgewidth": 0, "linestyle": "none"}
    plain: dict[str, Any] = {"facecolor": "white", "edgecolor": style.GREY, "linewidth": 0}
    marks = (
        (seen, Line2D([], [], color=style.BLACK, **ring, label="largest amplitude")),
        (
            any(peak["at_end"] for peak in seen),
            Line2D([], [], color=style.BLACK, **bound, label="the sweep ends on the rise"),
        ),
        (
            any(is_sensitive(peak) for peak in seen),
            Patch(**plain, hatch=NOT_PREDICTABLE, label="not predictable"),
        ),
        (None in peaks, Patch(**plain, hatch=NO_RESULT, label="no run near the peak has a result")),
    )
    handles = [handle for shown, handle in marks if shown]
    sizes = {"handlelength": 2.4, "handleheight": 1.3}
    drawn.legend(handles=handles, loc="outside lower center", ncols=4, **sizes)
