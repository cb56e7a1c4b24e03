"""Choices of ours that the paper leaves open, made otherwise, one at a time: claims that differ.

Snakemake's rules import this module to list their jobs: it imports no compiled code.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Cause:
    """One choice that the paper leaves open, with another value than ours."""

    name: str
    changes: Mapping[str, Any] = field(default_factory=dict)  # to the scenes of both coatings
    blade: str = "reference"
    directions: str = "r"  # of the reduced model
    K: tuple[float, float] | None = None  # of both coatings; None: unchanged

    @property
    def file(self) -> str:
        """Name of its file: the words of its name, joined by hyphens."""
        spelt = self.name.replace("%", "percent").replace("/", " over ")
        return "-".join(re.findall(r"[\w.]+", spelt))


def _shape(*amplitudes: tuple[int, float]) -> list[dict[str, Any]]:
    return [{"order": k, "amplitude_gaps": a} for k, a in amplitudes]


def _casing(*amplitudes: tuple[int, float]) -> dict[str, Any]:
    return {"casing__harmonics": _shape(*amplitudes)}


# The scene's settings before the identification: workflow/scenes/variants.yaml, `hand`
BY_HAND = {
    "damping_ratio": 0.005,
    "casing__harmonics": _shape((0, 0.375), (2, 0.5), (4, 0.125)),
    "casing__scale": 1.75,
    "liner__law__unit_Pa": 8e9,
}
CAUSES = (
    Cause("as it is"),
    Cause("chosen by hand, K = 0.45 for E = 1", BY_HAND, K=(0.45, 4.55)),
    Cause("chosen by hand, K = 4.55 for both", BY_HAND),
    Cause("casing amplitude 1.3 gaps", {"casing__scale": 0.97}),
    Cause("casing amplitude 2.5 gaps", {"casing__scale": 1.86}),
    Cause("casing a pure cos 2 theta", {"casing": {"harmonics": _shape((2, 1.0)), "scale": 1.7}}),
    Cause("unit of E halved", {"liner__law__unit_Pa": 8.2e8}),
    Cause("unit of E doubled", {"liner__law__unit_Pa": 3.28e9}),
    Cause("unit of E four times", {"liner__law__unit_Pa": 6.56e9}),
    Cause("damping 0.1 %", {"damping_ratio": 0.001}),
    Cause("damping 1 %", {"damping_ratio": 0.01}),
    Cause("K = 0.45 for E = 1", K=(0.45, 4.55)),
    Cause("K = 0.45 for both", K=(0.45, 0.45)),
    Cause("K/E = 2", K=(2.0, 20.0)),
    Cause("thickness 10 mm", {"liner__thickness_m": 1e-2}),
    Cause("footprint 10 mm", {"liner__footprint_m": 1e-2}),
    Cause("ramp over 8 rounds", {"casing__ramp_rounds": 8}),
    Cause("full interface", directions="rtz"),
    Cause("linear prestress", blade="reference-linear"),
    Cause("tip rounded by 20 um", {"contact": {"profile": {"edge_drop_m": 2e-5}}}),
)

# Choices for the tip, in the scenes with and without tangential force. A blade whose mode 1 moves
# the tip further inward is softer for the liner: its unit of E is also scaled by omega^2 / Phi^2 of
# mode 1 there over the reference blade's (0.101 and 0.226), as in the identification.
TIPS = (
    Cause("tilt 0.15, as it is"),
    Cause("tilt 0.05", {"contact__profile": {"tilt": 0.05}}),
    Cause("tilt 0.02", {"contact__profile": {"tilt": 0.02}}),
    Cause("tilt 0.15, unit of E doubled", {"liner__law__unit_Pa": 3.28e9}),
    Cause("tilt 0.15, unit of E five times", {"liner__law__unit_Pa": 8.2e9}),
    Cause("tilt 0.15, blade with an ordinary lean", blade="leaned"),
    Cause(
        "tilt 0.15, ordinary lean, unit of E scaled",
        {"liner__law__unit_Pa": 1.65e8},
        blade="leaned",
    ),
    Cause("tilt 0.15, blade leaned the other way", blade="leaned-back"),
    Cause(
        "tilt 0.15, leaned the other way, unit of E scaled",
        {"liner__law__unit_Pa": 3.7e8},
        blade="leaned-back",
    ),
)

# Harmonics of the casing with two and five diameters, as far inward as ours
CASINGS = (
    Cause("two and five diameters, as it is"),
    Cause("two and five diameters alike", _casing((0, 0.3), (2, 0.35), (5, 0.35))),
    Cause("five diameters half of two", _casing((0, 0.25), (2, 0.5), (5, 0.25))),
    Cause("two and five diameters, 1.3 gaps", {"casing__scale": 1.3}),
    Cause("two and five diameters, 2.5 gaps", {"casing__scale": 2.5}),
    Cause("with four and six", _casing((0, 0.35), (2, 0.15), (4, 0.1), (5, 0.3), (6, 0.1))),
)

# The table of E and K up to 0.45 f1, beyond the peaks of the stiffest coatings
TABLES = (
    Cause(
        "table up to 0.45",
        {
            "speeds": {"over_f1": {"first": 0.301, "last": 0.45, "count": 51}},
            "peaks": {"orders": [4]},
        },
        blade="reference-wide",
    ),
)

# By the scene that they change
OF_SCENE: Mapping[str, tuple[Cause, ...]] = {
    "paper": CAUSES,
    "paper-tangential": TIPS,
    "paper-two-five": CASINGS,
    "paper-grid": TABLES,
}
