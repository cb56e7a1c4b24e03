"""Worn depth of the leading eighth of the chord: over casing angle and speed, and at peaks."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from simulate.errors.signals import leading_gap, lobe_count, maxima
from workflow.figures import style, units
from workflow.figures.marks import CASING_ANGLE, hatch, mark_speeds, over_casing, speed_text
from workflow.figures.response import Response
from workflow.paper.printed import CRITICAL, CROSSING, ENGINE_ORDER, LOBES

DECADES = 2  # of the scale of depths
LABEL = f"{style.WORN}\n"
LINES = (("-", style.BLACK), ("--", style.VERMILLION))  # E = 1, E = 10, dashed as in the paper
DEGREES = np.arange(-1, 362)  # one degree beyond 0 and 360: maxima may lie there


@style.styled
def over_speeds(sweep: Response, printed: str | None = None) -> Figure:
    """Map of depth over casing angle and speed; below, the deepest wear and the lobes.

    ``printed``: part of the paper whose lobes are marked, as of ``LOBES``.
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
    if printed:
        _printed(lobes, sweep, printed)
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


def _printed(axes: Axes, response: Response, part: str) -> None:
    """Square the lobes that the paper sees: at the ends of the sweep, at our peaks with k lobes.

    A pattern whose speed it prints stands there, unless a crossing goes with it.
    """
    off, orders = LOBES[part]
    speeds = {
        **{k: peak.Omega_c for k in orders if (peak := response.of_f1(k))},
        **{k: speed for k, speed in CRITICAL[part].items() if k not in CROSSING},
    }
    points = [
        *((speed, off) for speed in response.speeds[response.has_result][[0, -1]]),
        *((speeds[k], k) for k in orders if k in speeds),
    ]
    axes.plot(
        *zip(*points, strict=True),
        "s",
        label="lobes in the paper",
        clip_on=False,
        markersize=6,
        markerfacecolor="none",
        color=style.VERMILLION,
    )
    axes.legend(loc="lower right", bbox_to_anchor=(1, 1), handletextpad=0.2, borderaxespad=0.1)


@style.styled
def profiles(sweeps: Sequence[Response]) -> Figure:
    """Depth over the casing angle at the EO 4 peak, one line for each scene."""
    drawn, axes = style.subplots(style.SINGLE, 2.6)
    for response, (dashes, colour) in zip(sweeps, LINES, strict=True):
        _profile(axes, response, linestyle=dashes, color=colour)
    _nearest(axes, sweeps[0])
    first, second = sweeps[0].units["length"]
    axes.set(ylabel=LABEL + first.label, ylim=(0, None))
    style.beside(axes, second.scale / first.scale, f"worn depth {second.label}")
    drawn.legend(loc="outside upper center", ncols=1)
    return drawn


def _profile(axes: Axes, response: Response, **line: Any) -> None:
    """Draw the profile at the peak; without a peak, the legend says so."""
    peak = response.of_f1(ENGINE_ORDER)
    if peak is None:
        axes.plot([], [], label=f"{response.names}: no speed near the peak", **line)
        return
    chance = ", not predictable" if response.sensitive("wear")[peak.index] else ""
    over_casing(
        axes,
        response.units["length"][0].scale * response.wear[peak.index],
        label=f"{response.names}: {speed_text(response, peak)}{chance}",
        **line,
    )


def _nearest(axes: Axes, response: Response) -> None:
    """Mark the angles at which the casing is closest to the blade."""
    inward = response.scene.casing.inward(np.radians(DEGREES), leading_gap(response.sweep))
    nearest = DEGREES[maxima(inward)[0]]
    axes.vlines(
        nearest,
        0,
        1,
        transform=axes.get_xaxis_transform(),
        color=style.GREY,
        linestyle=":",
        linewidth=0.8,
        label="casing nearest",
    )
