"""Von Mises stress on the deformed blade, at the largest displacement that a scene records."""

import json
from dataclasses import dataclass
from math import floor, log10
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from workflow.figures import style, views

SHOWN = 0.08  # of the blade's largest dimension: at most this is the largest displacement drawn
COLOURS: Colormap = style.MAP.resampled(10)  # few enough to read as contours
# Pressure side first: it faces the sense of rotation and downstream. Both from above the tip.
VIEWS = {"pressure side": (0.3, 1.0, 0.55), "suction side": (0.3, -1.0, -0.55)}
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
            numbers=json.loads(Path(files.numbers).read_text()),
        ),
    )


@style.styled
def draw(blade: Stressed) -> Figure:
    """Both sides, one scale."""
    limits = (0.0, MEGA * blade.von_mises.max())
    deformed = _skin(blade, blade.exaggeration)
    at_rest = _skin(blade, 0.0)
    pictures = views.crop(
        [views.picture(deformed, at_rest, COLOURS, limits, view) for view in VIEWS.values()]
    )
    height, width = pictures[0].shape[:2]
    drawn = style.figure(style.SINGLE, style.SINGLE / 2 * height / width + 1.1)
    all_axes = drawn.subplots(1, 2)
    for axes, image, side in zip(all_axes, pictures, VIEWS, strict=True):
        axes.imshow(image, interpolation="none")
        axes.set_axis_off()
        axes.set_title(side)
    drawn.suptitle(_title(blade), fontsize=8, linespacing=1.3)
    drawn.colorbar(
        ScalarMappable(Normalize(*limits), COLOURS),
        ax=list(all_axes),
        location="bottom",
        shrink=0.9,
        aspect=30,
        label=f"von Mises stress (MPa)\ndisplacement $\\times$ {blade.exaggeration:g}; "
        "outline: undeformed",
    )
    return drawn


def _title(blade: Stressed) -> str:
    numbers = blade.numbers
    return (
        f"$\\Omega/f_1(0)$ = {numbers['speed_over_f1']:.3f}, {numbers['time_rounds']:.2f} rounds: "
        f"largest {MEGA * numbers['von_mises']['largest_Pa']:.0f} MPa,\n"
        f"{MEGA * numbers['von_mises_of_prestress']['largest_Pa']:.0f} MPa of it "
        f"without vibration"
    )


def _skin(blade: Stressed, factor: float) -> pv.PolyData:
    points = blade.points + factor * blade.displacement
    return views.skin(points, blade.cells, MEGA * blade.von_mises)
