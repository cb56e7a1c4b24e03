"""Thermal growth of the tip against the casing over the speed, as a table from a CSV file."""

from pathlib import Path
from typing import Annotated, Any, Self

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from geometry.settings import Settings, SettingsError
from simulate.curve import read_curve

SPEEDS = {"speed_over_f1": 1.0, "speed_rad_s": 1.0}
GROWTHS = {"growth_m": 1.0, "growth_mm": 1e-3, "growth_um": 1e-6}


class Thermal(Settings):
    """Growth over the speed, linear between its speeds; it takes from the gap.

    >>> table = Thermal(speed_over_f1=[0, 0.4], growth_m=[0, 2e-5])
    >>> float(table.growth(0.5 * 0.4 * 2 * np.pi * 250.0, f1=250.0).round(9))
    1e-05
    """

    speed_over_f1: tuple[float, ...] | None = Field(
        default=None,
        description="Speeds over f1(0), ascending; or `thermal_growth: FILE.csv`, with columns "
        "speed_over_f1 or speed_rad_s, and growth_m, growth_mm or growth_um",
    )
    speed_rad_s: tuple[float, ...] | None = Field(
        default=None, description="The same in rad/s, instead"
    )
    growth_m: tuple[float, ...] = Field(
        min_length=2, description="Growth of the tip's radius less that of the casing there (m)"
    )

    @model_validator(mode="after")
    def _one_table(self) -> Self:
        if (self.speed_over_f1 is None) == (self.speed_rad_s is None):
            raise ValueError("give either speed_over_f1 or speed_rad_s")
        speeds = self._speeds()
        if len(speeds) != len(self.growth_m):
            raise ValueError(
                f"{len(speeds)} speeds and {len(self.growth_m)} growths: give one for each"
            )
        if speeds[0] < 0 or not (np.diff(speeds) > 0).all():
            raise SettingsError("should ascend, from 0 at least", key="speeds")
        return self

    def _speeds(self) -> tuple[float, ...]:
        return self.speed_over_f1 if self.speed_over_f1 is not None else self.speed_rad_s

    def range(self, f1: float) -> tuple[float, float]:
        """First and last speed, rad/s; ``f1`` in Hz."""
        unit = 2 * np.pi * f1 if self.speed_over_f1 is not None else 1.0
        speeds = self._speeds()
        return unit * speeds[0], unit * speeds[-1]

    def growth(self, Omega: float, f1: float) -> float:
        """Growth, m, at ``Omega`` (rad/s); ``f1`` in Hz."""
        at = Omega / (2 * np.pi * f1) if self.speed_over_f1 is not None else Omega
        return np.interp(at, self._speeds(), self.growth_m)


def _as_thermal(value: Any) -> Any:
    """Speeds and growths of the CSV file at a path; other values unchanged."""
    if not isinstance(value, str | Path):
        return value
    speeds, growth, key = read_curve(value, SPEEDS, GROWTHS)
    return {key: speeds, "growth_m": growth}


AnyThermal = Annotated[Thermal, BeforeValidator(_as_thermal)]
