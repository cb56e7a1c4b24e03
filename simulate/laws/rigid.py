"""Rigid law: unilateral contact with the bare casing, the limit of E to infinity.

The force is the reaction of a constraint, u_r <= g0 - a d: it has no formula of its own, and an
explicit scheme cannot find it. Signorini's condition, Eq. (7).
"""

from math import inf
from typing import ClassVar, Literal

from pydantic import Field

from simulate.law import Law


class Rigid(Law):
    """Unilateral contact: no penetration."""

    rigid_from: ClassVar = 0.0

    kind: Literal["rigid"] = Field(description="Bare rigid casing, E infinite: no penetration")

    @property
    def modulus(self) -> float:
        """Infinite."""
        return inf
