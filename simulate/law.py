"""What a liner law tells the march; each file of ``simulate/laws`` holds a subclass of ``Law``."""

from collections import namedtuple
from functools import cache
from types import FunctionType
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np
from pydantic import Field

from geometry.settings import Settings

STRAINS = np.geomspace(1e-12, 1.0, 257)  # at which the slope of a law is looked at

Unit = Annotated[float, Field(gt=0, le=1e15, description="Unit of the law's moduli (Pa)")]
Modulus = Annotated[float, Field(gt=0, le=1e9, description="Young's modulus (in unit_Pa)")]


class NoParameters(NamedTuple):
    """A law without numbers."""


def no_stress(law, eps, eps_p):
    """A rod that bears nothing."""
    return 0.0, eps_p, 0.0


def no_work(law, before, after):
    """A rod that does not wear."""
    return 0.0


@cache
def _numbers(*names: str) -> Any:
    """A named tuple of a law's numbers."""
    return namedtuple("Numbers", names)


class Law(Settings):
    """Base of the liner laws.

    A law has its numbers as fields, and


    ``stress(parameters, eps, eps_p)``
        Stress (Pa), plastic strain and tangent d sigma / d eps (Pa) at total strain eps > 0, from
        plastic strain eps_p.
    ``plastic_work(parameters, before, after)``
        Work (J/m3) that takes the plastic strain from ``before`` to ``after``.

    Both are plain functions without ``self``, which the march compiles; ``parameters`` has the
    numbers by their names. The defaults bear nothing and do not wear. Those of this project also
    have a literal field ``kind``, their name in scene files; another's name there is
    ``module:class``.

    >>> class PerfectlyPlastic(Law):
    ...     E: float  # Pa
    ...     sigma_Y: float  # Pa
    ...
    ...     def stress(law, eps, eps_p):
    ...         sigma = law.E * (eps - eps_p)
    ...         if sigma <= 0.0:  # open: no tension
    ...             return 0.0, eps_p, 0.0
    ...         if sigma < law.sigma_Y:
    ...             return sigma, eps_p, law.E
    ...         return law.sigma_Y, eps - law.sigma_Y / law.E, 0.0
    ...
    ...     def plastic_work(law, before, after):
    ...         return law.sigma_Y * (after - before)
    >>> PerfectlyPlastic(E=2e9, sigma_Y=1e5).modulus
    2000000000.0

    The march relies on this: there is no tension; the stress never falls as the strain grows, nor
    rises faster than ``modulus``; the plastic strain never falls; unloading is linear, so that the
    elastic energy (J/m3) is sigma (eps - eps_p) / 2, and with the plastic work it is the integral
    of sigma over eps.
    """

    stress: ClassVar[Any] = staticmethod(no_stress)
    plastic_work: ClassVar[Any] = staticmethod(no_work)
    touches: ClassVar[bool] = True  # whether there is contact at all
    rigid_from: ClassVar[float | None] = None  # strain at which the backing is rigid, if any

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        """Take the formulas as they are written, without ``self``."""
        for name in ("stress", "plastic_work"):
            if isinstance(function := vars(cls).get(name), FunctionType):
                setattr(cls, name, staticmethod(function))

    @property
    def parameters(self) -> NamedTuple:
        """Numbers of the law as ``stress`` reads them, SI."""
        names = [name for name in type(self).model_fields if name != "kind"]
        if not names:
            return NoParameters()
        return _numbers(*names)(*(float(getattr(self, name)) for name in names))

    @property
    def modulus(self) -> float:
        """Largest slope of the stress, Pa: it sets the stability limit of central differences.

        Of a fresh rod at strains from 1e-12 to 1, where a law does not give its own.
        """
        return float(max(self.stress(self.parameters, eps, 0.0)[2] for eps in STRAINS))
