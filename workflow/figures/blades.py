"""Amplitude of each blade of a stage over the speed."""

import numpy as np
from matplotlib.figure import Figure

from simulate.signals import leading_gap
from workflow.figures import style, units
from workflow.figures.annotations import hatch, mark_speeds
from workflow.figures.response import Response

DECADES = 2  # of the scale of amplitudes
LINES = {"most": ("-", np.max), "median": ("--", np.median), "least": (":", np.min)}


@style.styled
def draw(sweep: Response) -> Figure:
    """Map of the largest amplitude along an engine order by blade and speed; below, its range.

    Rings: the worst blade of each speed.
    """
    drawn, (top, below) = style.subplots(style.DOUBLE, 3.8, 2, sharex=True, height_ratios=(3, 2))
    unit, _ = sweep.units["length"]
    along = sweep.sweep["blade_along"].max("order").values / leading_gap(sweep.sweep)
    of_blades, speeds = unit.scale * along, sweep.speeds  # nan without a result
    blades = np.arange(of_blades.shape[1] + 1)
    edges, cells = style.over_speeds(speeds, of_blades)
    scale = style.decades(np.nan_to_num(of_blades).max(), DECADES)
    label = f"amplitude\n{unit.label}"
    style.log_map(top, edges, blades - 0.5, cells.T, scale, label=label, extend="min", pad=0.01)
    worst = np.where(sweep.has_result, sweep.sweep["worst"].values, np.nan)
    top.plot(
        speeds, worst, "o", color=style.BLUE, markerfacecolor="none", markersize=3, label="worst"
    )
    top.legend(loc="upper left")
    top.set(ylabel="number of the blade")
    top.yaxis.get_major_locator().set_params(integer=True)
    for name, (dashes, of) in LINES.items():
        below.plot(speeds, of(of_blades, axis=1), dashes, color=style.BLACK, label=name)
    below.set(ylabel=label, ylim=(0, None))
    below.legend(loc="upper left")
    hatch(drawn, (top, below), sweep, "spectrum")
    top.set_xlim(style.limits(sweep.speeds))
    mark_speeds(top, sweep)
    units.show(below.xaxis, style.below, *sweep.units["speed"])
    drawn.suptitle(f"{sweep.names}: {of_blades.shape[1]} blades over one liner", fontsize=8)
    return drawn
