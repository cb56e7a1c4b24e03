"""The grid of the paper's Table 1: moduli E and K of the liner, and what each case gives."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, to_rgb
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from geometry.files import read_json
from simulate.twin import SENSITIVE_FROM
from workflow.figures import style

GREY_WEIGHTS = (0.299, 0.587, 0.114)  # of red, green and blue in what the eye calls bright
MAP = ListedColormap(style.MAP(np.linspace(0, 0.75, 256)))  # none so dark that a hatch drowns
DARK = 0.5  # brightness of a cell below which its text is white


@dataclass(frozen=True)
class Grid:
    """Cases over E (columns) and K (rows), in the paper's unit."""

    E: list[float]
    K: list[float]
    orders: list[int]  # engine orders whose peaks are given
    cases: list[dict[str, Any]]

    @classmethod
    def read(cls, path: str | Path) -> Self:
        """The grid written as JSON."""
        read = read_json(path)
        return cls(read["E"], read["K"], read["orders"], read["cases"])

    def cells(self) -> Iterator[tuple[int, int, dict[str, Any]]]:
        """Column, row and case of each cell."""
        for case in self.cases:
            yield self.E.index(case["E"]), self.K.index(case["K"]), case

    def values(self, of: Callable[[dict[str, Any]], float | None]) -> NDArray[np.float64]:
        """``of`` each case, (K, E); nan where it gives None or there is no case."""
        values = np.full((len(self.K), len(self.E)), np.nan)
        for column, row, case in self.cells():
            value = of(case)
            values[row, column] = np.nan if value is None else value
        return values

    def peak_values(self, order: int, key: str) -> NDArray[np.float64]:
        """Number ``key`` of each case's peak along an engine order, (K, E); nan without one."""
        return self.values(lambda case: (case["peaks"][str(order)] or {}).get(key))


def is_sensitive(peak: dict[str, Any]) -> bool | None:
    """Whether the peak's spectrum cannot be predicted; None where no twin was marched.

    JSON knows no inf: a twin that ends otherwise than its run leaves but its status.
    """
    if peak["departure"] is None:
        return True if peak["status"] == "sensitive" else None
    return peak["departure"] > SENSITIVE_FROM


def axes_of(axes: Axes, grid: Grid) -> None:
    """Name columns and rows; thin white lines part the cells."""
    axes.set_xticks(range(len(grid.E)), [f"{value:g}" for value in grid.E])
    axes.set_yticks(range(len(grid.K)), [f"{value:g}" for value in grid.K])
    axes.set_xticks(np.arange(len(grid.E) + 1) - 0.5, minor=True)
    axes.set_yticks(np.arange(len(grid.K) + 1) - 0.5, minor=True)
    axes.grid(which="minor", color="white", linewidth=1.0)
    axes.tick_params(which="both", length=0)
    axes.set(xlabel="Young modulus $E$, paper's unit", ylabel="plastic modulus $K$")


def ink(face: Any) -> str:
    """Black or white, whichever is read on ``face``."""
    return "white" if np.dot(GREY_WEIGHTS, to_rgb(face)) < DARK else style.BLACK


def write(axes: Axes, column: float, row: float, text: str, face: Any, **look: Any) -> None:
    """Write into a cell of colour ``face``; a hatch keeps off the letters."""
    behind = {"facecolor": to_rgb(face), "edgecolor": "none", "pad": 1.0}
    axes.text(column, row, text, ha="center", va="center", color=ink(face), bbox=behind, **look)


def hatch_cell(axes: Axes, column: int, row: int, hatch: str, edge: str) -> None:
    """Hatch a cell, its colour staying."""
    axes.add_patch(
        Rectangle(
            (column - 0.5, row - 0.5), 1, 1, fill=False, hatch=hatch, edgecolor=edge, linewidth=0
        )
    )
