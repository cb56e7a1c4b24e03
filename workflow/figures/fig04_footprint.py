"""Fig. 4: the rods of the leading strip under the tip, for a flat and a profiled tip."""

from typing import Any

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
LONGEST = 0.3  # of the panel's height, the longest arrow
NAMED = 0.12  # of the panel's width, room for a label at its side
SHAPE = 0.55  # height of a panel over its width, nearly
BEHIND = {"facecolor": "white", "linewidth": 0, "pad": 0.8}
DEPTH = {"offset": (4, 0), "va": "center", "bbox": BEHIND}  # label of a radial double arrow
FORCE = {
    "label": "force on blade",
    "marker": r"$\downarrow$",
    "linestyle": "",
    "markersize": 8,
    "color": style.BLACK,
}


def load(files: Any) -> tuple[Footprint, Footprint]:
    """Read the sweeps ``files.sweep``, ``files.tilted`` and the reduced model, ``files.rom``.

    Of the sweep with a tilted tip only the scene is read.
    """
    rom = Rom.load(files.rom)
    return at_deepest(files.sweep, rom), into_fresh(files.tilted, rom)


@style.styled
def draw(flat: Footprint, profiled: Footprint) -> Figure:
    """Flat tip over worn rods; profiled tip with the forces of the rods along its normals."""
    drawn, (upper, lower) = style.subplots(style.SINGLE, 5.0, 2, letters=True)
    _panel(upper, flat)
    _panel(lower, profiled)
    _name_depths(upper, flat)
    _name_profile(lower, profiled)
    upper.axhline(flat.rest, **AT_REST)
    upper.plot([], [], **FORCE)
    style.legend(drawn, "lower center", ncols=3, columnspacing=1.0)
    return drawn


def _panel(axes: Axes, shown: Footprint) -> None:
    """Draw rods, tip and forces: arc to scale, radial positions exaggerated."""
    low, high = _limits(shown)
    magnified = _magnified(shown, high - low)
    arc, width = MILLI * shown.s, MILLI * shown.pitch
    axes.bar(arc, shown.worn - shown.unworn, width, shown.unworn, **WORN_AWAY)
    axes.bar(arc, high - shown.end, width, shown.end, **ROD)
    begin, end = (MILLI * side for side in shown.covered)
    loaded = shown.sigma > 0
    axes.bar(
        begin[loaded],
        (high - shown.end)[loaded],
        (end - begin)[loaded],
        shown.end[loaded],
        align="edge",
        **ENGAGED,
    )
    along, surface = MILLI * shown.tip[0], shown.tip[1]
    axes.fill([*along, along[-1], along[0]], [*surface, low - 1, low - 1], **TIP)
    axes.plot(0, shown.middle, "o", markersize=4.5, zorder=5, **MIDDLE_MARK)
    axes.set(
        xlim=MILLI * np.array(_window(shown)),
        ylim=(low, high),
        aspect=magnified * shown.gap * MILLI,
        xlabel="arc $s$ from the tip's middle (mm)",
        ylabel=f"radius from undistorted\nliner, {style.OVER_GAP}",
    )
    axes.annotate("", (0.97, 0.08), (0.82, 0.08), xycoords="axes fraction", arrowprops=style.ARROW)
    axes.text(0.8, 0.08, r"$\Omega$", transform=axes.transAxes, ha="right", va="center")
    axes.set_title(f"radial scale $\\times$ {magnified:g}", loc="right", fontsize=7)
    _forces(axes, shown, magnified, high - low)


def _window(shown: Footprint) -> tuple[float, float]:
    """Arc shown, m: the footprint if all of it is loaded, else its loaded rods; and neighbours."""
    low, high = shown.tip[0, [0, -1]]
    loaded, covered = (np.flatnonzero(x > 0) for x in (shown.sigma, shown.part))
    if loaded.size < covered.size:
        low, high = shown.s[loaded[[0, -1]]] + shown.pitch / 2 * np.array([-1, 1])
    return low - BESIDE * shown.pitch, high + BESIDE * shown.pitch


def _limits(shown: Footprint) -> tuple[float, float]:
    """Radial positions shown: all surfaces, and room for the forces in the tip."""
    (first, last), (along, surface) = _window(shown), shown.tip
    tip = surface[(along >= first) & (along <= last)]
    low = min(shown.unworn.min(), tip.min(), shown.rest)
    high = max(shown.end.max(), shown.worn.max(), 0)
    return low - 0.35 * (high - low), high + 0.35 * (high - low)


def _magnified(shown: Footprint, height: float) -> float:
    """Factor on radial positions, of two digits, for a panel of the given shape."""
    factor = SHAPE * np.ptp(_window(shown)) / (height * shown.gap)
    return float(f"{factor:.2g}")


def _forces(axes: Axes, shown: Footprint, magnified: float, height: float) -> None:
    """Draw the force of each rod on the blade, along the normal of the drawn profile."""
    scale = magnified * shown.gap * MILLI  # mm drawn for a gap
    begin, end = shown.covered
    force = shown.part * shown.sigma
    steep = magnified * shown.slope
    length = LONGEST * height * scale * force / force.max() / np.hypot(1, steep)
    for i in np.flatnonzero(force > 0):
        at = (begin[i] + end[i]) / 2
        foot = (MILLI * at, np.interp(at, *shown.tip))
        head = (foot[0] - steep[i] * length[i], foot[1] - length[i] / scale)
        axes.annotate("", head, foot, arrowprops=style.ARROW)


def _name_depths(axes: Axes, shown: Footprint) -> None:
    """Label the worn depth and the elastic compression of the rods."""
    uncovered = int(np.flatnonzero(shown.part > 0)[0]) - 2
    at = MILLI * shown.s[uncovered]
    low, high = shown.unworn[uncovered], shown.worn[uncovered]
    style.measure(axes, (at, low), (at, high), "worn depth", **DEPTH)
    last = int(np.flatnonzero(shown.part > 0)[-1])
    at = MILLI * (shown.tip[0, -1] + 0.15 * shown.pitch)
    style.measure(axes, (at, shown.worn[last]), (at, shown.end[last]), "elastic", **DEPTH)
    depth = shown.thickness / shown.gap
    cut = f"rods cut off:\n$l$ = {depth:.0f} $g$"
    axes.text(0.02, 0.95, cut, transform=axes.transAxes, va="top", fontsize=7, bbox=BEHIND)


def _name_profile(axes: Axes, shown: Footprint) -> None:
    """Label p(s) near the lowest point of the profile."""
    (first, last), (along, surface) = _window(shown), shown.tip
    seen = (along >= first) & (along <= last)
    lowest = along[seen][surface[seen].argmin()]
    at_end = lowest == along[-1] < last  # the end of the tip is shown, with room next to it
    at = lowest + 0.2 * shown.pitch if at_end else lowest - NAMED * (last - first)
    ends = (MILLI * at, np.interp(at, along, surface)), (MILLI * at, surface[seen].max())
    style.measure(axes, *ends, "$p(s)$", **DEPTH)
