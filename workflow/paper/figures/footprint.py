"""Fig. 4: the rods of the leading strip under the tip, for a flat and a profiled tip.

The contact law is that of the model.
"""

from math import ceil
from typing import NamedTuple

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.optimize import brentq

from simulate.contact.strips import Strips, profile_at
from simulate.marching import prepare
from simulate.signals import leading_gap
from workflow.figures import style
from workflow.figures.response import Response
from workflow.paper.published import ENGINE_ORDER

STRIP = 0  # the leading one
BESIDE = 2  # rods shown on either side of those that are loaded
MILLI = 1e3
ENGAGED = {"facecolor": "#F0B98F", "edgecolor": style.BLACK, "hatch": "/////", "linewidth": 0.5}
WORN_AWAY = {"facecolor": "white", "edgecolor": style.GREY, "hatch": ".....", "linewidth": 0}
BEHIND = {"facecolor": "white", "linewidth": 0, "pad": 0.8}
DEPTH = {"offset": (4, 0), "va": "center", "bbox": BEHIND}  # label of a radial double arrow


class FootprintError(ValueError):
    """A sweep without a footprint to show; the message names the missing part."""


class Footprint(NamedTuple):
    """Loaded rods of a strip, and ``BESIDE`` more on either side; radial positions over gap g.

    0 is the surface of the undistorted, unworn liner; outward, towards the casing, is positive. The
    columns of ``rods`` are s (m), the arc from the tip's middle in the sense of rotation; begin and
    finish (m) of the part that the tip covers, and how much of the rod that is, part; unworn, the
    unworn surface, displaced inward by the casing; worn, that of the worn, unloaded rod; end, that
    under the tip; sigma (Pa), the stress; slope, p'(s).
    """

    rods: pd.DataFrame
    tip: NDArray[np.float64]  # (2, 201): arc, m, over the length shown; position
    pitch: float  # m, arc from rod to rod
    gap: float  # g, m
    rest: float  # position of the tip's middle, undeformed
    thickness: float  # m, of the liner


def at_deepest(of: Response) -> Footprint:
    """The tip at its largest penetration where the liner of the strip is worn most, at EO 4.

    Raises
    ------
    FootprintError
        When the sweep has no speed near the EO 4 peak, or the liner is not worn there.
    """
    runs, peak = of.sweep, of.of_f1(ENGINE_ORDER)
    if peak is None or "wear" not in runs or not runs["wear"][peak.index, STRIP].max() > 0:
        raise FootprintError(
            f"{of.names}: no worn liner at a k = {ENGINE_ORDER} peak: run a sweep over that peak "
            "with record.wear: true"
        )
    strips = prepare(of.scene, of.rom, float(runs["speed"][peak.index])).strips
    law, eps_p = strips.law, runs["wear"][peak.index, STRIP].values / strips.thickness
    deepest, worst = int(eps_p.argmax()), float(eps_p.max())
    # the largest strain of a rod with that plastic strain
    strain = brentq(lambda eps: law.stress(law.parameters, eps, 0.0)[1] - worst, worst, 1.0)
    return footprint(
        strips,
        leading_gap(runs),
        strips.d,
        eps_p,
        deepest,
        u_r=strips.g0[STRIP] - strips.d[deepest] + strain * strips.thickness,
    )


def into_fresh(of: Response) -> Footprint:
    """The profiled tip of a sweep's scene pressed into an unworn liner without distortion.

    By 1.25 times the depth of its profile, but by the gap at most, as in a run: of a steep tip only
    one end is in contact. A reduced model with radial interface DoFs is sufficient.

    Raises
    ------
    FootprintError
        When the tip of the scene is flat.
    """
    if of.scene.contact.profile is None:
        raise FootprintError(f"{of.names}: its tip is flat: use a scene with contact.profile")
    scene = of.scene.but(contact__tangential=False)  # no tangential DoFs are needed
    strips = prepare(scene, of.rom, float(of.sweep["speed"][0])).strips
    half, gap = strips.tip.half[STRIP], leading_gap(of.sweep)
    depth = max(profile_at(strips.tip, STRIP, s)[0] for s in (-half, half))
    fresh = np.zeros(strips.d.size)
    return footprint(strips, gap, fresh, fresh, 0, strips.g0[STRIP] + min(1.25 * depth, gap))


def footprint(
    strips: Strips,
    gap: float,
    d: NDArray[np.float64],
    eps_p: NDArray[np.float64],
    rod: int,
    u_r: float,
) -> Footprint:
    """Press the tip to ``u_r`` (m), its middle at the rod with the number ``rod``.

    ``gap`` is g, m, ``d`` (nu,) the distortion, m, ``eps_p`` (nu,) the plastic strains.
    """
    g0, l, law, pitch = strips.g0[STRIP], strips.thickness, strips.law, strips.pitch[STRIP]
    half = strips.length[STRIP] * pitch / 2
    reach = ceil(half / pitch) + BESIDE
    k = np.arange(-reach, reach + 1)
    shown = (rod + k) % d.size
    begin, finish = (np.clip(pitch * (k + side), -half, half) for side in (-0.5, 0.5))
    p, slope = np.array([profile_at(strips.tip, STRIP, s) for s in (begin + finish) / 2]).T
    delta = np.where(finish > begin, u_r - p + d[shown] - g0, 0.0).clip(0.0)
    sigma = np.array(
        [
            law.stress(law.parameters, eps, plastic)[0]
            for eps, plastic in zip(delta / l, eps_p[shown], strict=True)
        ]
    )
    unworn = -d[shown] / gap
    worn = unworn + l * eps_p[shown] / gap
    first, *_, last = np.flatnonzero(sigma)
    rods = pd.DataFrame(
        {
            "s": pitch * k,
            "begin": begin,
            "finish": finish,
            "part": (finish - begin) / pitch,
            "unworn": unworn,
            "worn": worn,
            "end": np.maximum(worn, unworn + delta / gap),
            "sigma": sigma,
            "slope": slope,
        }
    )[first - BESIDE : last + BESIDE + 1].reset_index(drop=True)
    ends = np.clip(rods.s.iloc[[0, -1]] + [-pitch / 2, pitch / 2], -half, half)
    along = np.linspace(*ends, 201)
    surface = [(u_r - g0 - profile_at(strips.tip, STRIP, s)[0]) / gap for s in along]
    return Footprint(rods, np.array([along, surface]), float(pitch), gap, float(-g0 / gap), l)


@style.styled
def draw(sweep: Response, tilted: Response) -> Figure:
    """Flat tip over worn rods; profiled tip with the forces of the rods along its normals."""
    flat, profiled = at_deepest(sweep), into_fresh(tilted)
    drawn, (upper, lower) = style.subplots(style.SINGLE, 5.0, 2, letters=True)
    _panel(upper, flat)
    _panel(lower, profiled)
    _name_depths(upper, flat)
    _name_profile(lower, profiled)
    upper.axhline(
        flat.rest, label="tip, undeformed", color=style.BLUE, linestyle="-.", linewidth=0.9
    )
    upper.plot([], [], "k", marker=r"$\downarrow$", ls="", markersize=8, label="force on blade")
    style.legend(drawn, "lower center", ncols=3, columnspacing=1.0)
    return drawn


def _panel(axes: Axes, shown: Footprint) -> None:
    """Draw rods, tip and forces: arc to scale, radial positions exaggerated."""
    rods, (along, surface) = shown.rods, shown.tip
    arc, width = MILLI * rods.s, MILLI * shown.pitch
    first, last = arc.iloc[0] - width / 2, arc.iloc[-1] + width / 2
    low = min(rods.unworn.min(), surface.min(), shown.rest)
    high = max(rods.end.max(), 0)
    room = 0.35 * (high - low)  # for the forces
    low, high = low - room, high + room
    # such that the panel is nearly 0.55 times as high as wide
    magnified = float(f"{0.55 * (last - first) / ((high - low) * MILLI * shown.gap):.2g}")
    axes.bar(arc, rods.worn - rods.unworn, width, rods.unworn, label="worn away", **WORN_AWAY)
    axes.bar(
        arc,
        high - rods.end,
        width,
        rods.end,
        label="rod",
        facecolor="#E4E4E4",
        edgecolor=style.GREY,
        linewidth=0.5,
    )
    load = rods[rods.sigma > 0]
    axes.bar(
        MILLI * load.begin,
        high - load.end,
        MILLI * (load.finish - load.begin),
        load.end,
        align="edge",
        label="loaded part of rod",
        **ENGAGED,
    )
    axes.fill(
        MILLI * np.array([*along, along[-1], along[0]]),
        [*surface, low - 1, low - 1],
        label="blade tip",
        facecolor="#A8A8A8",
        edgecolor=style.BLACK,
        linewidth=1.0,
    )
    axes.plot(
        0,
        np.interp(0, along, surface),
        "o",
        markersize=4.5,
        zorder=5,
        color=style.VERMILLION,
        markeredgecolor=style.BLACK,
        markeredgewidth=0.5,
    )
    axes.set(
        xlim=(first, last),
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
    # forces: normal to the profile as drawn, the longest 0.3 of the panel's height
    axes.quiver(
        MILLI * middle,
        np.interp(middle, along, surface),
        -steep * force,
        -force,
        color=style.BLACK,
        scale=1 / 0.3,
        scale_units="height",
        width=0.008,
        zorder=6,
    )


def _name_depths(axes: Axes, shown: Footprint) -> None:
    """Label the worn depth and the elastic compression of the rods."""
    covered = np.flatnonzero(shown.rods.part)
    before, last = shown.rods.iloc[covered[0] - 2], shown.rods.iloc[covered[-1]]
    worn, elastic = MILLI * before.s, MILLI * (shown.tip[0, -1] + 0.15 * shown.pitch)
    style.measure(axes, (worn, before.unworn), (worn, before.worn), "worn depth", **DEPTH)
    style.measure(axes, (elastic, last.worn), (elastic, last.end), "elastic", **DEPTH)
    axes.text(
        0.02,
        0.95,
        f"rods cut off:\n$l$ = {shown.thickness / shown.gap:.0f} $g$",
        transform=axes.transAxes,
        va="top",
        fontsize=7,
        bbox=BEHIND,
    )


def _name_profile(axes: Axes, shown: Footprint) -> None:
    """Label p(s) near the lowest point of the profile, towards the middle."""
    along, surface = shown.tip
    x = (along[surface.argmin()] + along.mean()) / 2
    on_tip, top = np.interp(x, along, surface), surface.max()
    style.measure(axes, (MILLI * x, on_tip), (MILLI * x, top), "$p(s)$", **DEPTH)
