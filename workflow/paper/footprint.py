"""Rods of the leading strip under the tip, with the contact law of the model: Fig. 4."""

from math import floor
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rom.model import Rom
from simulate.contact.gaps import given_gaps
from simulate.contact.strips import Strips, covered_middle, covered_part, offset, profile_at
from simulate.marching import prepare
from simulate.scene import LEADING
from simulate.signals import leading_gap
from simulate.sweeps.dataset import load, scene_of
from simulate.sweeps.peak import peak_of
from workflow.paper.laws import strain_of
from workflow.paper.published import ENGINE_ORDER

STRIP = 0  # the leading one
BESIDE = 3  # rods shown on either side of the footprint
PRESSED = 1.25  # penetration of the profiled tip into a new liner, over the depth of its profile,
DEEPEST = 1.0  # gaps, but at most this, as in a run: of a steep tip only one end is in contact
OUTLINE = 201  # points of the tip's profile


class FootprintError(ValueError):
    """A sweep without a footprint to show; the message names the missing part."""


class Footprint(NamedTuple):
    """Rods of a strip, under the tip and next to it; radial positions over gap g.

    0 is the surface of the undistorted, unworn liner; outward, towards the casing, is positive. The
    columns of ``rods`` are s (m), the arc from the tip's middle in the sense of rotation; begin and
    finish (m) of the part that the tip covers, and how much of the rod that is, part; unworn, the
    unworn surface, displaced inward by the casing; worn, that of the worn, unloaded rod; end, that
    under the tip; sigma (Pa), the stress; slope, p'(s).
    """

    rods: pd.DataFrame
    tip: NDArray[np.float64]  # (2, OUTLINE): arc, m, over the length covered; position
    pitch: float  # m, arc from rod to rod
    gap: float  # g, m
    rest: float  # position of the tip's middle, undeformed
    thickness: float  # m, of the liner


def at_deepest(path: str | Path, rom: Rom) -> Footprint:
    """The tip at its largest penetration where the liner of the strip is worn most, at EO 4.

    Raises
    ------
    FootprintError
        When the sweep has no speed near the EO 4 peak, or the liner is not worn there.
    """
    runs = load(path)
    peak = peak_of(runs, rom, ENGINE_ORDER)
    if peak is None or "wear" not in runs or not runs["wear"][peak.index, STRIP].max() > 0:
        raise FootprintError(
            f"{path}: no worn liner at a k = {ENGINE_ORDER} peak: run a sweep over that peak with "
            "record.wear: true"
        )
    scene, Omega = scene_of(runs), float(runs["speed"][peak.index])
    strips = prepare(scene, rom, Omega).strips
    eps_p = runs["wear"][peak.index, STRIP].values / strips.thickness
    deepest = int(eps_p.argmax())
    strain = strain_of(scene.liner.law, float(eps_p[deepest]))
    u_r = strips.g0[STRIP] - strips.d[deepest] + strain * strips.thickness
    x, gap = place(strips, deepest), leading_gap(runs)
    return footprint(strips, gap, x, eps_p, 1.0, u_r)


def into_fresh(path: str | Path, rom: Rom) -> Footprint:
    """The profiled tip of a sweep's scene pressed into an unworn liner without distortion.

    A reduced model with radial interface DoFs is sufficient.

    Raises
    ------
    FootprintError
        When the tip of the scene is flat.
    """
    scene = scene_of(load(path))
    if scene.contact.profile is None:
        raise FootprintError(f"{path}: its tip is flat: use a scene with contact.profile")
    scene = scene.but(contact__tangential=False)  # no tangential DoFs are needed
    strips = prepare(scene, rom, scene.speeds.omega(rom.f1)[0]).strips
    half = strips.tip.half[STRIP]
    ends = [profile_at(strips.tip, STRIP, s)[0] for s in (-half, half)]
    gap, fresh = float(given_gaps(scene.gaps, rom, LEADING)), np.zeros(strips.d.size)
    u_r = strips.g0[STRIP] + min(PRESSED * max(ends), DEEPEST * gap)
    return footprint(strips, gap, place(strips, 0), fresh, 0.0, u_r)


def place(strips: Strips, rod: int) -> float:
    """Place of the first rod (rods) at the step at which the tip's middle is at ``rod``.

    Rounded so that the footprint covers half of the rod at either end.
    """
    wanted = rod + 0.5 - strips.partly_covered - strips.rods_covered // 2
    first = strips.first[STRIP]
    step = round((wanted - first) % strips.d.size / strips.advance)
    return first + step * strips.advance


def footprint(
    strips: Strips,
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
    first, g0, l, law = floor(x), strips.g0[STRIP], strips.thickness, strips.law
    passed, pitch = x - first, strips.pitch[STRIP]
    k = strips.partly_covered + np.arange(-BESIDE, strips.rods_covered + 1 + BESIDE)
    rods = (first + k) % strips.d.size
    s = np.array([pitch * offset(strips, i, passed) for i in k])
    part = np.array([covered_part(strips, STRIP, i, passed) for i in k])
    middle = [pitch * covered_middle(strips, STRIP, i, passed) for i in k]
    p, slope = np.array([profile_at(strips.tip, STRIP, arc) for arc in middle]).T
    delta = np.where(part > 0, u_r - p + a * strips.d[rods] - g0, 0.0)
    sigma = [
        law.stress(law.parameters, deep / l, before)[0] if deep > 0 else 0.0
        for deep, before in zip(delta, eps_p[rods], strict=True)
    ]
    unworn = -a * strips.d[rods] / gap
    worn = unworn + l * eps_p[rods] / gap
    along = np.linspace(-0.5, 0.5, OUTLINE) * strips.length[STRIP] * pitch
    surface = [(u_r - g0 - profile_at(strips.tip, STRIP, arc)[0]) / gap for arc in along]
    columns = {
        "s": s,
        "begin": np.clip(s - pitch / 2, along[0], along[-1]),
        "finish": np.clip(s + pitch / 2, along[0], along[-1]),
        "part": part,
        "unworn": unworn,
        "worn": worn,
        "end": np.maximum(worn, unworn + delta / gap),
        "sigma": sigma,
        "slope": slope,
    }
    tip = np.array([along, surface])
    return Footprint(pd.DataFrame(columns), tip, float(pitch), gap, float(-g0 / gap), l)
