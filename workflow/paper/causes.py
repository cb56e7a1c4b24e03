"""Both coatings with one choice of ours made otherwise: which of them moves which claim."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from rom.model import Rom
from simulate.scene import Scene
from simulate.sweep import sweep
from workflow.paper.cases import COATINGS, of_coating
from workflow.paper.measure import coating, tip_force


@dataclass(frozen=True)
class Cause:
    """One choice that the paper leaves open, made otherwise."""

    name: str
    changes: Mapping[str, Any] = field(default_factory=dict)  # of both coatings' scenes
    blade: str = "reference"
    directions: str = "r"  # of the reduced model
    K: tuple[float, float] | None = None  # of both coatings; None: as they are


def _shape(*amplitudes: tuple[int, float]) -> list[dict[str, Any]]:
    return [{"order": k, "amplitude_gaps": a} for k, a in amplitudes]


CAUSES = (
    Cause("as it is"),
    Cause("casing amplitude 1.4 gaps", {"casing__scale": 1.4}),
    Cause("casing amplitude 2.5 gaps", {"casing__scale": 2.5}),
    Cause("casing a pure cos 2 theta", {"casing__harmonics": _shape((2, 1.0))}),
    Cause("unit of E an eighth", {"liner__law__unit_Pa": 1e9}),
    Cause("unit of E halved", {"liner__law__unit_Pa": 4e9}),
    Cause("16 GPa and 1.5 gaps", {"liner__law__unit_Pa": 1.6e10, "casing__scale": 1.5}),
    Cause("unit of E doubled", {"liner__law__unit_Pa": 1.6e10}),
    Cause("damping 0.2 %", {"damping_ratio": 0.002}),
    Cause("damping 1 %", {"damping_ratio": 0.01}),
    Cause("K = 0.45 for both", K=(0.45, 0.45)),
    Cause("K = 4.55 for both", K=(4.55, 4.55)),
    Cause("K/E = 0.1", K=(0.1, 1.0)),
    Cause("K/E = 2", K=(2.0, 20.0)),
    Cause("thickness 10 mm", {"liner__thickness_m": 1e-2}),
    Cause("footprint 10 mm", {"liner__footprint_m": 1e-2}),
    Cause("ramp over 8 rounds", {"casing__ramp_rounds": 8}),
    Cause("full interface", directions="rtz"),
    Cause("linear prestress", blade="reference-linear"),
    Cause("tip rounded by 20 um", {"contact": {"profile": {"edge_drop_m": 2e-5}}}),
)


# The same of the tip, for the scenes with and without tangential force
TIPS = (
    Cause("tilt 0.15, as it is"),
    Cause("tilt 0.05", {"contact__profile": {"tilt": 0.05}}),
    Cause("tilt 0.02", {"contact__profile": {"tilt": 0.02}}),
    Cause("tilt 0.15, unit of E doubled", {"liner__law__unit_Pa": 1.6e10}),
    Cause("tilt 0.15, unit of E five times", {"liner__law__unit_Pa": 4e10}),
)


def pair(scene: Scene, rom: Rom, index: int) -> dict[str, Any]:
    """Numbers of both coatings under cause ``index`` of ``CAUSES``."""
    cause, numbers = CAUSES[index], {}
    for i, (name, (young, plastic)) in enumerate(COATINGS.items()):
        K = cause.K[i] if cause.K else plastic
        here = of_coating(scene.changed(blade=cause.blade, **cause.changes), young, K)
        numbers[name] = coating(sweep(here, rom), rom)
    return numbers


def tips(scene: Scene, rom: Rom, index: int) -> dict[str, Any]:
    """Numbers without and with tangential force under cause ``index`` of ``TIPS``."""
    here = scene.changed(**TIPS[index].changes)
    of = {"tilted": here.changed(contact__tangential=False), "tangential": here}
    return {name: tip_force(sweep(one, rom), rom) for name, one in of.items()}
