"""What a liner law tells the march; each file of ``simulate/laws`` holds a subclass of ``Law``."""

from typing import Annotated, Any, ClassVar, NamedTuple

from pydantic import Field

from geometry.settings import Settings

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


class Law(Settings):
    """Base of the liner laws.

    A law has a literal field ``kind``, its name in the scene, and

    ``stress(parameters, eps, eps_p)``
        Stress (Pa), plastic strain and tangent d sigma / d eps (Pa) at total strain eps > 0, from
        plastic strain eps_p.
    ``plastic_work(parameters, before, after)``
        Work (J/m3) that takes the plastic strain from ``before`` to ``after``.

    Both are plain functions, which the march compiles. The defaults bear nothing and do not wear.

    The march relies on this: there is no tension; the stress never falls as the strain grows, nor
    rises faster than ``modulus``; the plastic strain never falls; unloading is linear, so that the
    elastic energy (J/m3) is sigma (eps - eps_p) / 2, and with the plastic work it is the integral
    of sigma over eps.
    """

    stress: ClassVar[Any] = staticmethod(no_stress)
    plastic_work: ClassVar[Any] = staticmethod(no_work)
    touches: ClassVar[bool] = True  # whether there is contact at all
    rigid_from: ClassVar[float | None] = None  # strain at which a rod gives no further, if any

    @property
    def parameters(self) -> NamedTuple:
        """Numbers of the law as ``stress`` reads them, SI."""
        return NoParameters()

    @property
    def modulus(self) -> float:
        """Largest slope of the stress, Pa: it sets the stability limit of central differences."""
        return 0.0
