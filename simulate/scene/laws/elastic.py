"""Elastic law of the liner, the limit of the plastic law for K to infinity: no wear."""

from typing import ClassVar, Literal, NamedTuple

from pydantic import Field

from simulate.scene.law import Law, Modulus, Unit


class Parameters(NamedTuple):
    """Young's modulus, Pa."""

    E: float


def stress(law, eps, eps_p):
    """Hooke's law: sigma = E eps."""
    return law.E * eps, eps_p, law.E


class Elastic(Law):
    """Linear elastic law."""

    stress: ClassVar = staticmethod(stress)

    kind: Literal["elastic"] = Field(description="no wear, K infinite")
    E: Modulus
    unit_Pa: Unit

    @property
    def parameters(self) -> Parameters:
        """E, Pa."""
        return Parameters(self.E * self.unit_Pa)

    @property
    def modulus(self) -> float:
        """E, Pa."""
        return self.parameters.E
