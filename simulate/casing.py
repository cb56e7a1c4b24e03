"""Casing distortion as a table of angles and inward depths, from a CSV file or a function."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, model_validator

from geometry.errors import shown
from geometry.settings import Settings, SettingsError
from geometry.text_file import csv_rows, number

POINTS = 8192  # angles around the casing at which a function is sampled
UNITS = {"m": 1.0, "mm": 1e-3, "um": 1e-6}
LARGEST_DEPTH = 0.1  # m: a larger one is of another unit
COLUMNS = "theta_deg, and depth_m, depth_mm or depth_um"


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

    @model_validator(mode="after")
    def _one_round(self) -> Self:
        _check_round(self.theta_deg, self.depth_m)
        if (deepest := max(map(abs, self.depth_m))) > LARGEST_DEPTH:
            raise SettingsError(
                f"allowed up to {LARGEST_DEPTH:g} m: is the column in mm or um? then name it "
                "depth_mm or depth_um",
                key="depth_m",
                value=deepest,
                allowed={"le": LARGEST_DEPTH},
            )
        return self

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


def read_table(path: str | Path) -> dict[str, list[float]]:
    r"""Angles (deg) and depths (m) of a CSV file; its header names the unit of the depth.

    >>> lines = Path("bumps.csv").write_text("theta_deg,depth_mm\n0,0\n90,0.5\n")
    >>> read_table("bumps.csv")
    {'theta_deg': [0.0, 90.0], 'depth_m': [0.0, 0.0005]}

    Raises
    ------
    ValueError
        When it cannot be read, has other columns, or angles of no single round.
    """
    try:
        rows = list(csv_rows(path))
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    (at, header), *rows = rows or [(1, [])]
    unit = UNITS.get(header[-1].removeprefix("depth_")) if len(header) == 2 else None
    if unit is None or header[0] != "theta_deg" or not header[-1].startswith("depth_"):
        raise ValueError(
            f"{path}: line {at}: columns {shown(', '.join(header))}: should be {COLUMNS}"
        )
    points = [_point(f"{path}: line {line}", cells) for line, cells in rows]
    theta, depth = [theta for theta, _ in points], [depth * unit for _, depth in points]
    try:
        _check_round(theta, depth)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    return {"theta_deg": theta, "depth_m": depth}


def _point(where: str, cells: list[str]) -> tuple[float, float]:
    if len(cells) != 2:
        raise ValueError(f"{where}: has {len(cells)} cells, should have two numbers")
    try:
        return number(cells[0]), number(cells[1])
    except ValueError as error:
        raise ValueError(f"{where}: {error}") from None


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
    return read_table(value) if isinstance(value, str | Path) else value


AnyTable = Annotated[Table, BeforeValidator(_as_table)]
