"""Blades of a stage over one liner: their number, lengths and natural frequencies.

Blades are numbered in the sense of rotation: of N, blade j is 2 pi j / N ahead of blade 0, which
is where a blade alone is. A rod meets decreasing numbers: blade j meets what blade j + 1 has worn
1/N of a revolution before.
"""

from collections.abc import Sequence
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Discriminator, Field, Tag

from geometry.base import Settings, SettingsError, checked
from simulate.scene.tables import LENGTHS, Columns, column_from_csv

MOST_BLADES = 400
Seed = Annotated[int, Field(ge=0, lt=2**32, description="Seed of the draw")]
LONGER: Columns = {f"longer_{unit}": ("longer_um", um) for unit, um in LENGTHS.items()}
FREQUENCIES: Columns = {"frequencies": ("frequencies", 1.0)}
OF_LENGTHS, OF_FREQUENCIES = range(2)  # drawn apart, were they of one seed


class Lengths(Settings):
    """Scatter of the lengths: a normal draw for each blade."""

    either: ClassVar = [("std_um", "std_gaps")]

    std_um: float | None = Field(default=None, ge=0, le=1e4, description="Standard deviation (um)")
    std_gaps: float | None = Field(
        default=None, ge=0, le=1, description="The same over the gap at xi = 1/16, instead"
    )
    seed: Seed

    def drawn(self, count: int, gap: float) -> NDArray[np.float64]:
        """Lengths (count,), m, over the ``gap``, m."""
        std = (self.std_um or 0.0) / 1e6 if self.std_gaps is None else self.std_gaps * gap
        return std * np.random.default_rng([self.seed, OF_LENGTHS]).normal(size=count)


class Frequencies(Settings):
    """Scatter of the natural frequencies: a normal draw for each blade."""

    hints: ClassVar = {"std": "relative: 1 % is 0.01"}

    std: float = Field(ge=0, le=0.1, description="Standard deviation, over the frequency")
    seed: Seed

    def drawn(self, count: int) -> NDArray[np.float64]:
        """Relative changes (count,)."""
        return self.std * np.random.default_rng([self.seed, OF_FREQUENCIES]).normal(size=count)


def _kind(value: object) -> str:
    return "scatter" if isinstance(value, dict | Settings) else "list"


Longer = Annotated[float, Field(ge=-1e5, le=1e5)]
Change = Annotated[float, Field(gt=-0.5, lt=0.5)]
AnyLengths = Annotated[
    Annotated[Sequence[Longer], column_from_csv(LONGER), Tag("list")]
    | Annotated[Lengths, Tag("scatter")],
    Discriminator(_kind),
]
AnyFrequencies = Annotated[
    Annotated[Sequence[Change], column_from_csv(FREQUENCIES), Tag("list")]
    | Annotated[Frequencies, Tag("scatter")],
    Discriminator(_kind),
]


class Stage(Settings):
    """Blades over one liner; each vibrates alone: coupling through the disk is not modelled.

    >>> stage = Stage(count=3, longer_um=[10, 0, -5], frequencies=Frequencies(std=0.01, seed=3))
    >>> stage.longer(gap=5e-4)
    array([ 1.e-05,  0.e+00, -5.e-06])
    >>> stage.relative.round(4)
    array([-0.0094,  0.0024, -0.0022])
    """

    hints: ClassVar = {"frequencies": "relative: 1 % is 0.01"}

    count: int = Field(ge=1, le=MOST_BLADES, description="Number of blades, evenly apart")
    longer_um: AnyLengths | None = Field(
        default=None,
        description="By how much each is longer, which its gaps lose (um): a list from blade 0 on, "
        "FILE.csv with a column longer_um, longer_mm or longer_m, or a scatter",
    )
    frequencies: AnyFrequencies | None = Field(
        default=None,
        description="Relative change of the natural frequencies of each: a list, FILE.csv with a "
        "column frequencies, or a scatter; the modes stay",
    )

    @checked
    def _one_for_each_blade(self) -> None:
        for key in ("longer_um", "frequencies"):
            values = getattr(self, key)
            if isinstance(values, Sequence) and len(values) != self.count:
                raise SettingsError(
                    f"{len(values)} values for {self.count} blades: give one for each", key=key
                )

    def longer(self, gap: float) -> NDArray[np.float64]:
        """By how much each blade is longer (count,), m; ``gap`` at xi = 1/16, m."""
        if isinstance(self.longer_um, Lengths):
            return self.longer_um.drawn(self.count, gap)
        return np.array(self.longer_um or [0.0] * self.count) / 1e6

    @property
    def relative(self) -> NDArray[np.float64]:
        """Relative change of the natural frequencies of each blade (count,)."""
        if isinstance(self.frequencies, Frequencies):
            return self.frequencies.drawn(self.count)
        return np.array(self.frequencies or [0.0] * self.count)
