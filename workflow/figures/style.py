"""Style of all figures: column widths of a journal, colours for the colour-blind, file formats."""

from collections.abc import Iterable
from math import ceil
from pathlib import Path
from string import ascii_lowercase
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axes._secondary_axes import SecondaryAxis
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.text import Annotation
from numpy.typing import NDArray

from geometry.base import whole

SINGLE, DOUBLE = 3.5, 7.0  # in, width of one and of two columns
SPEED_LABEL = r"rotational speed $\Omega / f_1(0)$"
FREQUENCY_LABEL = r"frequency $f / f_1(0)$"
WIDEST = 0.04  # widest cell of a speed in a map, over the last speed
ROOM = 0.25  # of the width of a sweep, left of it
PLACE = r"$\xi$ = 1/16"  # chord fraction of displacements in figures
OVER_GAP = "over gap $g$"  # the initial gap there
WORN = "worn depth of leading eighth"  # of the chord, mean over it
BLACK, GREY = "#000000", "#808080"
BLUE, VERMILLION, GREEN = "#0072B2", "#D55E00", "#009E73"
ARROW = {"arrowstyle": "-|>", "linewidth": 1.0, "color": BLACK, "shrinkA": 0, "shrinkB": 0}
# The darker the larger, also in grey; white below the scale and where there is no number.
MAP = mpl.colormaps["magma_r"].with_extremes(under="white", bad="white")
NO_RUN = "0.88"  # of maps over speeds, between and beyond these
MAP_FROM_ZERO = ListedColormap(["white", *MAP(np.linspace(0, 1, 255))])

RC = {
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "axes.labelsize": 8,
    "axes.titlesize": 8,
    "axes.linewidth": 0.6,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "xtick.direction": "out",
    "ytick.direction": "out",
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 1.0,
    "lines.markersize": 3.5,
    "legend.fontsize": 7,
    "legend.frameon": False,
    "hatch.linewidth": 0.5,
    "mathtext.fontset": "dejavusans",
    "pdf.fonttype": 42,
    "savefig.dpi": 300,
    "axes.grid": False,
    "axes.formatter.min_exponent": 4,  # logarithmic axes: smaller powers of ten are plain numbers
}


# Decorator of functions that draw: applies RC and restores matplotlib's settings afterwards
styled = mpl.rc_context(RC)


def figure(width: float, height: float) -> Figure:
    """Empty figure, size in inches, with a constrained layout."""
    return Figure(figsize=(width, height), layout="constrained")


def subplots(
    width: float,
    height: float,
    rows: int = 1,
    columns: int = 1,
    letters: bool = False,
    **shared: Any,
) -> tuple[Figure, Any]:
    """Figure, size in inches, and its panels as of ``Figure.subplots``, lettered if asked for."""
    drawn = figure(width, height)
    panels = drawn.subplots(rows, columns, **shared)
    if letters:
        letter_panels(np.ravel(panels))
    return drawn, panels


def panels(number: int, width: float, height: float, columns: int = 2) -> Figure:
    """Figure, size in inches, with lettered panels on equal axes, at most so many in a row."""
    across = min(columns, number)
    drawn, grid = subplots(
        width,
        height,
        ceil(number / across),
        across,
        letters=number > 1,
        sharex=True,
        sharey=True,
        squeeze=False,
    )
    for axes in grid.flat[number:]:
        axes.remove()
    return drawn


def save(drawn: Figure, *paths: str | Path, origin: str = "") -> None:
    """Write the figure in the format of each path's suffix, reproducibly.

    ``origin``: provenance, written as the description of a PNG or the subject of a PDF.
    """
    for path in map(Path, paths):
        with mpl.rc_context(RC), whole(path) as temporary:
            drawn.savefig(
                temporary,
                metadata={"Subject": origin, "CreationDate": None}
                if path.suffix == ".pdf"
                else {"Description": origin},
            )


def edges(centres: NDArray[np.float64]) -> NDArray[np.float64]:
    """Cell edges (n + 1,) halfway between ascending ``centres`` (n,); for n = 1, 1 % off it."""
    if len(centres) == 1:
        return centres[0] * np.array([0.99, 1.01])
    between = (centres[:-1] + centres[1:]) / 2
    return np.array([2 * centres[0] - between[0], *between, 2 * centres[-1] - between[-1]])


def spans(speeds: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lower and upper ends (n,) of the cells around ascending ``speeds`` (n,), ``WIDEST`` at most.

    Between speeds that lie further apart nothing is known: no cell covers them.
    """
    between, half = edges(speeds), WIDEST * speeds[-1] / 2
    return np.maximum(between[:-1], speeds - half), np.minimum(between[1:], speeds + half)


def limits(speeds: NDArray[np.float64]) -> tuple[float, float]:
    """Ends of an axis of ascending ``speeds`` (n,): from 0, or from ``ROOM`` left of a high sweep.

    That room is for legends and the titles of rows.
    """
    lower, upper = spans(speeds)
    return float(max(lower[0] - ROOM * (upper[-1] - lower[0]), 0.0)), float(upper[-1])


def over_speeds(
    speeds: NDArray[np.float64], values: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Edges (2 n,) of the cells and the intervals between, and masked values (2 n - 1, ...)."""
    spread = np.full((2 * len(values) - 1, *values.shape[1:]), np.nan)
    spread[::2] = values
    return np.ravel(spans(speeds), order="F"), np.ma.masked_invalid(spread)


def log_map(
    axes: Axes,
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    values: NDArray[np.float64],
    scale: tuple[float, float],
    **bar: Any,
) -> None:
    """Colour the cells between the edges ``x`` and ``y`` on a logarithmic ``scale``.

    White is below the scale; without a number cells have the colour ``NO_RUN``. ``bar``: arguments
    of the colour bar.
    """
    axes.set_facecolor(NO_RUN)
    seen = np.ma.maximum(values, scale[0] / 10)  # a logarithm of 0 would be no number
    colours = MAP.with_extremes(under="white", bad=NO_RUN)
    mesh = axes.pcolormesh(x, y, seen, norm=LogNorm(*scale), cmap=colours, rasterized=True)
    axes.figure.colorbar(mesh, ax=axes, **bar)


def decades(largest: float, count: int) -> tuple[float, float]:
    """Scale of ``count`` decades that ends at the first power of ten not below ``largest``."""
    top = np.ceil(np.log10(largest)) if largest > 0 else 0.0
    return 10.0 ** (top - count), 10.0**top


def letter_panels(panels: Iterable[Axes]) -> None:
    """Put (a), (b), ... outside the upper left corners of ``panels``, in their order."""
    for letter, axes in zip(ascii_lowercase, panels, strict=False):
        axes.set_title(f"({letter})", loc="left", fontweight="bold")


def legend(drawn: Figure, place: str, **look: Any) -> None:
    """Add a legend of all axes at ``place`` outside of them, each label once."""
    shown = {
        label: handle
        for axes in drawn.axes
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    drawn.legend(shown.values(), shown.keys(), loc=f"outside {place}", **look)


def note(
    axes: Axes, place: tuple[Any, Any], text: str, offset: tuple[float, float], **look: Any
) -> Annotation:
    """Write small ``text``, outside the axes too, ``offset`` (points of type) from ``place``."""
    look = {"fontsize": 7, "annotation_clip": False} | look
    return axes.annotate(text, place, offset, textcoords="offset points", **look)


def measure(
    axes: Axes,
    begin: tuple[float, float],
    end: tuple[float, float],
    name: str,
    offset: tuple[float, float],
    **look: Any,
) -> None:
    """Draw a double arrow, and small ``name`` at an ``offset`` (points of type) from its middle."""
    axes.annotate(
        "",
        begin,
        end,
        arrowprops={"arrowstyle": "<->", "linewidth": 0.6, "shrinkA": 0, "shrinkB": 0},
    )
    note(axes, tuple(np.mean([begin, end], axis=0)), name, offset, **look)


def below(axes: Axes, scale: float, label: str) -> SecondaryAxis:
    """A second axis below that of x, in a unit of which x is ``scale``."""
    return _second(axes.secondary_xaxis, "bottom", 30, scale, label)


def beside(axes: Axes, scale: float, label: str, outward: float = 0) -> SecondaryAxis:
    """A second axis of y at the right, ``outward`` points of it, in a unit of ``scale``."""
    return _second(axes.secondary_yaxis, "right", outward, scale, label)


def _second(made: Any, side: str, outward: float, scale: float, label: str) -> SecondaryAxis:
    second = made(side, functions=(lambda x: x * scale, lambda x: x / scale))
    second.spines[side].set_position(("outward", outward))
    getattr(second, "set_ylabel" if side == "right" else "set_xlabel")(label)
    second.tick_params(labelsize=7)
    return second
