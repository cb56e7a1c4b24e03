"""Base class of the liner laws; each file of ``laws`` beside it holds a subclass of ``Law``."""

from collections import namedtuple
from functools import cache
from types import FunctionType
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np
from pydantic import Field

from geometry.base import Settings, fingerprint, imported_by, shifted

STRAINS = np.geomspace(1e-12, 1.0, 257)  # at which the slope of a law is sampled
PROBE = 1e-3  # strain at which a liner with any strength bears

Unit = Annotated[float, Field(gt=0, le=1e9, description="Unit of the law's moduli (MPa)")]
Modulus = Annotated[float, Field(gt=0, le=1e9, description="Young's modulus (in unit_MPa)")]


@cache
def numbers_of(*names: str) -> Any:
    """Type of named tuples with the parameters ``names`` of a law: one for each set of names."""
    return namedtuple("Numbers", names)


class Law(Settings):
    """Base of the liner laws.

    A law has its parameters as fields, and two functions:

    ``stress(parameters, eps, eps_p)``
        Stress (Pa), plastic strain and tangent d sigma / d eps (Pa) at total strain eps > 0, from
        plastic strain eps_p.
    ``plastic_work(parameters, before, after)``
        Work (J/m3) of a plastic strain that grows from ``before`` to ``after``.

    Both are plain functions without ``self``, which are compiled; ``parameters`` is a named
    tuple of the fields. By default a rod carries no load and does not wear. Laws of this project
    have a literal field ``kind``, their name in scene files; any other law is named
    ``module:class`` there (``simulate.scene.own_laws``).

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

    The computation assumes: no tension; a stress that does not fall with growing strain and whose
    slope is at most ``modulus``; a plastic strain that never falls; unloading with ``modulus``, so
    that the elastic energy (J/m3) is sigma (eps - eps_p) / 2, and elastic energy and plastic work
    together are the integral of sigma over eps.
    """

    touches: ClassVar[bool] = True  # whether there is contact at all
    deforms: ClassVar[bool] = True  # False: the rod is rigid
    code_files: ClassVar[dict[str, str]] = {}  # of a law of one's own: hashes of its code, by path
    code_hash: ClassVar[str | None] = None  # of all of them; without a file of what is compiled

    @staticmethod
    def stress(law, eps, eps_p):
        """Stress, plastic strain and tangent of a rod that carries no load."""
        return 0.0, eps_p, 0.0

    @staticmethod
    def plastic_work(law, before, after):
        """Plastic work of a rod that does not wear."""
        return 0.0

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        """Make static methods of the functions, which have no ``self``, and note its code."""
        for name in ("stress", "plastic_work"):
            if isinstance(function := vars(cls).get(name), FunctionType):
                setattr(cls, name, staticmethod(function))
        if not cls.__module__.startswith("simulate."):
            cls.code_files = imported_by(cls.__module__)
            codes = (of.__code__ for of in (cls.stress, cls.plastic_work))
            compiled = [repr((of.co_code, of.co_consts, of.co_names)) for of in codes]
            cls.code_hash = fingerprint([*cls.code_files.values()] or compiled)

    @property
    def called(self) -> str:
        """Its ``kind`` in scene files: ``module:class`` of a law from elsewhere."""
        return getattr(self, "kind", f"{type(self).__module__}:{type(self).__qualname__}")

    @property
    def parameters(self) -> NamedTuple:
        """Parameters of the law as ``stress`` reads them, SI."""
        values = {name: float(value) for name, value in self if name != "kind"}
        return numbers_of(*values)(**values)

    @property
    def modulus(self) -> float:
        """Largest slope of the stress, Pa: it sets the stability limit of central differences.

        By default that of a rod without plastic strain, sampled at strains from 1e-12 to 1.
        """
        return float(max(self.stress(self.parameters, eps, 0.0)[2] for eps in STRAINS))

    @property
    def has_strength(self) -> bool:
        """Whether a rod that is strained bears any stress: not with sigma_Y and K of 0."""
        return not self.deforms or self.stress(self.parameters, PROBE, 0.0)[0] > 0.0


class Unloading(Law):
    """Base of the laws of this project that unload along ``E``; moduli are in ``unit_MPa``."""

    kind: str
    E: Modulus
    unit_MPa: Unit

    @property
    def unit_Pa(self) -> float:
        """The unit, Pa."""
        return shifted(self.unit_MPa, 6)

    @property
    def parameters(self) -> NamedTuple:
        """All numbers of the law, Pa."""
        moduli = {
            name: value * self.unit_Pa for name, value in self if name not in ("kind", "unit_MPa")
        }
        return numbers_of(*moduli)(**moduli)

    @property
    def modulus(self) -> float:
        """E, the unloading slope, Pa."""
        return self.E * self.unit_Pa
