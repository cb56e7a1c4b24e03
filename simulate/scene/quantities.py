"""Quantities of a scene: numbers within bounds, ranges, one of several units."""

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from geometry.project import Settings

MOST_ROUNDS = 100_000

Positive = Annotated[float, Field(gt=0)]
# bounds detect wrong units; ``hints`` of the models name the likely slip
Factor = Annotated[float, Field(ge=0, le=1e4)]


class Range(Settings):
    """Equally spaced values, both ends included."""

    first: Positive = Field(description="First value")
    last: Positive = Field(description="Last value")
    count: int = Field(ge=1, le=100_000, description="Number of values")

    def values(self) -> NDArray[np.float64]:
        """The values (count,), rounded to 12 digits so that 0.31 is 0.31."""
        values = np.linspace(self.first, self.last, self.count)
        return np.array([float(f"{value:.12g}") for value in values])
