"""Dataclasses of arrays stored as NetCDF files; each field states its dimensions and unit."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import field, fields
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from geometry.files import whole
from geometry.provenance import Provenance, ProvenanceError, anew
from geometry.version import require_format

FORMAT = 1


def stored(dimensions: str = "", units: str = "1", **attributes: str) -> Any:
    """Field of a ``Stored``: names of its dimensions (none: a scalar), unit, other attributes."""
    return field(metadata={"dims": dimensions.split(), "attrs": {"units": units, **attributes}})


class Stored:
    """Base of a dataclass of ``stored`` fields and a ``provenance``."""

    code: ClassVar[Sequence[str]]  # source files on which its numbers depend
    provenance: Provenance

    def save(self, path: str | Path, **coordinates: ArrayLike) -> None:
        """Write NetCDF, with ``coordinates`` along some dimensions."""
        variables = {
            f.name: (f.metadata["dims"], np.asarray(getattr(self, f.name)), f.metadata["attrs"])
            for f in fields(self)
            if f.metadata
        }
        attributes = {"format": FORMAT, "provenance": self.provenance.dump()}
        dataset = xr.Dataset(variables, coordinates, attributes)
        with whole(path) as temporary:
            dataset.to_netcdf(temporary, engine="h5netcdf")

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read NetCDF.

        Raises
        ------
        ProvenanceError
            When the file is missing, of another kind or format, or made by another version of the
            code.
        """
        try:
            with opened(path) as (dataset, provenance):
                provenance.require_code(cls.code, path)
                values = {f.name: _plain(dataset[f.name]) for f in fields(cls) if f.metadata}
        except (OSError, KeyError) as error:
            reason = str(error).splitlines()[0]
            fault = f"{path}: is no {cls.__name__} ({reason})"
            raise ProvenanceError(f"{fault}; {anew(path)}") from None
        return cls(**values, provenance=provenance)


@contextmanager
def opened(path: str | Path) -> Iterator[tuple[xr.Dataset, Provenance]]:
    """Open a file of ``Stored.save``; yield its dataset and provenance.

    Raises
    ------
    ProvenanceError
        When the file is missing or of another format.
    """
    if not Path(path).is_file():
        raise ProvenanceError(f"{path}: no such file; {anew(path)}")
    with xr.open_dataset(path, engine="h5netcdf") as dataset:
        require_format(dataset.attrs, FORMAT, path)
        yield dataset, Provenance.parse(dataset.attrs.get("provenance"), path)


def _plain(variable: xr.DataArray) -> NDArray | float | tuple[str, ...]:
    values = variable.values
    if values.dtype.kind != "f":
        return tuple(map(str, values))
    return values if values.ndim else float(values)
