"""Rotational speeds of a sweep."""

from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Discriminator, Field, Tag

from geometry.base import RPM, Settings, SettingsError, checked

Positive = Annotated[float, Field(gt=0)]


class Range(Settings):
    """Equally spaced values, both ends included."""

    first: Positive = Field(description="First value")
    last: Positive = Field(description="Last value")
    count: int = Field(ge=1, le=100_000, description="Number of values")

    def values(self) -> NDArray[np.float64]:
        """The values (count,), rounded to 12 digits so that 0.31 is 0.31."""
        values = np.linspace(self.first, self.last, self.count)
        return np.array([float(f"{value:.12g}") for value in values])


# chosen by the kind of value, so that an error is reported for the form that was meant
SpeedValues = Annotated[
    Annotated[Range, Tag("range")] | Annotated[list[Positive], Field(min_length=1), Tag("list")],
    Discriminator(lambda value: "range" if isinstance(value, dict | Range) else "list"),
]


OVER_F1, OF_RPM = (1e-4, 20.0), (9.5, 1e6)  # slowest and fastest speed
UNITS = {  # by key: these, and the likely slips
    "over_f1": (OVER_F1, "0.3 is usual; speeds in rpm are speeds.rpm"),
    "rpm": (OF_RPM, "1 Hz is 60 rpm; speeds over f1(0) are given as speeds.over_f1"),
}


class Speeds(Settings):
    """Rotational speeds of the sweep."""

    either: ClassVar = [tuple(UNITS)]

    over_f1: SpeedValues | None = Field(
        default=None, description="Speeds over f1(0), revolutions per second over Hz"
    )
    rpm: SpeedValues | None = Field(default=None, description="Speeds (rpm)")

    in_turn: bool = Field(
        default=False,
        description="Each run continues from the end of the previous run, in the order of the list",
    )

    @checked
    def _of_their_unit(self) -> None:
        """Refuse speeds that are of another unit."""
        allowed, slips = UNITS[self.unit]
        for speed in self.given:
            if not allowed[0] <= speed <= allowed[1]:
                raise SettingsError(
                    f"allowed from {allowed[0]:g} to {allowed[1]:g}; {slips}",
                    key=self.unit,
                    value=float(speed),
                    allowed=allowed,
                )

    @property
    def unit(self) -> str:
        """Key by which they are given."""
        return next(unit for unit in UNITS if getattr(self, unit) is not None)

    @property
    def given(self) -> NDArray[np.float64]:
        """Speeds (count,) in their unit."""
        values = getattr(self, self.unit)
        return values.values() if isinstance(values, Range) else np.array(values)

    @property
    def count(self) -> int:
        """Number of speeds."""
        return len(self.given)

    def in_rad_s(self, f1: float) -> float:
        """Their unit, rad/s; ``f1`` in Hz."""
        return {"over_f1": 2 * np.pi * f1, "rpm": 1 / RPM}[self.unit]

    def omega(self, f1: float) -> NDArray[np.float64]:
        """Omega (speeds,), rad/s; ``f1`` in Hz."""
        return self.in_rad_s(f1) * self.given
