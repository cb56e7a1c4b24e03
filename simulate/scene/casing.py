"""Casing of a scene: the gap that it leaves, and its distortion over the angle and over time."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product
from math import ceil, gcd, radians
from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field

from geometry.base import RPM, Fault, Settings, SettingsError, checked, known, require, shifted
from geometry.tip import EDGES, counted, slope_of_line
from simulate.scene.casing_modes import AnyModes, CasingMode, Ring
from simulate.scene.tables import (
    LARGEST_DEPTH,
    AnyLine,
    AnyShift,
    AnyTable,
    AnyThermal,
    RampTable,
    Shift,
)

LEADING, TRAILING = EDGES
IN_UM = "in um: 0.1 mm is 100"
OVER_SPAN = "over the span: 0.02 % of it is 2.0e-4"

MOST_ROUNDS = 100_000
COUNTS = 0.05  # of the largest harmonic of a table: those below are noise
HIGHEST_ORDER = 200  # of harmonics, and of the engine orders along which responses are sought
CASING, SIDE_BAND = "casing", "side band"  # what excites an engine order

# bounds detect wrong units; ``hints`` of the models name the likely slip
Factor = Annotated[float, Field(ge=0, le=1e4)]
Gap = Annotated[float, Field(ge=0, le=5e4)]
GapOverSpan = Annotated[float, Field(ge=0, le=0.5)]


def _length(in_um: float | None, share: float | None, whole: float) -> float:
    """Length, m, given in um, or as a ``share`` of another one, ``whole`` (m)."""
    return known(share, "length") * whole if in_um is None else shifted(in_um, -6)


class Clearance(Settings):
    """Gap between tip and liner, linear along the chord, given at two places of it."""

    either: ClassVar = [
        ("leading_edge_um", "leading_edge_over_span"),
        ("trailing_edge_um", "trailing_edge_over_span"),
    ]
    hints: ClassVar = {
        "leading_edge_um": IN_UM,
        "trailing_edge_um": IN_UM,
        "leading_edge_over_span": OVER_SPAN,
        "trailing_edge_over_span": OVER_SPAN,
    }

    leading_edge_um: Gap | None = Field(
        default=None, description="Gap at xi = 1/16 of the chord (um)"
    )
    trailing_edge_um: Gap | None = Field(
        default=None, description="Gap at xi = 15/16 of the chord (um)"
    )
    leading_edge_over_span: GapOverSpan | None = Field(
        default=None, description="Gap at xi = 1/16 of the chord over the blade length"
    )
    trailing_edge_over_span: GapOverSpan | None = Field(
        default=None, description="Gap at xi = 15/16 of the chord over the blade length"
    )
    at: Literal["running", "rest"] = Field(
        default="running",
        description="Gaps at each speed of the sweep, or at rest; then each speed has them less "
        "the static growth of the tip",
    )
    thermal_growth: AnyThermal | None = Field(
        default=None,
        description="With `at: rest`: further growth of the tip over the speed, as a CSV file",
    )

    @checked
    def _growth_is_from_rest(self) -> None:
        if self.thermal_growth is not None and self.at != "rest":
            raise SettingsError(
                "only with `at: rest`: running gaps hold it already", key="thermal_growth"
            )

    def gaps(self, xi: ArrayLike, span: float) -> NDArray[np.float64]:
        """Gaps as given, m, of the shape of the chord fractions ``xi``; ``span``: length, m."""
        first = _length(self.leading_edge_um, self.leading_edge_over_span, span)
        last = _length(self.trailing_edge_um, self.trailing_edge_over_span, span)
        return first + (last - first) * (np.asarray(xi) - LEADING) / (TRAILING - LEADING)


@dataclass(frozen=True)
class Gaps:
    """What the gaps of a scene depend on: given with `clearance`, or by the casing's line."""

    clearance: Clearance | None
    casing: "Casing"

    @property
    def at_rest(self) -> bool:
        """Whether they are given at rest: the growth of the tip takes from them."""
        return self.clearance is None or self.clearance.at == "rest"

    @property
    def vary(self) -> bool:
        """Whether they change with the speed."""
        return self.at_rest or isinstance(self.casing.axial_shift_um, Shift)


class Harmonic(Settings):
    """One harmonic of the casing, amplitude cos(order (theta - speed t) + phase), inward."""

    either: ClassVar = [("amplitude_um", "amplitude_gaps")]
    hints: ClassVar = {
        "amplitude_um": IN_UM,
        "amplitude_gaps": "over the gap: 150 % of it is 1.5",
        "phase_deg": "in degrees",
    }

    order: int = Field(ge=0, le=HIGHEST_ORDER, description="Nodal diameters")
    amplitude_um: float | None = Field(
        default=None, ge=0, le=LARGEST_DEPTH, description="Amplitude (um)"
    )
    amplitude_gaps: Factor | None = Field(
        default=None, description="Amplitude over the gap at xi = 1/16"
    )
    phase_deg: float = Field(
        default=0, ge=-360, le=360, description="Phase (deg), as in cos(order theta + phase)"
    )
    speed_rpm: float = Field(
        default=0,
        ge=-1e6,
        le=1e6,
        description="Speed of travel around the casing, in the sense of rotation (rpm)",
    )

    @checked
    def _what_travels_has_lobes(self) -> None:
        if self.speed_rpm != 0 and self.order == 0:
            raise SettingsError(
                "order 0 is the same all around; allowed 0, or order from 1",
                key="speed_rpm",
                value=self.speed_rpm,
            )

    def size(self, gap: float) -> float:
        """Amplitude, m; ``gap`` at xi = 1/16 in m."""
        return _length(self.amplitude_um, self.amplitude_gaps, gap)

    def turn(self, time: float) -> float:
        """Phase, rad, that passes in ``time``, s."""
        return self.order * (self.speed_rpm / RPM) * time

    def inward(
        self, theta: NDArray[np.float64], gap: float, time: float = 0.0
    ) -> NDArray[np.float64]:
        """Distortion (m), inward, at ``theta`` (rad); ``gap`` at xi = 1/16 in m, time in s."""
        angle = self.order * theta - self.turn(time) + radians(self.phase_deg)
        return self.size(gap) * np.cos(angle)


def side_bands(k: int, harmonics: Iterable[int]) -> set[int]:
    """Orders k +- n that each of the casing's ``harmonics`` n couples to engine order ``k``."""
    return {band for n in harmonics for band in (k - n, k + n) if band > 0}


class Casing(Settings):
    """Casing, whose distortion grows over a ramp or follows a table, and may travel.

    It is rigid, unless it has modes.
    """

    either: ClassVar = [("harmonics", "table"), ("ramp_rounds", "ramp")]
    hints: ClassVar = {
        "scale": "a factor: 127 % is 1.27",
        "slope": "dr/dz: 10 deg are 0.1763",
        "ramp_rounds": "in revolutions of the blade",
    }

    harmonics: list[Harmonic] | None = Field(
        default=None, description="Distortion at the end of the ramp, or where its factor is 1"
    )
    table: AnyTable | None = Field(
        default=None,
        description="The same as a CSV file: angle in degrees, inward depth in m, mm or um",
    )
    scale: Factor = Field(default=1.0, description="Factor on the distortion")
    slope: float | None = Field(
        default=None,
        ge=-1,
        le=1,
        description="Slope dr/dz of the casing, along which the tip slides; by default that of the "
        "tip; 0: contact along the radius. The gaps are those of `clearance`",
    )
    line: AnyLine | None = Field(
        default=None,
        description="Shape of the casing instead of slope and `clearance`: the gap is the line "
        "less the tip, which grows with speed",
    )
    axial_shift_um: AnyShift | None = Field(
        default=None,
        description="Shift of the rotor against the casing, downstream (um), a number or a table "
        "over the speed: the gap changes by the slope times it",
    )
    ramp_rounds: float | None = Field(
        default=None,
        ge=0,
        le=MOST_ROUNDS,
        description="Revolutions over which the distortion grows",
    )
    ramp: RampTable | None = Field(
        default=None, description="Instead of ramp_rounds: the distortion over the revolutions"
    )

    modes: AnyModes | None = Field(
        default=None,
        min_length=1,
        max_length=32,
        description="Modes of a casing that moves under the contact force; by default it is rigid. "
        "Or a CSV file with these keys as columns",
    )
    ring: Ring | None = Field(
        default=None, description="The same of a casing that is a free thin ring"
    )

    @checked
    def _one_slope(self) -> None:
        require(
            (
                self.modes is None or self.ring is None,
                Fault("does not go with casing.modes: take one of them out", "ring"),
            ),
            kind=SettingsError,
        )
        if self.slope is not None and self.line is not None:
            raise SettingsError(
                "does not go with casing.line, which has a slope of its own", key="slope"
            )

    def slope_along(
        self, line: NDArray[np.float64], of_tip: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Slope dr/dz (places,) over the places of the tip's camber ``line`` (places, 3).

        ``of_tip`` (places,): that of the tip, which the casing has where none is given.
        """
        if self.line is not None:
            z = line[:, 2]
            return slope_of_line(self.line.radius(z), z)
        return of_tip if self.slope is None else counted(np.full(len(of_tip), self.slope))

    def shift(self, Omega: float, f1: float) -> float:
        """Shift of the rotor, m, at ``Omega`` (rad/s); ``f1`` in Hz."""
        shift = self.axial_shift_um or 0.0
        return 1e-6 * (shift.at(Omega, f1) if isinstance(shift, Shift) else shift)

    @property
    def moves(self) -> Sequence[CasingMode]:
        """Modes in which it moves; none if it is rigid."""
        return self.ring.modes if self.ring else self.modes or ()

    @property
    def at_start(self) -> float:
        """Share of the distortion at the start."""
        return self.ramp.factor[0] if self.ramp else float(self.ramp_rounds == 0)

    @property
    def changes_until(self) -> int:
        """Round, from 0, at whose start the share of the distortion has taken its last value."""
        if not self.ramp:
            return ceil(known(self.ramp_rounds, "ramp_rounds"))
        factors, rounds = self.ramp.factor, self.ramp.rounds
        changes = (
            end for end, factor in zip(rounds[1:], factors, strict=False) if factor != factors[-1]
        )
        return ceil(max(changes, default=0.0))

    @property
    def travelling(self) -> list[Harmonic]:
        """Harmonics that travel."""
        return [harmonic for harmonic in self.harmonics or () if harmonic.speed_rpm != 0]

    @property
    def orders(self) -> set[int]:
        """Engine orders of the harmonics that stand, of a table of those above ``COUNTS``."""
        if self.table is not None:
            theta = np.pi * np.arange(4 * HIGHEST_ORDER) / (2 * HIGHEST_ORDER)
            sizes = np.abs(np.fft.rfft(self.table.inward(theta)))[1 : HIGHEST_ORDER + 1]
            return {int(n) + 1 for n in np.flatnonzero(sizes > COUNTS * sizes.max())}
        return {
            harmonic.order
            for harmonic in self.harmonics or ()
            if harmonic.order and not harmonic.speed_rpm and harmonic.size(1.0)
        }

    @property
    def excites(self) -> dict[int, str]:
        """What excites each engine order: a harmonic, or else a side band of one."""
        bands = {k for n, m in product(self.orders, repeat=2) for k in side_bands(n, {m})}
        return dict.fromkeys(bands, SIDE_BAND) | dict.fromkeys(self.orders, CASING)

    def drives(self, orders: NDArray[np.int64], forced: Sequence[int] = ()) -> NDArray[np.bool_]:
        """Whether contact with the unworn casing can have each of the ``orders`` (k,).

        A motion that repeats from lobe to lobe has multiples of the orders' common divisor alone,
        of those of the casing and of those ``forced`` on the blade.
        """
        divisor = gcd(*self.orders, *forced)
        return orders % divisor == 0 if divisor else np.zeros(len(orders), bool)

    def inward(
        self, theta: NDArray[np.float64], gap: float, time: float = 0.0
    ) -> NDArray[np.float64]:
        """d(theta) (m), inward, at ``theta`` (rad); ``gap`` at xi = 1/16 in m, ``time`` in s."""
        if self.table is not None:
            return self.scale * self.table.inward(theta)
        return self.scale * sum(
            (harmonic.inward(theta, gap, time) for harmonic in self.harmonics or ()), 0 * theta
        )

    def fixed(self, theta: NDArray[np.float64], gap: float) -> NDArray[np.float64]:
        """The part of d(theta), m, that does not travel."""
        stands = [harmonic for harmonic in self.harmonics or () if harmonic.speed_rpm == 0]
        return self.scale * sum((harmonic.inward(theta, gap) for harmonic in stands), 0 * theta)
