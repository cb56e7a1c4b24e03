"""Distortion of the casing over the rounds as a table; what the kernel makes of it: ``ramp``."""

from typing import Self

import numpy as np
from pydantic import Field, model_validator

from geometry.settings import Settings, SettingsError


class RampTable(Settings):
    """Factor on the distortion over the rounds.

    >>> pulse = RampTable(rounds=[0, 1, 3, 4], factor=[0, 1, 1, 0.2])
    >>> tabled(pulse).at(np.array([0.5, 3.5]))
    array([0.5, 0.6])
    """

    rounds: list[float] = Field(
        min_length=1, description="Rounds since the start, ascending, from 0"
    )
    factor: list[float] = Field(
        min_length=1, description="Factor on the distortion there, >= 0, linear between them"
    )

    @model_validator(mode="after")
    def _ascends(self) -> Self:
        if len(self.rounds) != len(self.factor):
            raise ValueError(
                f"{len(self.rounds)} rounds and {len(self.factor)} factors: give one factor for "
                "each round"
            )
        if self.rounds[0] != 0 or not (np.diff(self.rounds) > 0).all():
            raise SettingsError("should ascend from 0", key="rounds", value=self.rounds)
        if min(self.factor) < 0:
            raise SettingsError("allowed from 0", key="factor", value=min(self.factor))
        return self
