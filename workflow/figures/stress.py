"""Von Mises stress on the deformed blade, when the tip exceeds its gap most."""

from collections.abc import Mapping
from math import floor, log10
from typing import Any

import numpy as np
import pyvista as pv
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from workflow.figures import style, views

SHOWN = 0.08  # bound of the largest displacement drawn, over the blade's largest dimension
LEVELS = 10  # of stress, few enough to read as contours
# Pressure side first: it faces the sense of rotation and downstream. Both from above the tip.
VIEWS = {"pressure side": (0.3, 1.0, 0.55), "suction side": (0.3, -1.0, -0.55)}
LIGHT = (1.0, 0.0)  # no shading: colours as in the colour bar
MEGA = 1e-6
END = 0.005  # of the height, the part that counts as tip or hub


@style.styled
def draw(fields: views.Fields, numbers: dict[str, Any]) -> Figure:
    """Both sides on one scale; ``fields`` is the blade of ``peak.vtu``."""
    stress, factor = MEGA * fields["von Mises (Pa)"], exaggeration(fields)
    levels = MaxNLocator(LEVELS).tick_values(0, stress.max())
    look = style.MAP.resampled(len(levels) - 1), (levels[0], levels[-1]), LIGHT
    moved = factor * fields["displacement (m)"]
    return views.gallery(
        fields,
        [(side, moved, stress, view) for side, view in VIEWS.items()],
        look,
        style.SINGLE,
        corners(fields.points),
        title(numbers),
        shrink=0.9,
        aspect=30,
        ticks=levels[::2],
        label="von Mises stress, averaged at nodes (MPa)\nin brackets: largest of single elements\n"
        f"displacement $\\times$ {factor:g}; outline: undeformed",
    )


def corners(points: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Leading and trailing edge at the tip, and the middle of the hub, by name."""
    x = points[:, 0]
    height = np.ptp(x)
    tip, hub = points[x > x.max() - END * height], points[x < x.min() + END * height]
    edges = {"LE": tip[tip[:, 2].argmin()], "TE": tip[tip[:, 2].argmax()]}
    return edges | {"tip": tip.mean(axis=0), "hub": hub.mean(axis=0)}


def exaggeration(blade: pv.UnstructuredGrid) -> float:
    """Factor on the displacement, of one digit, that keeps it within ``SHOWN``."""
    largest = np.linalg.norm(blade["displacement (m)"], axis=1).max()
    factor = SHOWN * max(blade.bounds_size) / largest
    digit = 10.0 ** floor(log10(factor))
    return floor(factor / digit) * digit


def title(numbers: dict[str, Any]) -> str:
    """Scene, speed, time, and the largest stress: the summary's, in total, of rotation alone."""
    total, static = (numbers[f"von_mises{of}"] for of in ("", "_of_prestress"))
    chance = ", sensitive run" if numbers["status"] == "sensitive" else ""
    away = total["settled"]
    lines = [
        f"scene {numbers['scene']}, blade {numbers['blade']}{chance}",
        f"{numbers['speed_rad_s'] * 30 / np.pi:.0f} rpm ({numbers['speed_over_f1']:.3f} $f_1(0)$), "
        f"after {numbers['time_rounds']:.2f} revolutions",
        *([f"away from clamp and contact {_averaged(away)} MPa"] if away else []),
        f"anywhere {_averaged(total)} MPa; of rotation alone {_averaged(static)} MPa",
    ]
    return "\n".join(lines)


def _averaged(stress: Mapping[str, float]) -> str:
    """Largest stress averaged at nodes, MPa, and that of a single element."""
    return f"{MEGA * stress['largest_Pa']:.0f} ({MEGA * stress['largest_of_cells_Pa']:.0f})"
