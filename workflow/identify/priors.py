"""Priors of the parameters that the paper leaves open, and the scenes that they give.

A point is a place in the unit cube, one coordinate for each parameter in the order of ``Priors``:
the prior is uniform there.
"""

from collections.abc import Mapping
from math import log
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

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

    def place(self, value: float) -> float:
        """Where a value is, the inverse of ``value``.

        >>> Prior(between=[1, 100], log=True, why="").place(10.0)
        0.5
        """
        low, high = self.between
        return log(value / low) / log(high / low) if self.log else (value - low) / (high - low)


class Priors(SettingsFile):
    """Parameters of the identification."""

    unit_Pa: Prior = Field(description="Unit of E and K (Pa)")
    casing_gaps: Prior = Field(description="Largest inward distortion of the casing over the gap")
    fourth_over_second: Prior = Field(description="Fourth harmonic of the casing over its second")
    constant_over_second: Prior = Field(description="Mean distortion over the second harmonic")
    damping_ratio: Prior = Field(description="Damping ratio of all modes")

    def values(self, points: Points) -> dict[str, NDArray[np.float64]]:
        """Values (points,) of each parameter."""
        return {name: getattr(self, name).value(points[:, i]) for i, name in enumerate(NAMES)}

    def point(self, values: Mapping[str, float]) -> NDArray[np.float64]:
        """Point (parameters,) of values."""
        return np.array([getattr(self, name).place(values[name]) for name in NAMES])


NAMES = tuple(name for name in Priors.model_fields if name not in SettingsFile.model_fields)


def largest_inward(
    fourth: NDArray[np.float64], constant: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Largest of constant + cos 2 theta + fourth cos 4 theta, each over the second harmonic.

    With c = cos 2 theta it is constant + c + fourth (2 c^2 - 1): at c = 1, or for fourth < -1/4 at
    c = -1 / (4 fourth).

    >>> largest_inward(np.array([0.25, -0.5]), np.array([0.75, 0.0]))
    array([2.  , 0.75])
    """
    inside = np.minimum(fourth, -0.25)
    return constant + np.where(fourth < -0.25, -inside - 1 / (8 * inside), 1 + fourth)
