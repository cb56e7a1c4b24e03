"""Fig. 4: the rods of the foremost strip under the tip, flat tip and profiled tip."""

from dataclasses import dataclass
from math import floor
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray
from scipy.optimize import brentq

from rom.model import Rom
from simulate.contact import Strips, covered_middle, covered_part, offset, profile_at
from simulate.dataset import load as load_sweep
from simulate.dataset import scene_of
from simulate.law import Law
from simulate.observables import leading_gap
from simulate.run import prepare
from simulate.scene import LEADING, Scene
from workflow.figures import style
from workflow.figures.response import read_response

ENGINE_ORDER = 4
STRIP = 0  # the foremost
BESIDE = 3  # rods shown on either side of the footprint
PRESSED = 1.25  # of the profile's depth: how far the profiled tip goes into a fresh liner,
DEEPEST = 1.0  # gaps, and no farther than in a run: of a steep tip an end alone bears
OUTLINE = 201  # points of the tip's profile
MILLI = 1e3
ROD = {"facecolor": "#E4E4E4", "edgecolor": style.GREY, "linewidth": 0.5}
ENGAGED = {"facecolor": "#F0B98F", "edgecolor": style.BLACK, "hatch": "/////", "linewidth": 0.5}
GONE = {"facecolor": "white", "edgecolor": style.GREY, "hatch": ".....", "linewidth": 0}
TIP = {"facecolor": "#A8A8A8", "edgecolor": style.BLACK, "linewidth": 1.0}
AT_REST = {"label": "tip, undeformed", "color": style.BLUE, "linestyle": "-.", "linewidth": 0.9}
MIDDLE_MARK = {"color": style.VERMILLION, "markeredgecolor": style.BLACK, "markeredgewidth": 0.5}
LOOKS = {
    "rod": ROD,
    "part that bears": ENGAGED,
    "worn away": GONE,
    "blade tip": TIP,
}
FORCE = 0.3  # of the panel's height, the longest arrow
NAMED = 0.12  # of the panel's width, room for a name at its side
SHAPE = 0.55  # height of a panel over its width, nearly
BEHIND = {"facecolor": "white", "linewidth": 0, "pad": 0.8}
MEASURE = {"arrowstyle": "<->", "linewidth": 0.6, "shrinkA": 0, "shrinkB": 0}
FORCE_MARK = {"marker": r"$\downarrow$", "linestyle": "", "markersize": 8, "color": style.BLACK}
PUSH = {"arrowstyle": "-|>", "linewidth": 0.9, "color": style.BLACK, "shrinkA": 0, "shrinkB": 0}


class FootprintError(ValueError):
    """A sweep that has nothing to show; the message says what is missing."""


@dataclass(frozen=True)
class Footprint:
    """Rods of a strip, under the tip and beside it; radial positions over gap g.

    0 is the liner as it was made, outward is positive: towards the casing.
    """

    s: NDArray[np.float64]  # (rods,), m, arc from the tip's middle, in the sense of rotation
    pitch: float  # m, arc from rod to rod
    gap: float  # g, m
    rest: float  # position of the tip's middle, undeformed
    thickness: float  # m, of the liner
    part: NDArray[np.float64]  # (rods,), part of each rod that the tip covers
    unworn: NDArray[np.float64]  # (rods,), surface that the casing has brought inward
    worn: NDArray[np.float64]  # (rods,), surface before the tip presses
    end: NDArray[np.float64]  # (rods,), surface under the tip
    sigma: NDArray[np.float64]  # (rods,), Pa, stress
    slope: NDArray[np.float64]  # (rods,), p'(s)
    tip: NDArray[np.float64]  # (2, OUTLINE): arc, m, over the length covered; position
    middle: float  # position of the tip's middle

    @property
    def covered(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Where each rod's covered part begins and ends (rods,), m."""
        half = self.pitch / 2
        low, high = self.tip[0, 0], self.tip[0, -1]
        return np.clip(self.s - half, low, high), np.clip(self.s + half, low, high)


def load(files: Any) -> tuple[Footprint, Footprint]:
    """Read the sweeps ``files.sweep``, ``files.tilted`` and the reduced model, ``files.rom``.

    Of the tilted one only the scene is read. The model needs radial directions only.

    Raises
    ------
    FootprintError
        When the tip of the tilted scene is flat, or the other sweep has no wear to show.
    """
    tilted = scene_of(load_sweep(files.tilted))
    if tilted.contact.profile is None:
        raise FootprintError(f"{files.tilted}: its tip is flat: take a scene with contact.profile")
    return at_deepest(files.sweep, files.rom), into_fresh(tilted, Rom.load(files.rom))


def at_deepest(path: str, rom: str) -> Footprint:
    """The tip as far out as it was over the deepest place that the k = 4 peak wears in its strip.

    Raises
    ------
    FootprintError
        When the sweep has no speed near that peak, or the peak's liner is not worn.
    """
    found, peak = load_sweep(path), read_response(path, rom).peak(ENGINE_ORDER)
    if peak is None or "wear" not in found or not found["wear"][peak.index, STRIP].max() > 0:
        raise FootprintError(
            f"{path}: no worn liner at a k = {ENGINE_ORDER} peak: sweep over that peak with "
            "record.wear: true"
        )
    scene, Omega = scene_of(found), float(found["speed"][peak.index])
    strips = prepare(scene, Rom.load(rom), Omega).strips
    eps_p = found["wear"][peak.index, STRIP].values / strips.thickness
    deepest = int(eps_p.argmax())
    strain = strain_of(scene.liner.law, float(eps_p[deepest]))
    u_r = strips.g0[STRIP] - strips.d[deepest] + strain * strips.thickness
    x, gap = place(strips, deepest), leading_gap(found)
    return footprint(strips, scene.liner.law, gap, x, eps_p, 1.0, u_r)


def into_fresh(scene: Scene, rom: Rom) -> Footprint:
    """The scene's profiled tip pressed into a liner that is neither worn nor distorted."""
    scene = scene.changed(contact__tangential=False)  # asks no more of the model
    strips = prepare(scene, rom, scene.speeds.omega(rom.f1)[0]).strips
    ends = [profile_at(strips.tip, s)[0] for s in (-strips.tip.half, strips.tip.half)]
    gap, fresh = float(scene.clearance.gaps(LEADING, rom.span)), np.zeros(strips.d.size)
    u_r = strips.g0[STRIP] + min(PRESSED * max(ends), DEEPEST * gap)
    return footprint(strips, scene.liner.law, gap, place(strips, 0), fresh, 0.0, u_r)


def strain_of(law: Law, eps_p: float) -> float:
    """Largest strain of a rod with the plastic strain ``eps_p``."""
    return brentq(lambda eps: law.stress(law.parameters, eps, 0.0)[1] - eps_p, eps_p, 1.0)


def place(strips: Strips, rod: int) -> float:
    """Place of the first rod (rods) at the step that brings the tip's middle to ``rod``.

    Of the places half a rod either way the one where both ends cover half a rod.
    """
    wanted = rod + 0.5 - strips.behind - strips.m // 2
    first = strips.first[STRIP]
    step = round((wanted - first) % strips.d.size / strips.advance)
    return first + step * strips.advance


def footprint(
    strips: Strips,
    law: Law,
    gap: float,
    x: float,
    eps_p: NDArray[np.float64],
    a: float,
    u_r: float,
) -> Footprint:
    """Press the tip to ``u_r`` (m), the first rod of its footprint at ``x`` (rods).

    ``gap`` is g, m, ``eps_p`` (nu,) the plastic strains of the strip, ``a`` the share of the
    distortion.
    """
    first, g0, l = floor(x), strips.g0[STRIP], strips.thickness
    passed, pitch = x - first, strips.pitch[STRIP]
    k = np.arange(-BESIDE, strips.m + strips.behind + 1 + BESIDE)
    rods = (first + k) % strips.d.size
    s = np.array([pitch * offset(strips, i, passed) for i in k])
    part = np.array([covered_part(strips, i, passed) for i in k])
    middle = [pitch * covered_middle(strips, i, passed) for i in k]
    p, slope = np.array([profile_at(strips.tip, at) for at in middle]).T
    delta = np.where(part > 0, u_r - p + a * strips.d[rods] - g0, 0.0)
    sigma = [
        law.stress(strips.law, deep / l, before)[0] if deep > 0 else 0.0
        for deep, before in zip(delta, eps_p[rods], strict=True)
    ]
    unworn = -a * strips.d[rods] / gap
    worn = unworn + l * eps_p[rods] / gap
    along = np.linspace(-0.5, 0.5, OUTLINE) * strips.length * pitch
    surface = [(u_r - g0 - profile_at(strips.tip, at)[0]) / gap for at in along]
    return Footprint(
        s=s,
        pitch=float(pitch),
        gap=gap,
        rest=float(-g0 / gap),
        thickness=l,
        part=part,
        unworn=unworn,
        worn=worn,
        end=np.maximum(worn, unworn + delta / gap),
        sigma=np.array(sigma),
        slope=slope,
        tip=np.array([along, surface]),
        middle=surface[OUTLINE // 2],
    )


@style.styled
def draw(flat: Footprint, profiled: Footprint) -> Figure:
    """Flat tip over worn rods; profiled tip and the normals along which the rods push it."""
    drawn = style.figure(style.SINGLE, 5.0)
    upper, lower = drawn.subplots(2, 1)
    for axes, shown, letter in ((upper, flat, "a"), (lower, profiled, "b")):
        _panel(axes, shown)
        style.panel_letter(axes, letter)
    _name_depths(upper, flat)
    _name_profile(lower, profiled)
    patches = [Patch(label=label, **look) for label, look in LOOKS.items()]
    force = Line2D([], [], label="force on blade", **FORCE_MARK)
    handles = [*patches, upper.axhline(flat.rest, **AT_REST), force]
    drawn.legend(handles=handles, loc="outside lower center", ncols=3)
    return drawn


def _panel(axes: Axes, shown: Footprint) -> None:
    """Draw rods, tip and forces: arc to scale, radial positions exaggerated."""
    low, high = _limits(shown)
    magnified = _magnified(shown, high - low)
    arc, width = MILLI * shown.s, MILLI * shown.pitch
    axes.bar(arc, shown.worn - shown.unworn, width, shown.unworn, **GONE)
    axes.bar(arc, high - shown.end, width, shown.end, **ROD)
    begin, end = (MILLI * side for side in shown.covered)
    bears = shown.sigma > 0
    axes.bar(
        begin[bears],
        (high - shown.end)[bears],
        (end - begin)[bears],
        shown.end[bears],
        align="edge",
        **ENGAGED,
    )
    along, surface = MILLI * shown.tip[0], shown.tip[1]
    axes.fill([*along, along[-1], along[0]], [*surface, low - 1, low - 1], **TIP)
    axes.plot(0, shown.middle, "o", markersize=4.5, zorder=5, **MIDDLE_MARK)
    axes.set(xlim=MILLI * np.array(_window(shown)), ylim=(low, high))
    axes.set(aspect=magnified * shown.gap * MILLI)
    axes.set(xlabel="arc $s$ from the tip's middle (mm)")
    axes.set(ylabel=f"radius from undistorted\nliner, {style.OVER_GAP}")
    axes.annotate("", (0.97, 0.08), (0.82, 0.08), xycoords="axes fraction", arrowprops=PUSH)
    axes.text(0.8, 0.08, r"$\Omega$", transform=axes.transAxes, ha="right", va="center")
    axes.set_title(f"radial scale $\\times$ {magnified:g}", loc="right", fontsize=7)
    _forces(axes, shown, magnified, high - low)


def _window(shown: Footprint) -> tuple[float, float]:
    """Arc shown, m: the footprint where all of it bears, else what bears, and rods beside."""
    low, high = shown.tip[0, [0, -1]]
    bears, covered = (np.flatnonzero(x > 0) for x in (shown.sigma, shown.part))
    if bears.size < covered.size:
        low, high = shown.s[bears[[0, -1]]] + shown.pitch / 2 * np.array([-1, 1])
    return low - BESIDE * shown.pitch, high + BESIDE * shown.pitch


def _limits(shown: Footprint) -> tuple[float, float]:
    """Radial positions shown: all surfaces, and room for the forces in the tip."""
    (first, last), (along, surface) = _window(shown), shown.tip
    tip = surface[(along >= first) & (along <= last)]
    low = min(shown.unworn.min(), tip.min(), shown.rest)
    high = max(shown.end.max(), shown.worn.max(), 0)
    return low - 0.35 * (high - low), high + 0.35 * (high - low)


def _magnified(shown: Footprint, height: float) -> float:
    """Factor of two digits on radial positions that gives the panel its shape."""
    factor = SHAPE * np.ptp(_window(shown)) / (height * shown.gap)
    return float(f"{factor:.2g}")


def _forces(axes: Axes, shown: Footprint, magnified: float, height: float) -> None:
    """Draw the force of each rod on the blade, along the normal of the drawn profile."""
    scale = magnified * shown.gap * MILLI  # mm drawn for a gap
    begin, end = shown.covered
    force = shown.part * shown.sigma
    steep = magnified * shown.slope
    length = FORCE * height * scale * force / force.max() / np.hypot(1, steep)
    for i in np.flatnonzero(force > 0):
        at = (begin[i] + end[i]) / 2
        foot = (MILLI * at, np.interp(at, *shown.tip))
        head = (foot[0] - steep[i] * length[i], foot[1] - length[i] / scale)
        axes.annotate("", head, foot, arrowprops=PUSH)


def _name_depths(axes: Axes, shown: Footprint) -> None:
    """Name what wear has taken, and what the tip still presses."""
    beside = int(np.flatnonzero(shown.part > 0)[0]) - 2
    at = MILLI * shown.s[beside]
    _measure(axes, at, shown.unworn[beside], shown.worn[beside], "worn depth")
    last = int(np.flatnonzero(shown.part > 0)[-1])
    at = MILLI * (shown.tip[0, -1] + 0.15 * shown.pitch)
    _measure(axes, at, shown.worn[last], shown.end[last], "elastic")
    depth = shown.thickness / shown.gap
    cut = f"rods cut:\n$l$ = {depth:.0f} $g$"
    axes.text(0.02, 0.95, cut, transform=axes.transAxes, va="top", fontsize=7, bbox=BEHIND)


def _name_profile(axes: Axes, shown: Footprint) -> None:
    """Name the profile near its deepest: its distance from what is closest to the casing."""
    (first, last), (along, surface) = _window(shown), shown.tip
    seen = (along >= first) & (along <= last)
    deepest = along[seen][surface[seen].argmin()]
    beside = deepest == along[-1] < last  # the end of the tip is seen, and room beyond it
    at = deepest + 0.2 * shown.pitch if beside else deepest - NAMED * (last - first)
    _measure(axes, MILLI * at, np.interp(at, along, surface), surface[seen].max(), "$p(s)$")


def _measure(axes: Axes, at: float, low: float, high: float, name: str) -> None:
    """Draw a radial double arrow, its name to the right."""
    axes.annotate("", (at, low), (at, high), arrowprops=MEASURE)
    axes.annotate(
        name,
        (at, (low + high) / 2),
        (4, 0),
        textcoords="offset points",
        va="center",
        fontsize=7,
        bbox=BEHIND,
    )
