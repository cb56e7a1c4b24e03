"""Figs. 11a, 11b: worn depth under the chord's leading eighth, over casing angle and speed."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from simulate.errors.signals import lobe_count
from workflow.figures import style
from workflow.figures.marks import CASING_ANGLE, hatch, mark_speeds
from workflow.figures.response import Response
from workflow.paper.printed import CRITICAL, CROSSING, LOBES

DECADES = 2  # of the scale of depths
LABEL = f"{style.WORN},\n{style.OVER_GAP}"


@style.styled
def draw(sweep: Response, printed: str | None = None) -> Figure:
    """Map of depth over casing angle and speed; below, the deepest wear and the lobes.

    ``printed``: part of the paper whose lobes are marked, as of ``LOBES``.
    """
    drawn, panels = style.subplots(style.DOUBLE, 4.4, 3, sharex=True, height_ratios=(3, 1, 1))
    top, depth, lobes = panels
    scale = style.decades(sweep.wear.max(), DECADES)
    speeds, depths = style.over_speeds(sweep.speeds, sweep.wear)
    angles = np.linspace(0, 360, depths.shape[1] + 1)
    bar = {"label": LABEL, "extend": "min", "pad": 0.01, "aspect": 25}
    style.log_map(top, speeds, angles, depths.T, scale, **bar)
    top.set(ylabel=CASING_ANGLE, ylim=(0, 360), yticks=range(0, 361, 90))
    _below(depth, lobes, sweep)
    depth.set_ylim(scale)
    if printed:
        _printed(lobes, sweep, printed)
    hatch(drawn, panels, sweep, "wear")
    top.set_xlim(style.limits(sweep.speeds))
    mark_speeds(top, sweep)
    drawn.suptitle(sweep.title, fontsize=8)
    return drawn


def _below(depth: Axes, lobes: Axes, response: Response) -> None:
    """Draw the deepest wear and the number of worn lobes at each speed."""
    deepest = np.where(response.has_result, response.wear.max(axis=1), np.nan)
    depth.plot(response.speeds, deepest, color=style.BLACK)
    depth.set(yscale="log", ylabel=f"deepest\n{style.OVER_GAP}")
    counts = [lobe_count(wear) for wear in response.wear[response.has_result]]
    lobes.plot(response.speeds[response.has_result], counts, ".", color=style.BLACK, markersize=3)
    lobes.set(xlabel=style.SPEED_LABEL, ylabel="worn\nlobes", ylim=(0, max([6, *counts]) + 1))
    lobes.yaxis.set_major_locator(MultipleLocator(2))


def _printed(axes: Axes, response: Response, part: str) -> None:
    """Square the lobes that the paper sees: at the ends of the sweep, at our peaks with k lobes.

    A pattern whose speed it prints stands there, unless a crossing goes with it.
    """
    off, orders = LOBES[part]
    at = [(speed, off) for speed in response.speeds[response.has_result][[0, -1]]]
    speeds = {k: peak.Omega_c for k, peak in response.by_order.items()}
    speeds |= {k: speed for k, speed in CRITICAL[part].items() if k not in CROSSING}
    at += [(speeds[k], k) for k in orders if k in speeds]
    square = {"markersize": 6, "markerfacecolor": "none", "color": style.VERMILLION}
    axes.plot(*zip(*at, strict=True), "s", label="lobes in the paper", clip_on=False, **square)
    axes.legend(loc="upper center", ncols=2, handletextpad=0.2, borderaxespad=0.1)
