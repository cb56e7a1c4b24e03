"""Rigid law: unilateral contact with the bare casing, the limit of E to infinity.

Signorini's condition: the gap of Eq. (7) does not close further than to 0, and the force is the
reaction that keeps it there, never tension. It has no formula of its own (the rods bear nothing
before they are rigid), so a scheme must find it with the motion, which an explicit one cannot.
Reference: Carpenter, Taylor and Katona 1991.
"""

from math import inf
from typing import ClassVar, Literal

from pydantic import Field

from simulate.law import Law


class Rigid(Law):
    """Unilateral contact: no penetration."""

    rigid_from: ClassVar = 0.0

    kind: Literal["rigid"] = Field(description="bare rigid casing, no penetration, E infinite")

    @property
    def modulus(self) -> float:
        """Infinite."""
        return inf
