"""Fig. 4: the rods of the leading strip under the tip, for a flat and a profiled tip."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rom.model import Rom
from workflow.figures import style
from workflow.paper.footprint import BESIDE, Footprint, at_deepest, into_fresh

MILLI = 1e3
ROD = {"label": "rod", "facecolor": "#E4E4E4", "edgecolor": style.GREY, "linewidth": 0.5}
ENGAGED = {
    "label": "loaded part of rod",
    "facecolor": "#F0B98F",
    "edgecolor": style.BLACK,
    "hatch": "/////",
    "linewidth": 0.5,
}
WORN_AWAY = {
    "label": "worn away",
    "facecolor": "white",
    "edgecolor": style.GREY,
    "hatch": ".....",
    "linewidth": 0,
}
TIP = {"label": "blade tip", "facecolor": "#A8A8A8", "edgecolor": style.BLACK, "linewidth": 1.0}
AT_REST = {"label": "tip, undeformed", "color": style.BLUE, "linestyle": "-.", "linewidth": 0.9}
MIDDLE_MARK = {"color": style.VERMILLION, "markeredgecolor": style.BLACK, "markeredgewidth": 0.5}
FORCE = {"color": style.BLACK, "label": "force on blade"}
LONGEST = 0.3  # of the panel's height, the longest arrow
ARROWS = {"scale": 1 / LONGEST, "scale_units": "height", "width": 0.008, "zorder": 6}
NAMED = 0.12  # of the panel's width, from the lowest point of the tip to the name of its profile
SHAPE = 0.55  # height of a panel over its width, nearly
ROOM = 0.35  # of the extent, above and below: for the forces
BEHIND = {"facecolor": "white", "linewidth": 0, "pad": 0.8}
DEPTH = {"offset": (4, 0), "va": "center", "bbox": BEHIND}  # label of a radial double arrow


@style.styled
def draw(sweep: str, tilted: str, rom: Rom) -> Figure:
    """Flat tip over worn rods; profiled tip with the forces of the rods along its normals.

    ``sweep`` and ``tilted``: paths of sweeps; of that with a tilted tip only the scene is read.
    """
    flat, profiled = at_deepest(sweep, rom), into_fresh(tilted, rom)
    drawn, (upper, lower) = style.subplots(style.SINGLE, 5.0, 2, letters=True)
    _panel(upper, flat)
    _panel(lower, profiled)
    _name_depths(upper, flat)
    _name_profile(lower, profiled)
    upper.axhline(flat.rest, **AT_REST)
    upper.plot([], [], marker=r"$\downarrow$", linestyle="", markersize=8, **FORCE)
    style.legend(drawn, "lower center", ncols=3, columnspacing=1.0)
    return drawn


def _panel(axes: Axes, shown: Footprint) -> None:
    """Draw rods, tip and forces: arc to scale, radial positions exaggerated."""
    rods, (along, surface) = shown.rods, shown.tip
    first, last = _window(shown)
    drawn = surface[(along >= first) & (along <= last)]
    low = min(rods.unworn.min(), drawn.min(), shown.rest)
    high = max(rods.end.max(), rods.worn.max(), 0)
    low, high = low - ROOM * (high - low), high + ROOM * (high - low)
    magnified = float(f"{SHAPE * (last - first) / ((high - low) * shown.gap):.2g}")
    arc, width = MILLI * rods.s, MILLI * shown.pitch
    axes.bar(arc, rods.worn - rods.unworn, width, rods.unworn, **WORN_AWAY)
    axes.bar(arc, high - rods.end, width, rods.end, **ROD)
    load = rods[rods.sigma > 0]
    axes.bar(
        MILLI * load.begin,
        high - load.end,
        MILLI * (load.finish - load.begin),
        load.end,
        align="edge",
        **ENGAGED,
    )
    outline = [*along, along[-1], along[0]], [*surface, low - 1, low - 1]
    axes.fill(np.multiply(MILLI, outline[0]), outline[1], **TIP)
    axes.plot(0, np.interp(0, along, surface), "o", markersize=4.5, zorder=5, **MIDDLE_MARK)
    axes.set(
        xlim=(MILLI * first, MILLI * last),
        ylim=(low, high),
        aspect=magnified * shown.gap * MILLI,
        xlabel="arc $s$ from the tip's middle (mm)",
        ylabel=f"radius from undistorted\nliner, {style.OVER_GAP}",
    )
    axes.annotate("", (0.97, 0.08), (0.82, 0.08), xycoords="axes fraction", arrowprops=style.ARROW)
    axes.text(0.8, 0.08, r"$\Omega$", transform=axes.transAxes, ha="right", va="center")
    axes.set_title(f"radial scale $\\times$ {magnified:g}", loc="right", fontsize=7)
    middle, steep = (load.begin + load.finish) / 2, magnified * load.slope
    force = load.part * load.sigma / (load.part * load.sigma).max() / np.hypot(1, steep)
    # forces: normal to the profile as drawn
    axes.quiver(
        MILLI * middle,
        np.interp(middle, along, surface),
        -steep * force,
        -force,
        color=style.BLACK,
        **ARROWS,
    )


def _window(shown: Footprint) -> tuple[float, float]:
    """Arc shown, m: the loaded rods, and neighbours."""
    loaded = shown.rods[shown.rods.sigma > 0]
    margin = BESIDE * shown.pitch
    return loaded.begin.min() - margin, loaded.finish.max() + margin


def _name_depths(axes: Axes, shown: Footprint) -> None:
    """Label the worn depth and the elastic compression of the rods."""
    covered = np.flatnonzero(shown.rods.part > 0)
    before, last = shown.rods.iloc[covered[0] - 2], shown.rods.iloc[covered[-1]]
    x = MILLI * before.s
    style.measure(axes, (x, before.unworn), (x, before.worn), "worn depth", **DEPTH)
    x = MILLI * (shown.tip[0, -1] + 0.15 * shown.pitch)
    style.measure(axes, (x, last.worn), (x, last.end), "elastic", **DEPTH)
    cut = f"rods cut off:\n$l$ = {shown.thickness / shown.gap:.0f} $g$"
    axes.text(0.02, 0.95, cut, transform=axes.transAxes, va="top", fontsize=7, bbox=BEHIND)


def _name_profile(axes: Axes, shown: Footprint) -> None:
    """Label p(s) near the lowest point of the profile, towards the middle."""
    (first, last), (along, surface) = _window(shown), shown.tip
    seen = (along >= first) & (along <= last)
    lowest = along[seen][surface[seen].argmin()]
    x = lowest + np.sign(first + last - 2 * lowest) * NAMED * (last - first)
    style.measure(
        axes,
        (MILLI * x, np.interp(x, along, surface)),
        (MILLI * x, surface[seen].max()),
        "$p(s)$",
        **DEPTH,
    )
