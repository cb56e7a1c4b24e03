"""Tables of a scene: casing over the angle or the rounds, thermal growth over the speed.

Those over angle and speed may be CSV files of a user with two columns of numbers, one over the
other, in units of their names, as the curve of a measured law may (``simulate.scene.laws.table``).
"""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field

from geometry.project import Settings, SettingsError, checked, csv_rows, numbers, shown

type Columns = Mapping[str, tuple[str, float]]  # by the name of a column: key, and factor to SI

SPEEDS: Columns = {name: (name, 1.0) for name in ("speed_over_f1", "speed_rad_s")}
LENGTHS = {"m": 1.0, "mm": 1e-3, "um": 1e-6}
GROWTHS: Columns = {f"growth_{unit}": ("growth_m", metres) for unit, metres in LENGTHS.items()}
ANGLE: Columns = {"theta_deg": ("theta_deg", 1.0)}
DEPTHS: Columns = {f"depth_{unit}": ("depth_m", metres) for unit, metres in LENGTHS.items()}
POINTS = 8192  # angles around the casing at which a function is sampled
LARGEST_DEPTH = 0.1  # m: a larger one is of another unit


def read_curve(path: str | Path, x: Columns, y: Columns) -> dict[str, list[float]]:
    r"""Both columns of a CSV file, in SI, by the keys that their names stand for.

    The header names one of ``x`` and one of ``y``.

    >>> lines = Path("bumps.csv").write_text("theta_deg,depth_mm\n0,0\n90,0.5\n")
    >>> read_curve("bumps.csv", ANGLE, DEPTHS)
    {'theta_deg': [0.0, 90.0], 'depth_m': [0.0, 0.0005]}

    Raises
    ------
    ValueError
        When it cannot be read or has other columns.
    """
    try:
        return _curve(list(csv_rows(path)), x, y)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _curve(lines: list[tuple[int, list[str]]], x: Columns, y: Columns) -> dict[str, list[float]]:
    (at, header), *rows = lines or [(1, [])]
    if len(header) != 2 or header[0] not in x or header[1] not in y:
        raise ValueError(
            f"line {at}: columns {shown(', '.join(header))}: should be {' or '.join(x)}, and "
            f"{' or '.join(y)}"
        )
    points = [numbers(cells, header, line) for line, cells in rows]
    columns = (x[header[0]], y[header[1]])
    return {key: [point[i] * si for point in points] for i, (key, si) in enumerate(columns)}


def from_csv(x: Columns, y: Columns) -> BeforeValidator:
    """Reads the columns of the CSV file at a path; leaves other values unchanged."""
    return BeforeValidator(
        lambda value: read_curve(value, x, y) if isinstance(value, str | Path) else value
    )


class Thermal(Settings):
    """Growth of the tip against the casing over the speed, linear between its speeds.

    It takes from the gap.

    >>> table = Thermal(speed_over_f1=[0, 0.4], growth_m=[0, 2e-5])
    >>> float(table.growth(0.5 * 0.4 * 2 * np.pi * 250.0, f1=250.0).round(9))
    1e-05
    """

    either: ClassVar = [("speed_over_f1", "speed_rad_s")]

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

    @checked
    def _one_table(self) -> None:
        speeds = self._speeds()
        if len(speeds) != len(self.growth_m):
            raise ValueError(
                f"{len(speeds)} speeds and {len(self.growth_m)} growths: give one for each"
            )
        if speeds[0] < 0 or not (np.diff(speeds) > 0).all():
            raise SettingsError("should ascend, from 0 at least", key="speeds")

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


AnyThermal = Annotated[Thermal, from_csv(SPEEDS, GROWTHS)]


class RampTable(Settings):
    """Factor on the distortion over the rounds; what the kernel makes of it: ``contact.ramp``.

    >>> from simulate.contact.ramp import tabled
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

    @checked
    def _ascends(self) -> None:
        if len(self.rounds) != len(self.factor):
            raise ValueError(
                f"{len(self.rounds)} rounds and {len(self.factor)} factors: give one factor for "
                "each round"
            )
        if self.rounds[0] != 0 or not (np.diff(self.rounds) > 0).all():
            raise SettingsError("should ascend from 0", key="rounds", value=self.rounds)
        if min(self.factor) < 0:
            raise SettingsError("allowed from 0", key="factor", value=min(self.factor))


class Table(Settings):
    """Distortion over one round, linear between the angles and from the last to the first.

    >>> bump = Table(theta_deg=[0, 90, 180], depth_m=[0, 4e-5, 0])
    >>> bump.inward(np.radians([45.0, 90.0, 270.0])).round(9)
    array([2.e-05, 4.e-05, 0.e+00])
    """

    theta_deg: list[float] = Field(
        min_length=2,
        description="Angles, ascending, from 0 to 360; or `table: FILE.csv`, with columns "
        "theta_deg and depth_m, depth_mm or depth_um",
    )
    depth_m: list[float] = Field(min_length=2, description="Inward distortion there (m)")

    @checked
    def _one_round(self) -> None:
        _check_round(self.theta_deg, self.depth_m)
        if (deepest := max(map(abs, self.depth_m))) > LARGEST_DEPTH:
            raise SettingsError(
                f"allowed up to {LARGEST_DEPTH:g} m: is the column in mm or um? then name it "
                "depth_mm or depth_um",
                key="depth_m",
                value=deepest,
                allowed={"le": LARGEST_DEPTH},
            )

    def inward(self, theta: NDArray[np.float64]) -> NDArray[np.float64]:
        """d(theta), m; ``theta`` in rad."""
        return np.interp(np.degrees(theta), self.theta_deg, self.depth_m, period=360.0)


def _check_round(theta: list[float], depth: list[float]) -> None:
    if len(theta) != len(depth) or len(theta) < 2:
        raise ValueError(
            f"{len(theta)} angles and {len(depth)} depths: give two angles or more, with a depth "
            "for each"
        )
    if not (np.diff(theta) > 0).all() or theta[0] < 0 or theta[-1] > 360:
        raise SettingsError("should ascend, from 0 at least to 360 at most", key="theta_deg")
    if theta[0] == 0 and theta[-1] == 360 and depth[0] != depth[-1]:
        raise ValueError(f"depths at 0 and 360 deg differ: {depth[0]:g} and {depth[-1]:g} m")


def table_of(function: Callable[[NDArray[np.float64]], Any]) -> dict[str, list[float]]:
    """Angles (deg) and depths (m) of a function d(theta), rad to m, sampled at ``POINTS`` angles.

    >>> table = table_of(lambda theta: 2e-5 * np.cos(2 * theta))
    >>> len(table["theta_deg"]), table["depth_m"][0]
    (8192, 2e-05)

    Raises
    ------
    ValueError
        When it does not return one number for each angle.
    """
    theta = 2 * np.pi * np.arange(POINTS) / POINTS
    depth = np.asarray(function(theta), float)
    if depth.shape != theta.shape:
        raise ValueError(
            f"the function returns depths of shape {depth.shape} for angles of shape {theta.shape}"
        )
    return {"theta_deg": np.degrees(theta).tolist(), "depth_m": depth.tolist()}


def _as_table(value: Any) -> Any:
    """Angles and depths of a function or of the CSV file at a path; other values unchanged."""
    if callable(value):
        return table_of(value)
    if not isinstance(value, str | Path):
        return value
    found = read_curve(value, ANGLE, DEPTHS)
    try:
        _check_round(*found.values())
    except ValueError as error:
        raise ValueError(f"{value}: {error}") from None
    return found


AnyTable = Annotated[Table, BeforeValidator(_as_table)]
