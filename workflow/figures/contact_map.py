"""What the two quantities that the paper does not give decide: unit of E and casing amplitude."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator, NullLocator
from numpy.typing import NDArray

from geometry.files import read_json
from workflow.figures import style
from workflow.figures.grid import MAP, ink, is_sensitive, write
from workflow.figures.marks import NO_RESULT, NOT_PREDICTABLE
from workflow.paper.contact_map import TARGETS

GIGA = 1e9
NO_RUB = 1e-3  # gaps of deepest wear; with less there is no response to the casing
PAPER_SHIFT, _ = TARGETS["4"]  # of the k = 4 peak, E = 1, over the linear crossing
HATCHES = {  # of cells, and what they say
    "none": (NO_RESULT, "no run near a peak has a result"),
    "no rub": ("...", "no rub"),
    "sensitive": (NOT_PREDICTABLE, "not predictable"),
}
BOUND = "*"  # at a number taken where a sweep ends on the rise
HALO = [withStroke(linewidth=3.2, foreground="white")]

type Case = dict[str, Any]


@dataclass(frozen=True)
class ContactMap:
    """Cases over the unit of E (columns) and the casing amplitude (rows)."""

    unit_GPa: NDArray[np.float64]
    amplitude_gaps: NDArray[np.float64]
    cases: dict[tuple[int, int], Case]  # by column and row
    best: tuple[float, float]  # unit, GPa, and amplitude, gaps, nearest to the paper's shifts


@dataclass(frozen=True)
class Panel:
    """One map: its number, the peaks that this is of, and the level whose border is drawn."""

    title: str
    label: str  # of the colours
    number: Callable[[Case], float]
    digits: int  # after the point
    peaks: tuple[tuple[str, str], ...]  # coating and engine order
    level: float | None
    border: str | None  # what the level is


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
        f"(a): the paper's {PAPER_SHIFT}",
    ),
    Panel(
        "distance from the paper's two shifts",
        "of $k$ = 4 and 6, $E$ = 1\n(half digits of the paper's speeds)",
        lambda case: np.nan if case["miss"] is None else case["miss"],
        1,
        (("e1", "4"), ("e1", "6")),
        None,
        None,
    ),
    Panel(
        r"amplitude $\|Y\|$ of the peak $k$ = 4",
        "$E$ = 10 over $E$ = 1",
        _ratio("amplitude"),
        2,
        BOTH_COATINGS,
        1.0,
        "(c), (d): 1",
    ),
    Panel(
        "deepest wear at the peak $k$ = 4",
        "$E$ = 10 over $E$ = 1",
        _ratio("deepest_wear"),
        2,
        BOTH_COATINGS,
        1.0,
        None,
    ),
)


def load(files: Any) -> tuple[ContactMap]:
    """Read the cases, ``files.map``."""
    read = read_json(files.map)
    unit, gaps = read["unit_Pa"], read["scale"]
    cases = {(unit.index(c["unit_Pa"]), gaps.index(c["scale"])): c for c in read["cases"]}
    best = read["best"]["unit_Pa"] / GIGA, read["best"]["scale"]
    return (ContactMap(np.array(unit) / GIGA, np.array(gaps), cases, best),)


@style.styled
def draw(found: ContactMap) -> Figure:
    """Four maps over the same axes, the choice nearest to the paper ringed in all."""
    drawn = style.figure(style.DOUBLE, 5.6)
    grid = drawn.subplots(2, 2, sharex=True, sharey=True)
    marks = set()
    for axes, letter, panel in zip(grid.ravel(), "abcd", PANELS, strict=True):
        marks |= _panel(axes, found, panel)
        style.panel_letter(axes, letter)
        axes.set_title(panel.title, loc="right")
        look = {"color": style.BLACK, "markerfacecolor": "none", "markeredgewidth": 1.4}
        axes.plot(*found.best, "o", markersize=22, path_effects=HALO, zorder=4, **look)
    for axes in grid[1]:
        axes.set_xlabel("unit of $E$ (GPa)")
        axes.set_xticks(found.unit_GPa, [f"{unit:.3g}" for unit in found.unit_GPa])
        axes.xaxis.set_minor_locator(NullLocator())
    for axes in grid[:, 0]:
        axes.set_ylabel("casing amplitude (gaps)")
        axes.set_yticks(found.amplitude_gaps)
    _legend(drawn, marks)
    return drawn


def marks_of(case: Case, panel: Panel) -> set[str]:
    """What is to be said of a case's number: keys of ``HATCHES``, or ``BOUND``."""
    peaks = [case[coating][order] for coating, order in panel.peaks]
    if None in peaks:
        return {"none"}
    if any(peak["deepest_wear"] < NO_RUB for peak in peaks):
        return {"no rub"}
    bound = {BOUND} if any(peak["at_end"] for peak in peaks) else set()
    return bound | ({"sensitive"} if any(is_sensitive(peak) for peak in peaks) else set())


def numbers(found: ContactMap, panel: Panel) -> NDArray[np.float64]:
    """The panel's number, (amplitudes, units); nan where the case has none."""
    values = np.full((len(found.amplitude_gaps), len(found.unit_GPa)), np.nan)
    for (column, row), case in found.cases.items():
        if not marks_of(case, panel) & {"none", "no rub"}:
            values[row, column] = panel.number(case)
    return values


def borders(
    values: NDArray[np.float64], across: NDArray[np.float64], up: NDArray[np.float64], level: float
) -> NDArray[np.float64]:
    """Edges (n, 2 ends, 2) between neighbours on two sides of ``level``; nan has no side.

    ``across`` and ``up`` are the edges of columns and rows. No interpolation: between two cases
    nothing is known.
    """
    side = np.sign(values - level)
    found = []
    for row, column in np.argwhere(side[:, :-1] * side[:, 1:] < 0):
        x = across[column + 1]
        found.append([(x, up[row]), (x, up[row + 1])])
    for row, column in np.argwhere(side[:-1] * side[1:] < 0):
        y = up[row + 1]
        found.append([(across[column], y), (across[column + 1], y)])
    return np.reshape(found, (-1, 2, 2))


def _panel(axes: Axes, found: ContactMap, panel: Panel) -> set[str]:
    """Draw one map; returns the marks that are in it."""
    across, up = np.exp(style.edges(np.log(found.unit_GPa))), style.edges(found.amplitude_gaps)
    values = numbers(found, panel)
    mesh = axes.pcolormesh(across, up, np.ma.masked_invalid(values), cmap=MAP)
    ticks = MaxNLocator(5)
    axes.figure.colorbar(mesh, ax=axes, label=panel.label, pad=0.02, aspect=18, ticks=ticks)
    if panel.level is not None:
        lines = borders(values, across, up, panel.level)
        for colour, width in (("white", 3.2), (style.BLACK, 1.8)):
            look = {"color": colour, "linewidth": width, "capstyle": "projecting"}
            axes.add_collection(LineCollection(lines, **look))
    axes.set(xscale="log")
    seen = set()
    for (column, row), case in found.cases.items():
        marks = marks_of(case, panel)
        value = values[row, column]
        face = mesh.to_rgba(value)[:3] if np.isfinite(value) else to_rgb("white")
        _hatch(axes, across[column : column + 2], up[row : row + 2], marks, face)
        if np.isfinite(value):
            text = f"{value:.{panel.digits}f}{BOUND if BOUND in marks else ''}"
            at = found.unit_GPa[column], found.amplitude_gaps[row]
            write(axes, *at, text, face, fontsize=6.5)
        seen |= marks
    return seen


def _hatch(
    axes: Axes,
    across: NDArray[np.float64],
    up: NDArray[np.float64],
    marks: set[str],
    face: Any,
) -> None:
    """Hatch a cell of colour ``face`` between two edges of columns and two of rows."""
    edge = style.GREY if face == to_rgb("white") else ink(face)
    for mark in marks & HATCHES.keys():
        box = {"facecolor": "none", "edgecolor": edge, "linewidth": 0}
        axes.fill_between(across, *up, hatch=HATCHES[mark][0], **box)


def _legend(drawn: Figure, marks: set[str]) -> None:
    """Explain the ring, the borders, and the marks that are there."""
    ring = {"marker": "o", "markersize": 9, "markerfacecolor": "none", "linestyle": "none"}
    star = {"marker": r"$*$", "markersize": 5, "markeredgewidth": 0, "linestyle": "none"}
    border = "; ".join(panel.border for panel in PANELS if panel.border)
    black = {"color": style.BLACK}
    plain = {"facecolor": "white", "edgecolor": style.GREY, "linewidth": 0}
    handles = [
        Line2D([], [], **ring, **black, label="nearest to the paper's shifts"),
        Line2D([], [], linewidth=1.8, **black, label=border),
        *(
            Patch(hatch=hatch, label=label, **plain)
            for mark, (hatch, label) in HATCHES.items()
            if mark in marks
        ),
    ]
    if BOUND in marks:
        handles.append(Line2D([], [], **star, **black, label="a sweep ends on the rise"))
    sizes = {"handlelength": 2.4, "handleheight": 1.3}
    drawn.legend(handles=handles, loc="outside lower center", ncols=3, **sizes)
