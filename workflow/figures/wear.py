"""Worn depth of the leading eighth of the chord over casing angle and speed."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from simulate.signals import lobe_count
from workflow.figures import style, units
from workflow.figures.annotations import CASING_ANGLE, NO_MARKS, Marks, hatch, mark_speeds
from workflow.figures.response import Response

DECADES = 2  # of the scale of depths
LABEL = f"{style.WORN}\n"


@style.styled
def over_speeds(sweep: Response, marks: Marks = NO_MARKS) -> Figure:
    """Map of depth over casing angle and speed; below, the deepest wear and the lobes.

    ``marks``: numbers of lobes of another source.
    """
    drawn, panels = style.subplots(style.DOUBLE, 4.4, 3, sharex=True, height_ratios=(3, 1, 1))
    top, depth, lobes = panels
    unit, _ = sweep.units["length"]
    worn = unit.scale * sweep.wear
    scale = style.decades(worn.max(), DECADES)
    speeds, depths = style.over_speeds(sweep.speeds, worn)
    angles = np.linspace(0, 360, depths.shape[1] + 1)
    style.log_map(
        top,
        speeds,
        angles,
        depths.T,
        scale,
        label=LABEL + unit.label,
        extend="min",
        pad=0.01,
        aspect=25,
    )
    top.set(ylabel=CASING_ANGLE, ylim=(0, 360), yticks=range(0, 361, 90))
    _below(depth, lobes, sweep)
    depth.set_ylim(scale)
    if marks.spans:
        low, high, numbers = np.array(marks.spans).T
        lobes.plot(
            (low + high) / 2,
            numbers,
            "s",
            label=marks.label,
            clip_on=False,
            markersize=6,
            markerfacecolor="none",
            color=style.VERMILLION,
        )
        lobes.legend(loc="lower right", bbox_to_anchor=(1, 1), handletextpad=0.2, borderaxespad=0.1)
    hatch(drawn, panels, sweep, "wear")
    top.set_xlim(style.limits(sweep.speeds))
    mark_speeds(top, sweep)
    units.show(lobes.xaxis, style.below, *sweep.units["speed"])
    drawn.suptitle(sweep.title, fontsize=8)
    return drawn


def _below(depth: Axes, lobes: Axes, response: Response) -> None:
    """Draw the deepest wear and the number of worn lobes at each speed."""
    unit, _ = response.units["length"]
    deepest = np.where(response.has_result, unit.scale * response.wear.max(axis=1), np.nan)
    depth.plot(response.speeds, deepest, color=style.BLACK)
    depth.set(yscale="log", ylabel=f"deepest\n{unit.label}")
    counts = [lobe_count(wear) for wear in response.wear[response.has_result]]
    lobes.plot(response.speeds[response.has_result], counts, ".", color=style.BLACK, markersize=3)
    lobes.set(ylabel="worn\nlobes", ylim=(0, max([6, *counts]) + 1))
    lobes.yaxis.set_major_locator(MultipleLocator(2))
