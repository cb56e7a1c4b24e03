"""Unusual values of a scene: each with the likely value if it is a slip.

Impossible values are refused by the scene's own ranges (``scene``).
"""

import warnings
from collections.abc import Iterable
from itertools import chain
from math import inf

import numpy as np
import xarray as xr

from geometry.base import Caution
from rom.model import Rom
from simulate.contact.gaps import given_gaps
from simulate.scene import LEADING, Casing, Liner, Profile, Scene
from simulate.scene.damping import given

SLOWEST = 0.005  # over f1(0): below, no engine order up to 200 meets f1
DAMPED = 0.1  # of critical damping: blades and their roots have 1e-4 to 2e-2
WIDE = 0.02  # of the span: tip gaps are 1e-4 to 1e-2
MANY_GAPS = 20.0  # of a casing amplitude
STEEP = 0.2  # slope of the tip, 11 deg
SOFT = 1e6  # Pa: rubber; stiffer than 1e13 is refused

type Implausible = tuple[bool, str, str]  # whether a value is doubtful, its key, and the line of it


class SceneWarning(Caution):
    """A value that may be meant; the message has key, value, usual range, and the likely slip."""


def warn_of(lines: Iterable[str]) -> None:
    """Give each line as a ``SceneWarning``; a repeated one is shown once."""
    for line in lines:
        warnings.warn(line, SceneWarning, stacklevel=2)


def doubts(scene: Scene, rom: Rom) -> dict[str, str]:
    """A line for each doubtful value, by its key."""
    gaps = given_gaps(scene.gaps, rom, [LEADING, 0, 1])
    goes_on = scene.start is not None or scene.record.end
    tried = chain(
        _of_motion(scene.speeds.omega(rom.f1).min() / rom.omega1, max(given(scene.damping_ratio))),
        _of_gaps(
            scene.casing,
            float(gaps[0]),
            float(gaps[1:].max()),
            rom.span,
            inf if goes_on else scene.rounds,
        ),
        _of_tip(scene.contact.profile),
        _of_liner(scene.liner, rom),
    )
    return {key: line for doubtful, key, line in tried if doubtful}


def doubts_of_runs(runs: xr.Dataset) -> dict[str, str]:
    """A line for each limit that the runs of a sweep exceed, by its key."""
    if "curve_share" not in runs or not (beyond := runs["curve_share"] > 1).any():
        return {}
    return {
        "liner.law.curve": (
            f"liner.law.curve: at {int(beyond.sum())} of {beyond.size} speeds rods are worn to a "
            f"plastic strain of up to {float(runs['curve_share'].max()):.3g} times that at the end "
            "of the curve, beyond which the law continues with its last slope: measure further"
        )
    }


def _of_motion(slowest: float, xi: float) -> list[Implausible]:
    return [
        (
            slowest < SLOWEST,
            "speeds",
            f"speeds: {slowest:.3g} f1(0): below {SLOWEST:g} no engine order up to 200 meets f1; "
            "in over_f1, f1(0) is in Hz and the speed in revolutions per second",
        ),
        (
            xi > DAMPED,
            "damping_ratio",
            f"damping_ratio: {xi:g}: {100 * xi:g} % of critical damping; usual are 1e-4 to 0.02; "
            f"{xi:g} % would be {xi / 100:g}",
        ),
    ]


def _of_gaps(
    casing: Casing, gap: float, widest: float, span: float, rounds: float
) -> list[Implausible]:
    """Of the ``widest`` gap, m, and of a casing in units of the ``gap`` at 1/16, m."""
    amplitudes = [harmonic.amplitude_gaps or 0.0 for harmonic in casing.harmonics or []]
    ramp = casing.ramp_rounds or 0.0
    return [
        (
            widest > WIDE * span,
            "clearance",
            f"clearance: {1e3 * widest:.3g} mm, {100 * widest / span:.2g} % of the span; usual "
            "are 0.01 to 1 %; is it in mm, or in %? it should be in um, or over the span",
        ),
        *(
            (
                amplitude > MANY_GAPS,
                "casing",
                f"casing.harmonics: amplitude_gaps: {amplitude:g}: that many gaps, of "
                f"{1e6 * gap:.3g} um; 150 % of the gap would be 1.5",
            )
            for amplitude in amplitudes
        ),
        (
            ramp > rounds,
            "casing.ramp_rounds",
            f"casing.ramp_rounds: {ramp:g}: longer than the {rounds:g} revolutions: the casing "
            "never distorts as far as given",
        ),
    ]


def _of_tip(profile: Profile | None) -> list[Implausible]:
    tilt = profile.tilt if profile else 0.0
    degrees, slope = np.degrees(np.arctan(tilt)), np.tan(np.radians(tilt))
    return [
        (
            abs(tilt) > STEEP,
            "contact.profile.tilt",
            f"contact.profile.tilt: {tilt:g}: a slope, of {degrees:.3g} deg; {tilt:g} deg would be "
            f"{slope:.3g}",
        )
    ]


def _of_liner(liner: Liner, rom: Rom) -> list[Implausible]:
    law, (r, theta, z) = liner.law, rom.camber.T
    chord = float(np.hypot(np.ptp(r * theta), np.ptp(z)))
    deforms, footprint = law.touches and law.deforms, liner.footprint_m or 0.0
    modulus = law.modulus if deforms else inf
    E, sigma_Y = getattr(law, "E", inf), getattr(law, "sigma_Y", 0.0)
    return [
        (
            footprint > 0 and rom.across == 2,
            "liner.footprint_mm",
            f"liner.footprint_mm: {1e3 * footprint:g}: is not used with two rows across the "
            "thickness: the tip rubs the arc that it covers; take it out, or give the blade "
            "interface.across: 1",
        ),
        (
            rom.across == 1 and footprint > chord,
            "liner.footprint_mm",
            f"liner.footprint_mm: {1e3 * footprint:g}: longer than the chord of "
            f"{1e3 * chord:.3g} mm; it is the arc over which one strip of the tip rubs, some mm; "
            "is it in um?",
        ),
        (
            modulus < SOFT,
            "liner.law.E",
            f"liner.law: a modulus of {modulus:.3g} Pa; rubber has {SOFT:g}; moduli are in "
            "unit_MPa",
        ),
        (
            deforms and not law.has_strength,
            "liner.law.sigma_Y",
            "liner.law: sigma_Y and K are 0: the tip wears the liner without any force",
        ),
        (
            deforms and sigma_Y >= E and law.has_strength,
            "liner.law.sigma_Y",
            f"liner.law.sigma_Y: {sigma_Y:g}: not below E = {E:g}: the liner would wear from a "
            "strain of 1 on; is it in Pa? it should be in unit_MPa, like E",
        ),
    ]
