"""Priors of the parameters that the paper leaves open, and the scenes that they give.

A point is a place in the unit cube, one coordinate for each parameter in the order of ``Priors``:
the prior is uniform there.
"""

from collections.abc import Iterable
from math import log
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from scipy.stats import qmc

from geometry.project import Settings, SettingsError, SettingsFile, checked

type Points = NDArray[np.float64]  # (points, parameters), in the unit cube


class Prior(Settings):
    """Range of a parameter; the density is uniform in it or in its logarithm."""

    between: Annotated[list[float], Field(min_length=2, max_length=2)] = Field(
        description="Lowest and highest value"
    )
    log: bool = Field(default=False, description="Uniform in the logarithm")
    why: str = Field(description="Reason for the range")

    @checked
    def _ascending(self) -> None:
        low, high = self.between
        if not low < high:
            raise SettingsError(
                "the first should be below the second", key="between", value=self.between
            )
        if self.log and low <= 0:
            raise SettingsError(
                "should be above 0 for a logarithm", key="between", value=self.between
            )

    def value(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Values at the places ``u`` in [0, 1].

        >>> Prior(between=[1, 100], log=True, why="").value(np.array([0.0, 0.5, 1.0]))
        array([  1.,  10., 100.])
        """
        low, high = self.between
        return low * (high / low) ** u if self.log else low + (high - low) * u

    @property
    def width(self) -> float:
        """Width of the range, of the logarithm where the density is uniform in it."""
        low, high = self.between
        return log(high / low) if self.log else high - low

    def place(self, value: float) -> float:
        """Where a value is, the inverse of ``value``.

        >>> Prior(between=[1, 100], log=True, why="").place(10.0)
        0.5
        """
        low = self.between[0]
        return (log(value / low) if self.log else value - low) / self.width


class Priors(SettingsFile):
    """Parameters of the identification."""

    span_mm: Prior = Field(description="Hub to tip (mm)")
    tip_lean_tangential_mm: Prior = Field(description="Lean of the tip, in rotation (mm)")
    tip_lean_axial_mm: Prior = Field(description="Lean of the tip, downstream (mm)")
    hub_thickness_mm: Prior = Field(description="Largest thickness of the hub section (mm)")
    tip_thickness_mm: Prior = Field(description="Largest thickness of the tip section (mm)")
    hub_stagger_deg: Prior = Field(description="Stagger of the hub section (deg)")
    tip_stagger_deg: Prior = Field(description="Stagger of the tip section (deg)")
    unit_Pa: Prior = Field(description="Unit of E and K (Pa)")
    casing_gaps: Prior = Field(description="Largest inward distortion of the casing over the gap")
    fourth_over_second: Prior = Field(description="Fourth harmonic of the casing over its second")
    constant_over_second: Prior = Field(description="Mean distortion over the second harmonic")
    fifth_over_second: Prior = Field(description="Fifth harmonic over the second, of Fig. 14")
    damping_ratio: Prior = Field(description="Damping ratio of all modes")

    def values(
        self, points: Points, names: Iterable[str] | None = None
    ) -> dict[str, NDArray[np.float64]]:
        """Values (points,) of all parameters, or of ``names``, which the columns of points are."""
        columns = enumerate(NAMES if names is None else names)
        return {name: getattr(self, name).value(points[:, i]) for i, name in columns}


NAMES = tuple(name for name in Priors.model_fields if name not in SettingsFile.model_fields)
SHAPE = {  # keys of `sections` of a blade, by parameter; the first ones
    "span_mm": "span_mm",
    "tip_lean_tangential_mm": "tip_lean_tangential_mm",
    "tip_lean_axial_mm": "tip_lean_axial_mm",
    "hub_thickness_mm": "hub__thickness_mm",
    "tip_thickness_mm": "tip__thickness_mm",
    "hub_stagger_deg": "hub__stagger_deg",
    "tip_stagger_deg": "tip__stagger_deg",
}


def sobol(number: int, dimensions: int, seed: int) -> Points:
    """The first points of a scrambled Sobol sequence; a power of 2 fills the cube evenly."""
    return qmc.Sobol(dimensions, rng=np.random.default_rng(seed)).random(number)
