"""Why a run has ended without contact: the blade starts at rest, and nothing has moved it.

So what counts is the still blade: its smallest gap, the largest inward distortion up to the last
round, and what is worn away.
"""

import numpy as np
from numpy.typing import NDArray

from simulate.contact.ramp import ramp_of
from simulate.contact.strips import Strips
from simulate.contact.travelling import farthest
from simulate.scene import Scene
from simulate.scene.law import Law

PROBE = 1e-3  # strain at which a liner with any strength bears
MICRO = 1e6


def why_no_contact(scene: Scene, strips: Strips, eps_p: NDArray[np.float64], rounds: int) -> str:
    """Reason why the tip did not touch: the key, its value and what would have to change.

    ``eps_p`` (strips, nu): plastic strains at the end; ``rounds``: since the casing began to
    distort.
    """
    inward, gap = farthest(strips), float(strips.g0.min())
    ramp, key = ramp_of(scene.casing), "ramp_rounds" if scene.casing.ramp is None else "ramp"
    share = float(ramp.bounds(ramp.numbers, 0.0, float(rounds))[1])
    known = f"the smallest gap is {MICRO * gap:.4g} um"
    what = "scale: 0" if scene.casing.scale == 0 else "the distortion is nowhere inward"
    reasons = (
        (
            not bears(scene.liner.law) and eps_p.any(),
            "liner.law: sigma_Y and K are 0: the tip wears the liner without any force",
        ),
        (inward <= 0, f"casing.{what}: nothing brings the liner to the tip; {known}"),
        (
            inward <= gap,
            f"clearance: {known}, the largest inward distortion {MICRO * inward:.4g} um: a blade "
            "at rest is not reached; widen casing or scale, or narrow the gap",
        ),
        (
            share * inward <= gap,
            f"casing.{key}: does not bring it in far enough within the {rounds} rounds: the "
            f"distortion has grown to {MICRO * share * inward:.4g} um of "
            f"{MICRO * inward:.4g} um; {known}",
        ),
        (
            eps_p.any(),
            f"start: the liner is worn by more than the casing's distortion; {known}",
        ),
        (
            scene.casing.travelling,
            f"casing.harmonics: those that travel did not add up to the gap; {known}",
        ),
        (
            True,
            "integrator: the tip passes between the steps over what it would touch: shorten them",
        ),
    )
    return next(reason for holds, reason in reasons if holds)


def bears(law: Law) -> bool:
    """Whether a rod that is strained bears any stress: not with sigma_Y and K of 0."""
    return not law.deforms or law.stress(law.parameters, PROBE, 0.0)[0] > 0.0
