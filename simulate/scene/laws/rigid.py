"""Rigid law: unilateral contact with the bare casing, the limit of E to infinity.

Signorini's condition: the gap of Eq. (7) is never negative, and the contact force is the reaction
that keeps it so, never tensile. This reaction is no function of the strain: it is solved for with
the motion, which an explicit scheme cannot do. Reference: Carpenter, Taylor and Katona 1991.
"""

from math import inf
from typing import ClassVar, Literal

from pydantic import Field

from simulate.scene.law import Law


class Rigid(Law):
    """Unilateral contact: no penetration."""

    deforms: ClassVar = False

    kind: Literal["rigid"] = Field(description="bare rigid casing, no penetration, E infinite")

    @property
    def modulus(self) -> float:
        """Infinite."""
        return inf
