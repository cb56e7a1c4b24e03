"""Tables of a scene: casing over angle, revolutions or length, growth and shift over the speed.

All but those over revolutions may be CSV files of a user with two columns of numbers, one over the
other, in units of their names, as the curve of a measured law may (``simulate.scene.laws.table``).
"""

from collections.abc import Callable, Mapping, Sequence
from math import inf
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag

from geometry.base import (
    RPM,
    Fault,
    Settings,
    SettingsError,
    check_settings,
    checked,
    csv_rows,
    known,
    numbers,
    require,
    shown,
    unquoted,
)

# by the name of a column: key, and factor to its unit
type Columns = Mapping[str, tuple[str, float]]
type Lines = list[tuple[int, list[str]]]  # number and cells of each

SPEEDS: Columns = {
    **{name: (name, 1.0) for name in ("speed_over_f1", "speed_rpm")},
    "speed_rad_s": ("speed_rpm", RPM),
}
LENGTHS = {"m": 1e6, "mm": 1e3, "um": 1.0}  # in um
GROWTHS: Columns = {f"growth_{unit}": ("growth_um", um) for unit, um in LENGTHS.items()}
ANGLE: Columns = {"theta_deg": ("theta_deg", 1.0)}
DEPTHS: Columns = {f"depth_{unit}": ("depth_um", um) for unit, um in LENGTHS.items()}
SHIFTS: Columns = {f"shift_{unit}": ("shift_um", um) for unit, um in LENGTHS.items()}
Z: Columns = {"z_mm": ("z_mm", 1.0)}
RADII: Columns = {"r_mm": ("r_mm", 1.0)}
RADIANS, FEW = 6.3, 2  # last of more than so many angles, where they are not degrees
WIDEST, CHANGE = 180.0, 0.05  # degrees from the last angle to the first, over a change of depth
POINTS = 8192  # angles around the casing at which a function is sampled
LARGEST_DEPTH = 1e5  # um: a larger one is of another unit


def from_csv(model: type[Settings], *columns: Columns) -> BeforeValidator:
    """Reads a ``model`` from the CSV file at a path; leaves other values unchanged.

    Its header names one of each of the ``columns``, in order. A fault has the path before it: that
    of the scene, and the line in it, come on top.
    """
    return _of_file(lambda lines: check_settings(model, _columns(lines, columns), ""))


def rows_from_csv(model: type[Settings]) -> BeforeValidator:
    """Reads a list of a ``model`` from the rows of a CSV file, whose columns are its keys."""

    def of_rows(lines: Lines) -> list[Settings]:
        """One in each row below the first."""
        (at, header), *rows = lines or [(1, [])]
        if len({*header}) < len(header) or {*header} - {*model.model_fields}:
            raise ValueError(
                f"line {at}: columns {shown(', '.join(header))}: should be some of "
                f"{', '.join(model.model_fields)}, each once"
            )
        return [_row(model, header, *row) for row in rows]

    return _of_file(of_rows)


def column_from_csv(names: Columns) -> BeforeValidator:
    """Reads a list of numbers from a CSV file of one column, one of ``names``."""

    def of_column(lines: Lines) -> list[float]:
        """Its numbers, in the unit of the key."""
        (at, header), *rows = lines or [(1, [])]
        if len(header) != 1 or header[0] not in names:
            raise ValueError(
                f"line {at}: columns {shown(', '.join(header))}: should be {' or '.join(names)}"
            )
        _, unit = names[header[0]]
        return [unit * numbers(cells, header, line)[0] for line, cells in rows]

    return _of_file(of_column)


def _of_file(of_lines: Callable[[Lines], Any]) -> BeforeValidator:
    """Reads what the lines of the CSV file at a path hold; leaves other values unchanged."""

    def read(value: Any) -> Any:
        """What is in the file at a path; any other value as it is."""
        if not isinstance(value, str | Path):
            return value
        with unquoted(value):
            try:
                return of_lines(list(csv_rows(value)))
            except ValueError as error:
                raise ValueError(f"{value}: {error}") from None

    return BeforeValidator(read)


def _row(model: type[Settings], header: Sequence[str], line: int, cells: Sequence[str]) -> Settings:
    """The ``model`` in a line of a CSV file; empty cells are not given."""
    found = numbers([cell or "0" for cell in cells], header, line)
    named = zip(header, cells, found, strict=True)
    values = {name: value for name, cell, value in named if cell}
    try:
        return check_settings(model, values, "")
    except ValueError as error:
        raise ValueError(f"{error} (line {line})") from None


def _columns(lines: Lines, columns: Sequence[Columns]) -> dict[str, list[float]]:
    """The columns of a CSV file, in their units, by the keys that their names stand for."""
    (at, header), *rows = lines or [(1, [])]
    named = zip(header, columns, strict=False)
    if len(header) != len(columns) or not all(name in of for name, of in named):
        raise ValueError(
            f"line {at}: columns {shown(', '.join(header))}: should be "
            f"{', and '.join(' or '.join(of) for of in columns)}"
        )
    points = [numbers(cells, header, line) for line, cells in rows]
    keys = (of[name] for name, of in zip(header, columns, strict=True))
    return {key: [point[i] * unit for point in points] for i, (key, unit) in enumerate(keys)}


def ascending(
    says: str, first: float = inf, last: float = inf, least: float = 0.0
) -> AfterValidator:
    """Refuses numbers that do not ascend from ``least``, 0; ``says``: the rule in words.

    ``first``: largest first one; ``last``: largest of all.
    """

    def check(values: Sequence[float]) -> Sequence[float]:
        """The values, if they ascend within the bounds."""
        between = least <= min(values, default=0) <= first and max(values, default=0) <= last
        if not (between and (np.diff(values) > 0).all()):
            raise SettingsError(f"should ascend{says}", value=values)
        return values

    return AfterValidator(check)


class Points(Settings):
    """Base of a line through points: columns of numbers, one over the other."""

    @checked
    def _as_many_of_each(self) -> None:
        lengths = {name: len(column) for name, column in self if column is not None}
        if len({*lengths.values()}) > 1:
            counts = " and ".join(f"{length} {name}" for name, length in lengths.items())
            raise ValueError(f"{counts}: give one for each")


FROM_0 = ascending(", from 0 at least")
AROUND = ", from 0 at least to 360 at most"


class OverSpeed(Points):
    """Base of values over the speed, linear between its speeds."""

    either: ClassVar = [("speed_over_f1", "speed_rpm")]

    speed_over_f1: Annotated[tuple[float, ...], FROM_0] | None = Field(
        default=None,
        description="Speeds over f1(0), ascending; or FILE.csv in place of the table, with columns "
        "speed_over_f1 or speed_rpm, and the others in the same order, lengths in m, mm or um: "
        "growth_um, shift_um, radius_um",
    )
    speed_rpm: Annotated[tuple[float, ...], FROM_0] | None = Field(
        default=None, description="The same in rpm, instead"
    )

    def _speeds(self) -> tuple[float, ...]:
        return self.speed_over_f1 or known(self.speed_rpm, "speed_rpm")

    def _unit(self, f1: float) -> float:
        """1 rad/s in the unit of the speeds; ``f1`` in Hz."""
        return RPM if self.speed_over_f1 is None else 1 / (2 * np.pi * f1)

    def range(self, f1: float) -> tuple[float, float]:
        """First and last speed, rad/s; ``f1`` in Hz."""
        speeds, unit = self._speeds(), self._unit(f1)
        return speeds[0] / unit, speeds[-1] / unit

    def at(self, Omega: float, f1: float, key: str = "") -> float:
        """The value of a ``key``, by default the last, at ``Omega`` (rad/s); ``f1`` in Hz."""
        *_, (last, _) = self
        return float(np.interp(Omega * self._unit(f1), self._speeds(), dict(self)[key or last]))


class Thermal(OverSpeed):
    """Growth of the tip against the casing over the speed. The growth reduces the gap.

    >>> table = Thermal(speed_over_f1=[0, 0.4], growth_um=[0, 20])
    >>> round(table.at(0.5 * 0.4 * 2 * np.pi * 250.0, f1=250.0), 9)
    10.0
    """

    growth_um: tuple[float, ...] = Field(
        min_length=2, description="Growth of the tip's radius less growth of the casing (um)"
    )


class Shift(OverSpeed):
    """Axial displacement of the rotor against the casing over the speed."""

    shift_um: tuple[float, ...] = Field(min_length=2, description="Shift downstream (um)")


class Line(Points):
    """Shape of the casing: its radius along the engine axis, linear between points.

    >>> cone = Line(z_mm=[-20, 80], r_mm=[250, 230])
    >>> cone.radius(np.array([0.0, 0.03])).round(6)
    array([0.246, 0.24 ])
    """

    z_mm: Annotated[list[float], ascending("", least=-inf)] = Field(
        min_length=2,
        description="Along the engine axis, downstream, from the origin of the blade's file (mm); "
        "or `line: FILE.csv`, with columns z_mm and r_mm",
    )
    r_mm: list[Annotated[float, Field(gt=0)]] = Field(
        min_length=2, description="Radius of the liner there (mm)"
    )

    def radius(self, z: NDArray[np.float64]) -> NDArray[np.float64]:
        """Radius, m, at ``z``, m; beyond the ends that of the ends."""
        return np.interp(1e3 * z, self.z_mm, self.r_mm) / 1e3


AnyThermal = Annotated[Thermal, from_csv(Thermal, SPEEDS, GROWTHS)]
AnyLine = Annotated[Line, from_csv(Line, Z, RADII)]
# chosen by the kind of value, so that an error is reported for the form that was meant
AnyShift = Annotated[
    Annotated[float, Tag("number")]
    | Annotated[Shift, from_csv(Shift, SPEEDS, SHIFTS), Tag("table")],
    Discriminator(lambda value: "number" if isinstance(value, int | float) else "table"),
]


class RampTable(Points):
    """Factor on the distortion over the revolutions; in the kernel: ``contact.ramp``.

    >>> from simulate.contact.ramp import tabled
    >>> pulse = RampTable(rounds=[0, 1, 3, 4], factor=[0, 1, 1, 0.2])
    >>> tabled(pulse).at(np.array([0.5, 3.5]))
    array([0.5, 0.6])
    """

    rounds: Annotated[list[float], ascending(" from 0", first=0)] = Field(
        min_length=1, description="Revolutions since the start, ascending, from 0"
    )
    factor: list[Annotated[float, Field(ge=0)]] = Field(
        min_length=1, description="Factor on the distortion, >= 0, linear in between"
    )


class Table(Points):
    """Distortion over one revolution, linear between the angles and from the last to the first.

    >>> bump = Table(theta_deg=[0, 90, 180], depth_um=[0, 40, 0])
    >>> bump.inward(np.radians([45.0, 90.0, 270.0])).round(9)
    array([2.e-05, 4.e-05, 0.e+00])
    """

    theta_deg: Annotated[list[float], ascending(AROUND, last=360)] = Field(
        min_length=2,
        description="Angles, ascending, from 0 to 360; or `table: FILE.csv`, with columns "
        "theta_deg and depth_um, depth_mm or depth_m",
    )
    depth_um: list[float] = Field(
        min_length=2, description="Inward distortion at these angles (um)"
    )

    @checked
    def _one_round(self) -> None:
        (first, *_, last), depth = self.theta_deg, self.depth_um
        deepest, rise = max(map(abs, depth)), abs(depth[0] - depth[-1])
        require(
            (
                (first, last) != (0, 360) or rise == 0,
                f"depths at 0 and 360 deg, which are one place, differ: {depth[0]:g} and "
                f"{depth[-1]:g} um: leave the row at 360 out, or give both their mean",
            ),
            (
                deepest <= LARGEST_DEPTH,
                Fault(
                    f"allowed up to {LARGEST_DEPTH:g} um: name the column by its unit, depth_m, "
                    "depth_mm or depth_um",
                    "depth_um",
                    deepest,
                    {"le": LARGEST_DEPTH},
                ),
            ),
            (
                len(depth) <= FEW or last > RADIANS,
                Fault(
                    f"the last of {len(depth)} angles: are they radians? A bump as narrow as that "
                    "in degrees needs rows at 0 and 360 besides",
                    "theta_deg",
                    last,
                ),
            ),
            (
                first + 360.0 - last <= WIDEST or rise <= CHANGE * np.ptp(depth),
                Fault(
                    f"no depth from {last:g} on to {first:g} deg, where it changes by {rise:g} um: "
                    "give angles all around, 0 to 360",
                    "theta_deg",
                ),
            ),
            kind=SettingsError,
        )

    def inward(self, theta: NDArray[np.float64]) -> NDArray[np.float64]:
        """d(theta), m; ``theta`` in rad."""
        return np.interp(np.degrees(theta), self.theta_deg, self.depth_um, period=360.0) / 1e6


def table_of(function: Callable[[NDArray[np.float64]], Any]) -> dict[str, list[float]]:
    """Angles (deg) and depths (um) of a function d(theta), rad to m, sampled at ``POINTS`` angles.

    >>> table = table_of(lambda theta: 2e-5 * np.cos(2 * theta))
    >>> len(table["theta_deg"]), table["depth_um"][0]
    (8192, 20.0)

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
    return {"theta_deg": np.degrees(theta).tolist(), "depth_um": (1e6 * depth).tolist()}


AnyTable = Annotated[
    Table,
    BeforeValidator(lambda value: table_of(value) if callable(value) else value),
    from_csv(Table, ANGLE, DEPTHS),
]
