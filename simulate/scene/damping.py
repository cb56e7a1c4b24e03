"""Damping ratio of the natural modes: one of all, of the first families, or over the frequency."""

from collections.abc import Callable, Sequence
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Discriminator, Field, Tag

from geometry.base import Settings
from simulate.scene.tables import FROM_0, Columns, Points, from_csv

LEAST = -0.1  # flutter has some -1e-3
HINTS = {"damping_ratio": "over critical damping: 0.5 % is 0.005"}
HERTZ: Columns = {"frequency_Hz": ("frequency_Hz", 1.0)}
RATIOS: Columns = {"damping_ratio": ("damping_ratio", 1.0)}

type Ratios = float | NDArray[np.float64]  # of all modes, or of each (n,)

Ratio = Annotated[float, Field(ge=LEAST, lt=1)]


class OfFamilies(Settings):
    """Ratios of the first families of modes, and of all others.

    A family is a mode at rest, and at speed the one most like it. Where two modes veer each
    family keeps its ratio: from one side to the other that of the mode of the same number changes.
    """

    families: list[Ratio] = Field(
        min_length=1,
        description="Of the first modes at rest, one by one, which are followed over the speed by "
        "their shapes",
    )
    rest: Ratio = Field(description="Of all others")


class OverFrequency(Points):
    """Ratio over the natural frequency, linear in between; beyond the ends that of the ends."""

    hints: ClassVar = HINTS

    frequency_Hz: Annotated[tuple[float, ...], FROM_0] = Field(
        min_length=2,
        description="Natural frequencies at the speed, ascending; or FILE.csv in place of the "
        "table, with columns frequency_Hz and damping_ratio",
    )
    damping_ratio: tuple[Ratio, ...] = Field(min_length=2, description="Ratio of a mode there")


def _kind(value: Any) -> str:
    """The form that was meant."""
    if isinstance(value, OverFrequency) or str(value).endswith(".csv"):
        return "table"
    if isinstance(value, OfFamilies | list):
        return "families"
    if isinstance(value, dict):
        return "table" if "frequency_Hz" in value else "families"
    return "number"


AnyDamping = Annotated[
    Annotated[Ratio, Tag("number")]
    | Annotated[OfFamilies, Tag("families")]
    | Annotated[OverFrequency, from_csv(OverFrequency, HERTZ, RATIOS), Tag("table")],
    Discriminator(_kind),
]


def given(damping: AnyDamping) -> Sequence[float]:
    """All ratios that are given."""
    if isinstance(damping, OfFamilies):
        return [*damping.families, damping.rest]
    return damping.damping_ratio if isinstance(damping, OverFrequency) else [damping]


def flutters(damping: AnyDamping) -> bool:
    """Whether one of the ratios is below 0."""
    return min(given(damping)) < 0


def ratios(
    damping: AnyDamping, omega: NDArray[np.float64], families: Callable[[], NDArray[np.int64]]
) -> Ratios:
    """Ratios of the modes of ``omega`` (n,), rad/s, at a speed.

    ``families``: finds that of each mode (n,), from 0.

    >>> of = OfFamilies(families=[-0.002, 0.01], rest=0.003)
    >>> ratios(of, np.array([100.0, 200.0, 300.0]), lambda: np.array([1, 0, 2]))
    array([ 0.01 , -0.002,  0.003])
    """
    if isinstance(damping, OverFrequency):
        return np.interp(omega / (2 * np.pi), damping.frequency_Hz, damping.damping_ratio)
    if not isinstance(damping, OfFamilies):
        return damping
    family, listed = families(), np.array(damping.families)
    return np.where(family < len(listed), listed[np.minimum(family, len(listed) - 1)], damping.rest)
