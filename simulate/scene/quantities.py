"""Quantities of a scene: numbers within bounds, ranges, one of several units."""

from collections.abc import Sequence
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from geometry.project import Settings, SettingsError, checked

MOST_ROUNDS = 100_000

Positive = Annotated[float, Field(gt=0)]
# bounds detect wrong units; ``hints`` of the models name the likely slip
Factor = Annotated[float, Field(ge=0, le=1e4)]


class Alternatives(Settings):
    """Settings of which some may be given by one of several keys, each with its own unit."""

    either: ClassVar[Sequence[tuple[str, ...]]]  # keys of which exactly one is given

    @checked
    def _exactly_one_of_each(self) -> None:
        for keys in self.either:
            found = sum(getattr(self, key) is not None for key in keys)
            if found != 1:
                raise SettingsError(
                    f"give exactly one of {', '.join(keys)}; found {found}", allowed=keys
                )


class Range(Settings):
    """Equally spaced values, both ends included."""

    first: Positive = Field(description="First value")
    last: Positive = Field(description="Last value")
    count: int = Field(ge=1, le=100_000, description="Number of values")

    def values(self) -> NDArray[np.float64]:
        """The values (count,), rounded to 12 digits so that 0.31 is 0.31."""
        values = np.linspace(self.first, self.last, self.count)
        return np.array([float(f"{value:.12g}") for value in values])
