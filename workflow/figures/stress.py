"""Alternating stress on the blade, of the reported run where it is largest."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from fem.fatigue import MEGA
from workflow.figures import style, views

LEVELS = 10  # of stress, few enough to read as contours
# Pressure side first: it faces the sense of rotation and downstream. Both from above the tip.
VIEWS = {"pressure side": (0.3, 1.0, 0.55), "suction side": (0.3, -1.0, -0.55)}
LIGHT = (1.0, 0.0)  # no shading: colours as in the colour bar
END = 0.005  # of the height, the part that counts as tip or hub
FIELD = "alternating stress (Pa), "  # and the speed: a name in ``stress.vtu``


@style.styled
def draw(fields: views.Fields, stress: Mapping[str, Any]) -> Figure:
    """Both sides on one scale; ``fields`` is the blade of ``stress.vtu``, ``stress`` its names."""
    away = fields["away from clamp and contact"] > 0
    stresses = {name: fields[name] / MEGA for name in fields.point_data if name.startswith(FIELD)}
    name, sigma = max(
        stresses.items(), key=lambda item: item[1][away].max(), default=("", np.zeros(len(away)))
    )
    levels = MaxNLocator(LEVELS).tick_values(0, max(sigma.max(), 1.0))
    look = style.MAP.resampled(len(levels) - 1), (levels[0], levels[-1]), LIGHT
    still = np.zeros_like(fields.points)
    return views.gallery(
        fields,
        [(side, still, sigma, view) for side, view in VIEWS.items()],
        look,
        style.SINGLE,
        corners(fields.points),
        f"scene {stress['scene']}, blade {stress['blade']}, {name.removeprefix(FIELD)}\n"
        f"away from clamp and contact {sigma[away].max():.1f} MPa, anywhere {sigma.max():.1f} MPa"
        if stresses
        else f"scene {stress['scene']}, blade {stress['blade']}\nnot known at its peaks: they grow",
        shrink=0.9,
        aspect=30,
        ticks=levels[::2],
        label="alternating stress, averaged at nodes (MPa)",
    )


def corners(points: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Leading and trailing edge at the tip, and the middle of the hub, by name."""
    x = points[:, 0]
    height = np.ptp(x)
    tip, hub = points[x > x.max() - END * height], points[x < x.min() + END * height]
    edges = {"LE": tip[tip[:, 2].argmin()], "TE": tip[tip[:, 2].argmax()]}
    return edges | {"tip": tip.mean(axis=0), "hub": hub.mean(axis=0)}
