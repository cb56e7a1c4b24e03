"""Von Mises stress on the deformed blade, when the tip is farthest beyond its gap."""

from dataclasses import dataclass
from math import floor, log10
from typing import Any

import numpy as np
import pyvista as pv
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from geometry.files import read_json
from workflow.figures import style, views

SHOWN = 0.08  # of the blade's largest dimension: at most this is the largest displacement drawn
LEVELS = 10  # of stress, few enough to read as contours
# Pressure side first: it faces the sense of rotation and downstream. Both from above the tip.
VIEWS = {"pressure side": (0.3, 1.0, 0.55), "suction side": (0.3, -1.0, -0.55)}
LIGHT = (1.0, 0.0)  # colours as in the bar: they are read as numbers
MEGA = 1e-6


@dataclass(frozen=True)
class Stressed:
    """The blade at one time."""

    points: NDArray[np.float64]  # (nodes, 3), m
    cells: NDArray[np.int64]  # (cells, 10), ten-node tetrahedra in VTK's order
    displacement: NDArray[np.float64]  # (nodes, 3), m
    von_mises: NDArray[np.float64]  # (nodes,), Pa
    numbers: dict[str, Any]  # of peak.json

    @property
    def exaggeration(self) -> float:
        """Factor on the displacement, of one digit, that keeps it within ``SHOWN``."""
        largest = np.linalg.norm(self.displacement, axis=1).max()
        factor = SHOWN * np.ptp(self.points, axis=0).max() / largest
        digit = 10.0 ** floor(log10(factor))
        return floor(factor / digit) * digit


def load(files: Any) -> tuple[Stressed]:
    """Read ``files.fields``, ``peak.vtu``, and ``files.numbers``, ``peak.json``."""
    grid = pv.read(files.fields)
    return (
        Stressed(
            points=np.asarray(grid.points),
            cells=grid.cells_dict[pv.CellType.QUADRATIC_TETRA],
            displacement=np.asarray(grid["displacement"]),
            von_mises=np.asarray(grid["von Mises"]),
            numbers=read_json(files.numbers),
        ),
    )


@style.styled
def draw(blade: Stressed) -> Figure:
    """Both sides, one scale."""
    levels = MaxNLocator(LEVELS).tick_values(0, MEGA * blade.von_mises.max())
    colours, limits = style.MAP.resampled(len(levels) - 1), (levels[0], levels[-1])
    deformed, at_rest = _skin(blade, blade.exaggeration), _skin(blade, 0.0)
    pictures = [
        views.picture(deformed, at_rest, colours, limits, view, LIGHT) for view in VIEWS.values()
    ]
    drawn = style.gallery(
        views.crop(pictures),
        list(VIEWS),
        style.SINGLE,
        mappable=ScalarMappable(Normalize(*limits), colours),
        shrink=0.9,
        aspect=30,
        ticks=levels[::2],
        label=f"von Mises stress (MPa)\ndisplacement $\\times$ {blade.exaggeration:g}; "
        "outline: undeformed",
    )
    drawn.suptitle(title(blade), fontsize=8, linespacing=1.3)
    return drawn


def title(blade: Stressed) -> str:
    """Speed, time, and the largest stress; that of rotation alone."""
    numbers = blade.numbers
    total, static = (numbers[f"von_mises{of}"]["largest_Pa"] for of in ("", "_of_prestress"))
    chance = ", sensitive run" if numbers["status"] == "sensitive" else ""
    return (
        f"$\\Omega/f_1(0)$ = {numbers['speed_over_f1']:.3f}, after {numbers['time_rounds']:.2f} "
        f"rounds{chance}\nlargest {MEGA * total:.0f} MPa; of rotation alone {MEGA * static:.0f} MPa"
    )


def _skin(blade: Stressed, factor: float) -> pv.PolyData:
    points = blade.points + factor * blade.displacement
    return views.skin(points, blade.cells, MEGA * blade.von_mises)
