"""Dataclasses of arrays stored as NetCDF files; each field states its dimensions and unit."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import MISSING, field, fields
from io import BytesIO
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from geometry.given import SYMMETRIC
from geometry.project import Provenance, legible, require_format, write_whole

FORMAT = 1


def stored(
    dimensions: str = "",
    units: str = "1",
    may_be_nan: bool = False,
    default_factory: Any = MISSING,
    **attributes: str,
) -> Any:
    """Field of a ``Stored``: names of its dimensions (none: a scalar), unit, other attributes.

    A last dimension that is the last but one with ``_`` behind makes a symmetric matrix.
    ``default_factory``: as of ``dataclasses.field``.
    """
    attrs = {"units": units, **attributes}
    metadata = {"dims": tuple(dimensions.split()), "attrs": attrs, "may_be_nan": may_be_nan}
    return field(default_factory=default_factory, metadata=metadata)


class Stored:
    """Base of a dataclass of ``stored`` fields and a ``provenance``."""

    code: ClassVar[Sequence[str]]  # modules that compute its numbers
    provenance: Provenance

    def save(self, path: str | Path, **coordinates: ArrayLike) -> None:
        """Write NetCDF, with ``coordinates`` along some dimensions.

        Raises
        ------
        geometry.project.errors.WriteError
            When it cannot be written.
        """
        variables = {
            f.name: (f.metadata["dims"], np.asarray(getattr(self, f.name)), f.metadata["attrs"])
            for f in fields(self)
            if f.metadata
        }
        attributes = {"format": FORMAT, "provenance": self.provenance.dump()}
        write(xr.Dataset(variables, coordinates, attributes), path)

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read NetCDF.

        Raises
        ------
        ProvenanceError
            When the file is missing, damaged, of another kind or format, made by another version of
            the code, or holds values that cannot be: other dimensions, nan, not symmetric.
        """
        with opened(path, cls.__name__) as (dataset, provenance):
            provenance.require_code(cls.code, path)
            own = [f for f in fields(cls) if f.metadata]
            values = {f.name: _read(dataset[f.name], f.metadata, f.type) for f in own}
            found = cls(**values, provenance=provenance)
            found.require_possible()
        return found

    def require_possible(self) -> None:
        """Check what else the values must be.

        Raises
        ------
        ValueError
            When they cannot be so; the message says which.
        """


def write(dataset: xr.Dataset, path: str | Path, encoding: Any = None) -> None:
    """Write NetCDF; ``path`` appears only when it is complete.

    It is made in memory: where a disk is full HDF5 may crash, at the latest when Python ends.

    Raises
    ------
    geometry.project.errors.WriteError
        When it cannot be written.
    """
    image = BytesIO()
    dataset.to_netcdf(image, engine="h5netcdf", encoding=encoding)
    write_whole(image.getvalue(), path)


@contextmanager
def read(path: str | Path, kind: str, remedy: str | None = None) -> Iterator[xr.Dataset]:
    """Open a file of ``write``; an error in the block says that it is no ``kind``.

    Raises
    ------
    ProvenanceError
        When the file is missing or damaged, or the block does not find in it what it reads.
    """
    with (
        legible(path, kind, remedy) as whole_file,
        xr.open_dataset(whole_file, engine="h5netcdf") as dataset,
    ):
        yield dataset


@contextmanager
def opened(
    path: str | Path, kind: str = "file of results"
) -> Iterator[tuple[xr.Dataset, Provenance]]:
    """Open a file of ``Stored.save``; yield its dataset and provenance.

    Raises
    ------
    ProvenanceError
        As ``read``, and when the file is of another format.
    """
    with read(path, kind) as dataset:
        require_format(dataset.attrs, FORMAT, path)
        yield dataset, Provenance.parse(dataset.attrs.get("provenance"), path)


def _read(variable: xr.DataArray, of: Any, kind: Any) -> NDArray | float | tuple[str, ...]:
    """Values of a field with the metadata ``of``, of the type ``kind``."""
    values, name = variable.values, variable.name
    if variable.dims != of["dims"]:
        raise ValueError(f"{name}: dimensions {variable.dims}, not {of['dims']}")
    if kind == tuple[str, ...]:
        return tuple(map(str, values))
    if values.dtype != float:
        raise ValueError(f"{name}: of type {values.dtype}, not of floating point")
    if not of["may_be_nan"] and not np.isfinite(values).all():
        raise ValueError(f"{name}: not finite")
    if of["dims"][1:] and of["dims"][-1] == f"{of['dims'][-2]}_":
        require_symmetric(name, values)
    return values if values.ndim else float(values)


def require_symmetric(name: str, A: NDArray[np.float64]) -> None:
    """Refuse matrices A (..., n, n) that are not symmetric, or zero.

    Raises
    ------
    ValueError
        If they are not, or all are zero.
    """
    if A.shape[-1] != A.shape[-2]:
        raise ValueError(f"{name}: of shape {A.shape}, not square")
    largest = abs(A).max(initial=0.0)
    if not largest > 0:
        raise ValueError(f"{name}: zero")
    if abs(A - np.swapaxes(A, -1, -2)).max() > SYMMETRIC * largest:
        raise ValueError(f"{name}: not symmetric")
