"""Influence of two quantities that the paper does not give: unit of E and casing amplitude."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.artist import setp
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from geometry.files import read_json
from workflow.figures import style
from workflow.figures.heat_map import (
    NO_PEAK,
    NO_RUB,
    Case,
    by_cell,
    explain,
    fill,
    heat_map,
    marks_of,
    ring,
)
from workflow.paper.contact_map import TARGETS

GIGA = 1e-9
LEAST_WEAR = 1e-3  # gaps; with a smaller deepest wear the blade does not rub
PAPER_SHIFT, _ = TARGETS["4"]  # of the k = 4 peak, E = 1, over the linear crossing
BORDER = {"color": style.BLACK, "linewidth": 1.8}


@dataclass(frozen=True)
class Panel:
    """One map: the value shown, the peaks it is computed from, and the contour level drawn."""

    title: str
    label: str  # of the colours
    number: Callable[[Case], float | None]
    digits: int  # after the point
    peaks: tuple[tuple[str, str], ...]  # coating and engine order
    level: float | None = None


def _ratio(number: str) -> Callable[[Case], float]:
    return lambda case: case["e10"]["4"][number] / case["e1"]["4"][number]


BOTH_COATINGS = (("e1", "4"), ("e10", "4"))
PANELS = (
    Panel(
        "shift of the peak $k$ = 4, $E$ = 1",
        r"$\Omega_c$ over linear crossing",
        lambda case: case["e1"]["4"]["over_crossing"],
        2,
        (("e1", "4"),),
        PAPER_SHIFT,
    ),
    Panel(
        "distance from the paper's two shifts",
        "of $k$ = 4 and 6, $E$ = 1\n(half digits of the paper's speeds)",
        lambda case: case["miss"],
        1,
        (("e1", "4"), ("e1", "6")),
    ),
    Panel(
        r"amplitude $\|Y\|$ of the peak $k$ = 4",
        "$E$ = 10 over $E$ = 1",
        _ratio("amplitude"),
        2,
        BOTH_COATINGS,
        1.0,
    ),
    Panel(
        "deepest wear at the peak $k$ = 4",
        "$E$ = 10 over $E$ = 1",
        _ratio("deepest_wear"),
        2,
        BOTH_COATINGS,
        1.0,
    ),
)


def load(files: Any) -> tuple[Case]:
    """Read the cases, ``files.map``."""
    return (read_json(files.map),)


@style.styled
def draw(table: Case) -> Figure:
    """Four maps over the same axes; the choice nearest to the paper is ringed in each."""
    drawn, grid = style.subplots(style.DOUBLE, 5.6, 2, 2, letters=True, sharex=True, sharey=True)
    cases, seen = by_cell(table, "unit_Pa", "scale"), {}
    (best,) = by_cell(table | {"cases": [table["best"]]}, "unit_Pa", "scale")
    units = [GIGA * unit for unit in table["unit_Pa"]]
    for axes, panel in zip(grid.ravel(), PANELS, strict=True):
        marks = {cell: panel_marks(case, panel) for cell, case in cases.items()}
        numbers = {
            cell: None if marks[cell] & {NO_PEAK, NO_RUB} else panel.number(case)
            for cell, case in cases.items()
        }
        values = heat_map(axes, units, table["scale"], numbers, label=panel.label)
        fill(axes, numbers, marks, panel.digits)
        if panel.level is not None:
            edges = borders(values, panel.level)
            axes.add_collection(LineCollection(edges, capstyle="projecting", **BORDER))
        axes.set_title(panel.title, loc="right")
        ring(axes, best)
        seen |= {(panel.title, cell): marks[cell] for cell in marks}
    setp(grid[1], xlabel="unit of $E$ (GPa)")
    setp(grid[:, 0], ylabel="casing amplitude (gaps)")
    border = Line2D([], [], label=f"(a): the paper's {PAPER_SHIFT}; (c), (d): 1", **BORDER)
    explain(drawn, "nearest to the paper's shifts", seen, border)
    return drawn


def panel_marks(case: Case, panel: Panel) -> set[str]:
    """Marks of a case in a panel, keys of ``heat_map.HATCHES`` or ``RISE``."""
    peaks = [case[coating][order] for coating, order in panel.peaks]
    if None not in peaks and any(peak["deepest_wear"] < LEAST_WEAR for peak in peaks):
        return {NO_RUB}
    return marks_of(peaks)


def borders(values: NDArray[np.float64], level: float) -> list[list[tuple[float, float]]]:
    """Edges between neighbouring cells with values on either side of ``level``, without nan.

    Each edge is its two ends, in columns and rows of ``values``. Nothing is interpolated: no case
    was computed between two cells.
    """
    side = np.sign(values - level)
    horizontal_pairs = np.argwhere(side[:, :-1] * side[:, 1:] < 0)
    vertical_pairs = np.argwhere(side[:-1] * side[1:] < 0)
    upright = [[(x + 0.5, y - 0.5), (x + 0.5, y + 0.5)] for y, x in horizontal_pairs]
    return upright + [[(x - 0.5, y + 0.5), (x + 0.5, y + 0.5)] for y, x in vertical_pairs]
