"""Elastic law of the liner, the limit of the plastic law for K to infinity: no wear."""

from typing import Literal

from pydantic import Field

from simulate.scene.law import Unloading


class Elastic(Unloading):
    """Linear elastic law."""

    kind: Literal["elastic"] = Field(description="no wear, K infinite")

    @staticmethod
    def stress(law, eps, eps_p):
        """Hooke's law: sigma = E eps."""
        return law.E * eps, eps_p, law.E
