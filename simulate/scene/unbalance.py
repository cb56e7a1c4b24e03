"""Orbit of an unbalanced rotor: a synchronous whirl, prescribed, on which contact does not act.

The rotor's centre goes round with it, at the radius A, behind the heavy spot by the lag psi. A
blade at the angle beta from that spot, in the sense of rotation, comes nearer to the casing by
A cos(beta + psi), all around. It is a part of order 0 of the distortion, under its ramp.
"""

from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Discriminator, Field, Tag

from geometry.base import RPM, Settings, known
from simulate.scene.tables import LENGTHS, SPEEDS, Columns, OverSpeed, from_csv

WORST = "worst"
LAGS: Columns = {"lag_deg": ("lag_deg", 1.0)}
RADII: Columns = {f"radius_{unit}": ("radius_um", um) for unit, um in LENGTHS.items()}
Angle = Annotated[
    Annotated[float, Tag("angle")] | Annotated[Literal["worst"], Tag(WORST)],
    Discriminator(lambda value: WORST if isinstance(value, str) else "angle"),
]


class Whirl(OverSpeed):
    """Radius and lag of the orbit over the speed, linear in between."""

    lag_deg: tuple[float, ...] = Field(
        min_length=2, description="Lag behind the heavy spot (deg), 0 at slow speeds"
    )
    radius_um: tuple[Annotated[float, Field(ge=0, le=1e5)], ...] = Field(
        min_length=2, description="Radius of the orbit (um)"
    )


AnyWhirl = Annotated[Whirl, from_csv(Whirl, SPEEDS, LAGS, RADII)]


class Jeffcott(Settings):
    """A Jeffcott rotor: a disc on a flexible shaft (Jeffcott 1919).

    With r the speed over the critical one, A e^{-i psi} = e r^2 / (1 - r^2 + 2 i zeta r).
    """

    hints: ClassVar = {"damping_ratio": "over critical damping: 0.5 % is 0.005"}

    eccentricity_um: float = Field(gt=0, le=1e5, description="Eccentricity of the mass, e (um)")
    critical_rpm: float = Field(gt=0, le=1e6, description="Undamped critical speed (rpm)")
    damping_ratio: float = Field(gt=0, lt=1, description="Damping of the shaft over the critical")


class Unbalance(Settings):
    """Orbit of the rotor, and where the blade is on it."""

    either: ClassVar = [("whirl", "jeffcott")]

    beta_deg: Angle = Field(
        description="Angle of the blade, of blade 0 of a stage, from the heavy spot, in the sense "
        "of rotation (deg); or `worst`: at each speed that of the largest rub, which is an "
        "envelope over the speeds and no blade"
    )
    whirl: AnyWhirl | None = Field(default=None, description="Its orbit over the speed, as a table")
    jeffcott: Jeffcott | None = Field(default=None, description="Or that of a Jeffcott rotor")

    def orbit(self, Omega: float, f1: float) -> tuple[float, float]:
        """Radius A, m, and lag psi, rad, at ``Omega``, rad/s; ``f1`` in Hz.

        >>> rotor = Jeffcott(eccentricity_um=1, critical_rpm=1000, damping_ratio=0.05)
        >>> radius, lag = Unbalance(beta_deg=0, jeffcott=rotor).orbit(872.699 / RPM, f1=1.0)
        >>> round(1e6 * radius, 5), round(float(np.degrees(lag)), 3)
        (3.0, 20.106)
        """
        if self.whirl:
            lag = np.radians(self.whirl.at(Omega, f1, "lag_deg"))
            return self.whirl.at(Omega, f1, "radius_um") / 1e6, float(lag)
        rotor = known(self.jeffcott, "jeffcott")
        r = Omega * RPM / rotor.critical_rpm
        by_shaft = complex(1 - r**2, 2 * rotor.damping_ratio * r)
        return rotor.eccentricity_um / 1e6 * r**2 / abs(by_shaft), float(np.angle(by_shaft))

    def closes(self, blades: int, Omega: float, f1: float) -> NDArray[np.float64]:
        """By how much each of so many ``blades`` comes nearer to the casing (blades,), m."""
        radius, lag = self.orbit(Omega, f1)
        if self.beta_deg == WORST:
            return np.full(blades, radius)
        theta = 2 * np.pi * np.arange(blades) / blades
        return radius * np.cos(np.radians(self.beta_deg) + theta + lag)
