"""Figs. 11a, 11b: depth worn by the chord's leading eighth, around the casing, over the speed."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from simulate.observables import lobe_count
from workflow.figures import style
from workflow.figures.marks import hatch, mark_speeds
from workflow.figures.response import Response, read_response

DEEPEST = 0.01, 10.0  # gaps; one scale for all scenes, so that they compare
SHOWN = (
    97  # percentile of the depth where the map's scale ends: one deep speed must not hide the rest
)
LABEL = f"{style.WORN},\n{style.OVER_GAP}"


def load(files: Any) -> tuple[Response]:
    """Read the sweep, ``files.sweep``, and the reduced model, ``files.rom``."""
    return (read_response(files.sweep, files.rom),)


@style.styled
def draw(response: Response) -> Figure:
    """Map of depth over casing angle and speed; below, the deepest wear and the lobes."""
    drawn = style.figure(style.DOUBLE, 4.4)
    top, depth, lobes = drawn.subplots(3, 1, sharex=True, height_ratios=(3, 1, 1))
    drawn.colorbar(_map(top, response), ax=top, label=LABEL, extend="max", pad=0.01, aspect=25)
    _deepest(depth, response)
    _lobes(lobes, response)
    hatch(drawn, (top, depth, lobes), response, "wear")
    mark_speeds(top, response)
    top.set_xlim(0, style.edges(response.speeds)[-1])
    lobes.set_xlabel(style.SPEED_LABEL)
    drawn.suptitle(response.label, fontsize=8)
    return drawn


def _map(axes: Axes, response: Response) -> QuadMesh:
    speeds = style.edges(response.speeds)
    angles = np.linspace(0, 360, response.wear.shape[1] + 1)
    worn = response.wear[response.wear > 0]
    mesh = axes.pcolormesh(
        speeds,
        angles,
        response.wear.T,
        vmin=0,
        vmax=np.percentile(worn, SHOWN) if worn.size else 1,
        cmap=style.MAP_FROM_ZERO,
        rasterized=True,
    )
    axes.set(ylabel=r"casing angle $\theta$ (deg)", ylim=(0, 360), yticks=range(0, 361, 90))
    return mesh


def _deepest(axes: Axes, response: Response) -> None:
    deepest = np.where(response.has_result, response.wear.max(axis=1), np.nan)
    axes.plot(response.speeds, deepest, color=style.BLACK)
    axes.set(yscale="log", ylim=DEEPEST, ylabel=f"deepest\n{style.OVER_GAP}")
    axes.set_yticks([0.01, 0.1, 1, 10], ["0.01", "0.1", "1", "10"])


def _lobes(axes: Axes, response: Response) -> None:
    """Draw how many lobes are worn at each speed."""
    counts = [lobe_count(wear) for wear in response.wear[response.has_result]]
    axes.plot(response.speeds[response.has_result], counts, ".", color=style.BLACK, markersize=3)
    axes.set(ylabel="worn\nlobes", ylim=(0, max([6, *counts]) + 1))
    axes.yaxis.set_major_locator(MultipleLocator(2))
