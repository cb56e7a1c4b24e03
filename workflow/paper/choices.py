"""Choices of ours that the paper leaves open, made otherwise, one at a time: claims that differ.

Snakemake's rules import this module to list their jobs: it imports no compiled code.
"""

from collections.abc import Callable, Mapping
from operator import methodcaller
from typing import Any

from simulate.errors.neighbour import Neighbour
from simulate.scene import Scene


def but(**changes: Any) -> Callable[[Scene], Scene]:
    """Change of a scene, of both coatings alike."""
    return methodcaller("but", **changes)


def _coatings(soft: float, stiff: float, **changes: Any) -> Callable[[Scene], Scene]:
    """Change of the scenes with K = ``soft`` for E = 1 and ``stiff`` for E = 10."""

    def changed(scene: Scene) -> Scene:
        return scene.but(liner__law__K=soft if scene.liner.law.E == 1 else stiff, **changes)

    return changed


def _shape(*amplitudes: tuple[int, float]) -> list[dict[str, Any]]:
    return [{"order": k, "amplitude_gaps": a} for k, a in amplitudes]


def _casing(*amplitudes: tuple[int, float]) -> Callable[[Scene], Scene]:
    return but(casing__harmonics=_shape(*amplitudes))


# The scene's settings before the identification: workflow/scenes/variants.yaml, `hand`
BY_HAND = {
    "damping_ratio": 0.005,
    "casing__harmonics": _shape((0, 0.375), (2, 0.5), (4, 0.125)),
    "casing__scale": 1.75,
    "liner__law__unit_Pa": 8e9,
}
CAUSES = (
    Neighbour("as it is"),
    Neighbour("chosen by hand, K = 0.45 for E = 1", _coatings(0.45, 4.55, **BY_HAND)),
    Neighbour("chosen by hand, K = 4.55 for both", but(**BY_HAND)),
    Neighbour("casing amplitude 1.3 gaps", but(casing__scale=0.97)),
    Neighbour("casing amplitude 2.5 gaps", but(casing__scale=1.86)),
    Neighbour(
        "casing a pure cos 2 theta", but(casing={"harmonics": _shape((2, 1.0)), "scale": 1.7})
    ),
    Neighbour("unit of E halved", but(liner__law__unit_Pa=8.2e8)),
    Neighbour("unit of E doubled", but(liner__law__unit_Pa=3.28e9)),
    Neighbour("unit of E four times", but(liner__law__unit_Pa=6.56e9)),
    Neighbour("damping 0.1 %", but(damping_ratio=0.001)),
    Neighbour("damping 1 %", but(damping_ratio=0.01)),
    Neighbour("K = 0.45 for E = 1", _coatings(0.45, 4.55)),
    Neighbour("K = 0.45 for both", _coatings(0.45, 0.45)),
    Neighbour("K/E = 2", _coatings(2.0, 20.0)),
    Neighbour("thickness 10 mm", but(liner__thickness_m=1e-2)),
    Neighbour("footprint 10 mm", but(liner__footprint_m=1e-2)),
    Neighbour("ramp over 8 rounds", but(casing__ramp_rounds=8)),
    Neighbour("full interface", directions="rtz"),
    Neighbour("linear prestress", but(blade="reference-linear")),
    Neighbour("tip rounded by 20 um", but(contact={"profile": {"edge_drop_m": 2e-5}})),
)

# Choices for the tip, in the scenes with and without tangential force. A blade whose mode 1 moves
# the tip further inward is softer for the liner: its unit of E is also scaled by omega^2 / Phi^2 of
# mode 1 there over the reference blade's (0.101 and 0.226), as in the identification.
TIPS = (
    Neighbour("tilt 0.15, as it is"),
    Neighbour("tilt 0.05", but(contact__profile={"tilt": 0.05})),
    Neighbour("tilt 0.02", but(contact__profile={"tilt": 0.02})),
    Neighbour("tilt 0.15, unit of E doubled", but(liner__law__unit_Pa=3.28e9)),
    Neighbour("tilt 0.15, unit of E five times", but(liner__law__unit_Pa=8.2e9)),
    Neighbour("tilt 0.15, blade with an ordinary lean", but(blade="leaned")),
    Neighbour(
        "tilt 0.15, ordinary lean, unit of E scaled",
        but(blade="leaned", liner__law__unit_Pa=1.65e8),
    ),
    Neighbour("tilt 0.15, blade leaned the other way", but(blade="leaned-back")),
    Neighbour(
        "tilt 0.15, leaned the other way, unit of E scaled",
        but(blade="leaned-back", liner__law__unit_Pa=3.7e8),
    ),
)

# Harmonics of the casing with two and five diameters, as far inward as ours
CASINGS = (
    Neighbour("two and five diameters, as it is"),
    Neighbour("two and five diameters alike", _casing((0, 0.3), (2, 0.35), (5, 0.35))),
    Neighbour("five diameters half of two", _casing((0, 0.25), (2, 0.5), (5, 0.25))),
    Neighbour("two and five diameters, 1.3 gaps", but(casing__scale=1.3)),
    Neighbour("two and five diameters, 2.5 gaps", but(casing__scale=2.5)),
    Neighbour("with four and six", _casing((0, 0.35), (2, 0.15), (4, 0.1), (5, 0.3), (6, 0.1))),
)

# The table of E and K up to 0.45 f1, beyond the peaks of the stiffest coatings
TABLES = (
    Neighbour(
        "table up to 0.45",
        but(
            speeds={"over_f1": {"first": 0.301, "last": 0.45, "count": 51}},
            peaks={"orders": [4]},
            blade="reference-wide",
        ),
    ),
)

# By the scene that they change
OF_SCENE: Mapping[str, tuple[Neighbour, ...]] = {
    "paper": CAUSES,
    "paper-tangential": TIPS,
    "paper-two-five": CASINGS,
    "paper-grid": TABLES,
}
