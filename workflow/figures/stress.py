"""Alternating stress on the blade at its worst speed, with the summary's number at its place."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pyvista as pv
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from fem.fatigue import MEGA
from workflow import stress_told
from workflow.figures import rendering, style

LEVELS = 10  # of stress, few enough to read as contours
# Pressure side first: it faces the sense of rotation and downstream. Both from above the tip.
VIEWS = {"pressure side": (0.3, 1.0, 0.55), "suction side": (0.3, -1.0, -0.55)}
LIGHT = (1.0, 0.0)  # no shading: colours as in the colour bar
END = 0.005  # of the height, the part that counts as hub
FIELD = "alternating stress (Pa), "  # and the speed: a name in ``stress.vtu``


@style.styled
def draw(fields: rendering.Fields, stress: Mapping[str, Any]) -> Figure:
    """Both sides on one scale; ``fields`` is the blade of ``stress.vtu``, ``stress`` its names."""
    row = next((r for r in stress["speeds"] if r["speed_over_f1"] == stress["worst"]), None)
    heading, sigma, marked = "no motion with a result", np.zeros(fields.n_points), {}
    if row:
        rpm = f"{row['rpm']:.0f} rpm"
        sigma, place = fields[FIELD + rpm] / MEGA, np.array(row["at_m"])
        number = f"{stress_told.shown(row, 'alternating')} MPa"
        heading = f"{rpm}, worst of the speeds: {number}\n(anywhere {sigma.max():.3g} MPa)"
        marked = {number: place}
    levels = MaxNLocator(LEVELS).tick_values(0, max(sigma.max(), 1.0))
    look = style.MAP.resampled(len(levels) - 1), (levels[0], levels[-1]), LIGHT
    still = np.zeros_like(fields.points)
    return rendering.gallery(
        fields,
        [(side, still, sigma, view) for side, view in VIEWS.items()],
        look,
        style.SINGLE,
        corners(fields.points, stress["edges"]),
        f"scene {stress['scene']}, blade {stress['blade']}\n{heading}",
        marked={seen_from(fields, *marked.values()): marked} if marked else {},
        shrink=0.9,
        aspect=30,
        ticks=levels[::2],
        label="alternating stress, averaged at nodes (MPa)",
    )


def corners(
    points: NDArray[np.float64], edges: Mapping[str, NDArray[np.float64]]
) -> dict[str, NDArray[np.float64]]:
    """The ``edges`` of the tip, the middle of tip and hub, by name."""
    radius = np.hypot(points[:, 0], points[:, 1])
    hub = points[radius < radius.min() + END * np.ptp(radius)]
    at = {name: np.array(edge) for name, edge in edges.items()}
    return at | {"tip": np.mean([*at.values()], axis=0), "hub": hub.mean(axis=0)}


def seen_from(fields: pv.DataSet, place: NDArray[np.float64]) -> str:
    """The side from which a ``place`` (3,), m, on the surface is seen."""
    skin = fields.extract_surface(algorithm="dataset_surface").compute_normals()
    normal = skin.point_data["Normals"][skin.find_closest_point(place)]
    return max(VIEWS, key=lambda side: normal @ np.array(VIEWS[side]))
