"""Sobol designs: rows drawn for sensitivity indices, and these indices of the rows' numbers.

Points and indices are those of ``scipy.stats.sobol_indices`` (Saltelli et al. 2010): with d factors
and n samples a design has n (d + 2) rows.
"""

from collections.abc import Sequence
from typing import Annotated, Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from pydantic import Field

from geometry.base import Settings, SettingsError, SettingsFile, UserError, checked

LEVEL = 0.95  # confidence of the intervals
RESAMPLES = 999


class SobolError(UserError):
    """Rows of which no indices can be computed."""


class Factor(Settings):
    """A number by which values of the scene are multiplied, uniform between two bounds."""

    keys: list[str] = Field(
        min_length=1, description="Keys of the scene that the factor multiplies"
    )
    between: Annotated[list[float], Field(min_length=2, max_length=2)] = Field(
        description="Lowest and highest factor on the values of the scene"
    )

    @checked
    def _ascending(self) -> None:
        if not self.between[0] < self.between[1]:
            raise SettingsError(
                "the first should be below the second", key="between", value=self.between
            )


class Sobol(SettingsFile):
    """A Sobol design of a scene: independent factors on its values."""

    samples: int = Field(
        ge=2, le=2**16, description="Samples n, a power of 2; rows: n times the factors and 2"
    )
    seed: int = Field(default=1, ge=0, description="Seed of the scrambled Sobol sequence")
    factors: dict[str, Factor] = Field(min_length=2, description="Factors by their names")

    @checked
    def _power_of_two(self) -> None:
        if self.samples & (self.samples - 1):
            raise SettingsError("should be a power of 2", key="samples", value=self.samples)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self.samples * (len(self.factors) + 2)

    def points(self) -> NDArray[np.float64]:
        """Factors (rows, factors) of all rows: of the samples A and B, and of each row of A.

        There are as many of the latter as factors: one of them is that of the row of B.
        """
        from scipy.stats.qmc import Sobol as Sequence  # a slow import, which many jobs do not need

        d, low, high = len(self.factors), *np.transpose([f.between for f in self.factors.values()])
        rng = np.random.default_rng(self.seed)
        A, B = np.split(Sequence(2 * d, bits=64, rng=rng).random(self.samples), 2, axis=1)
        AB = np.where(np.eye(d, dtype=bool), B[:, None], A[:, None])
        return low + (high - low) * np.vstack([A, B, AB.reshape(-1, d)])


class Indices(NamedTuple):
    """Sobol indices of some quantities, (quantities, factors), with 95 % intervals."""

    factors: list[str]
    first: NDArray[np.float64]
    first_interval: NDArray[np.float64]  # (2, quantities, factors), lowest and highest
    total: NDArray[np.float64]
    total_interval: NDArray[np.float64]


def indices(rows: xr.Dataset, quantities: Sequence[str]) -> Indices:
    """Indices of ``quantities``, variables of the table of rows of a Sobol design.

    Intervals are percentiles of bootstrap samples.

    Raises
    ------
    SobolError
        When the table is of no Sobol design, or a row has no number.
    """
    if "sobol" not in rows.attrs:
        raise SobolError("the design is a table, not a Sobol design: it has no indices")
    sobol = Sobol.model_validate_json(rows.attrs["sobol"])
    values = np.array([rows[name].values for name in quantities], float)
    _require(rows, sobol, values)
    n, d = sobol.samples, len(sobol.factors)
    A, B, AB = np.split(values, [n, 2 * n], axis=1)
    parts = {"f_A": A, "f_B": B, "f_AB": np.moveaxis(AB.reshape(-1, n, d), -1, 0)}
    rng = np.random.default_rng(sobol.seed)
    drawn = rng.integers(n, size=(RESAMPLES, n))
    first, total = _indices(parts, slice(None))
    resampled = np.array([_indices(parts, sample) for sample in drawn])
    tails = [(1 - LEVEL) / 2, (1 + LEVEL) / 2]
    of_first, of_total = (np.quantile(resampled[:, i], tails, axis=0) for i in (0, 1))
    return Indices([*sobol.factors], first, of_first, total, of_total)


def _require(rows: xr.Dataset, sobol: Sobol, values: NDArray[np.float64]) -> None:
    """Refuse rows at other points than those of the design, or without a number.

    Raises
    ------
    SobolError
        If there are such rows.
    """
    points, stored = sobol.points(), rows["factors"].values
    if points.shape != stored.shape or not np.allclose(points, stored, rtol=1e-12):
        raise SobolError("another version of scipy drew the rows: run the design again")
    missing = np.flatnonzero(~np.isfinite(values).all(axis=0))
    if len(missing):
        raise SobolError(
            f"{len(missing)} rows without a result, the first is {missing[0] + 1}: see their "
            f"status, and narrow the factors"
        )


def _indices(parts: dict[str, NDArray], sample: Any) -> tuple[NDArray, NDArray]:
    """First and total indices (quantities, factors) of some samples."""
    from scipy.stats import sobol_indices

    chosen = {name: part[..., sample] for name, part in parts.items()}
    indices = sobol_indices(func=chosen, n=chosen["f_A"].shape[1])
    return np.atleast_2d(indices.first_order), np.atleast_2d(indices.total_order)
