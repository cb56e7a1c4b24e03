"""Dataclasses of arrays and sparse matrices stored as NetCDF files.

Each field states its dimensions and unit.
"""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import MISSING, Field, dataclass, field, fields
from io import FileIO
from mmap import ACCESS_READ, mmap
from pathlib import Path
from typing import Any, ClassVar, Self, dataclass_transform

import h5py
import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_matrix, tril, triu, vstack

from geometry.base import (
    Provenance,
    legible,
    memory_of_machine,
    require,
    require_format,
    whole,
)
from geometry.elsewhere import SYMMETRIC

FORMAT = 1
OVERHEAD = 1 << 14  # bytes of HDF5 for a variable beside its values, at most
DEFLATED = 1100  # bytes of values for one of their file, at most, compressed as zlib does
UNWRITTEN = 1 << 20  # bytes of values that a file may declare of any size, as xarray does of axes
HEAP, ENTRY = b"GCOL\1\0\0\0", 16  # of HDF5: begin of a heap; bytes of it, and of each entry
CSR = ("data", "indices", "indptr")  # arrays of a sparse matrix


def stored(
    dimensions: str = "",
    units: str = "1",
    may_be_nan: bool = False,
    sparse: bool = False,
    default_factory: Any = MISSING,
    **attributes: str,
) -> Any:
    """Field of a ``Stored``: names of its dimensions (none: a scalar), unit, other attributes.

    A last dimension that is the last but one with ``_`` behind makes a symmetric matrix. Several
    ``sparse`` ones, which the first of three dimensions counts, are stored with one set of indices
    where they have one pattern, else as one, below one another; of symmetric ones the upper
    triangle. ``default_factory``: as of ``dataclasses.field``.
    """
    dims = tuple(dimensions.split())
    return field(
        default_factory=default_factory,
        metadata={
            "dims": dims,
            "symmetric": len(dims) > 1 and dims[-1] == f"{dims[-2]}_",
            "sparse": sparse,
            "attrs": {"units": units, **attributes},
            "may_be_nan": may_be_nan,
        },
    )


@dataclass_transform(frozen_default=True, eq_default=False, field_specifiers=(stored,))
def frozen[Class: type](of: Class) -> Class:
    """Decorator of a frozen dataclass of ``stored`` fields: two are equal if they are one."""
    return dataclass(frozen=True, eq=False)(of)


class Stored:
    """Base of a dataclass of ``stored`` fields and a ``provenance``."""

    code: ClassVar[Sequence[str]]  # modules that compute its numbers
    provenance: Provenance

    def save(self, path: str | Path, **coordinates: ArrayLike) -> None:
        """Write NetCDF, with ``coordinates`` along some dimensions.

        Raises
        ------
        geometry.base.errors.WriteError
            When it cannot be written.
        """
        each = (_variables(f, getattr(self, f.name)) for f in _stored_fields(self))
        variables = {name: of for variables in each for name, of in variables.items()}
        attributes = {"format": FORMAT, "provenance": self.provenance.dump()}
        write(xr.Dataset(variables, coordinates, attributes), path)

    @classmethod
    def load(cls, path: str | Path, expected: Provenance | None = None) -> Self:
        """Read NetCDF; ``expected``: the only provenance that the file may have.

        Raises
        ------
        ProvenanceError
            When the file is missing, damaged, of another kind or format, made by another version of
            the code, of another provenance, or holds values that cannot be: other dimensions, nan,
            not symmetric.
        """
        with opened(path, cls.__name__) as (dataset, provenance):
            provenance.require_code(cls.code, path)
            provenance.require(expected or provenance, path)
            values = {
                f.name: (_read_sparse if f.metadata["sparse"] else _read)(dataset, f)
                for f in _stored_fields(cls)
            }
            loaded = cls(**values, provenance=provenance)
            loaded.require_possible()
        return loaded

    def require_possible(self) -> None:
        """Check the further demands on the values.

        Raises
        ------
        ValueError
            When they cannot be so; the message says which.
        """


def write(dataset: xr.Dataset, path: str | Path, encoding: Any = None) -> None:
    """Write NetCDF; ``path`` appears only when it is complete.

    Its room is taken first: where a disk is full HDF5 may crash, at the latest when Python ends.

    Raises
    ------
    geometry.base.errors.WriteError
        When it cannot be written.
    """
    room = dataset.nbytes + len(str(dataset.attrs)) + OVERHEAD * (1 + len(dataset.variables))
    with whole(path) as temporary, _Reserved(temporary, room) as file:
        dataset.to_netcdf(file, engine="h5netcdf", encoding=encoding)


class _Reserved(FileIO):
    """A new file on a disk that has room for ``room`` bytes of it; as long as what is written."""

    def __init__(self, path: Path, room: int) -> None:
        super().__init__(path, "w+")
        os.posix_fallocate(self.fileno(), 0, room)
        self._length = 0

    def seek(self, offset: int, whence: int = os.SEEK_SET, /) -> int:
        at_end = whence == os.SEEK_END
        return super().seek(self._length + offset if at_end else offset, 0 if at_end else whence)

    def write(self, data: Any, /) -> int:
        count = super().write(data)
        self._length = max(self._length, self.tell())
        return count

    def truncate(self, size: int | None = None, /) -> int:
        self._length = self.tell() if size is None else size
        return self._length

    def close(self) -> None:
        if not self.closed:
            super().truncate(self._length)
        super().close()


@contextmanager
def read(path: str | Path, kind: str, remedy: str | None = None) -> Iterator[xr.Dataset]:
    """Open a file of ``write``; an error in the block says that it is no ``kind``.

    Raises
    ------
    ProvenanceError
        When the file is missing or damaged, or lacks data that the block reads.
    """
    with legible(path, kind, remedy) as whole_file, netcdf(whole_file) as dataset:
        yield dataset


@contextmanager
def netcdf(path: str | Path) -> Iterator[xr.Dataset]:
    """Open any file of NetCDF 4 whose values fit into this machine and into the file.

    Raises
    ------
    OSError, ValueError
        When it is none, or declares more values: a file of two kilobytes may declare terabytes,
        which are zeros where they are read.
    """
    with open(path, "rb") as file, mmap(file.fileno(), 0, access=ACCESS_READ) as data:
        _require_heaps_that_end(data)
    sizes = [0]
    with h5py.File(path, "r") as file:
        file.visititems(lambda _, of: sizes.append(getattr(of, "nbytes", 0)))
    size, most = sum(sizes), UNWRITTEN + DEFLATED * os.path.getsize(path)
    require(
        (size <= most, f"declares {size:.3g} bytes of values, allowed {most:.3g} in its size"),
        (
            size <= (room := memory_of_machine()),
            f"declares {size:.3g} bytes of values, this machine has {room:.3g} of memory",
        ),
        kind=ValueError,
    )
    with xr.open_dataset(path, engine="h5netcdf") as dataset:
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


def _require_heaps_that_end(data: mmap) -> None:
    """Refuse a heap of texts in which HDF5 would go round for ever.

    Each entry leads to the next by its length: index (2 bytes, 0 of free room), 6 bytes, length
    (8), data to a multiple of 8; the length of free room is its whole.
    """
    at, left = data.find(HEAP), len(data)  # heaps do not overlap
    while at >= 0:
        place, end = at + ENTRY, at + int.from_bytes(data[at + 8 : at + ENTRY], "little")
        while place + ENTRY <= end:
            length = int.from_bytes(data[place + 8 : place + ENTRY], "little")
            free = data[place : place + 2] == bytes(2)
            step = length if free else ENTRY + length + -length % 8
            require((ENTRY <= step <= end - place, "a heap is damaged"), kind=ValueError)
            place += step
        left -= end - at
        require((left >= 0, "a heap is damaged"), kind=ValueError)
        at = data.find(HEAP, at + 1)


def _stored_fields(owner: Any) -> list[Field]:
    """The ``stored`` fields of a class, or of an object of it."""
    return [f for f in fields(owner) if f.metadata]


def _variables(f: Field, value: Any) -> dict[str, tuple]:
    """Variables of the file, by name, that hold the ``value`` of a field."""
    if not f.metadata["sparse"]:
        return {f.name: (f.metadata["dims"], np.asarray(value), f.metadata["attrs"])}
    matrices = value if isinstance(value, tuple) else (value,)
    symmetric, numbered = f.metadata["symmetric"], _numbered(matrices[0])
    if _same_pattern(matrices):
        kept = triu(numbered, format="csr") if symmetric else numbered
        data = np.concatenate([A.data[kept.data - 1] for A in matrices])
    else:
        kept = vstack([triu(A) for A in matrices], format="csr")
        data = kept.data
    parts = zip(CSR, (data, kept.indices, kept.indptr), strict=True)
    return {f"{f.name}_{part}": (f"{f.name}_{part}_entry", values) for part, values in parts}


def _same_pattern(matrices: Sequence[csr_matrix]) -> bool:
    first, *others = matrices
    return all(
        np.array_equal(getattr(A, part), getattr(first, part)) for A in others for part in CSR[1:]
    )


def _numbered(A: csr_matrix) -> csr_matrix:
    """A matrix with the pattern of A; its entries are their numbers, from 1."""
    return csr_matrix((np.arange(1, 1 + A.nnz, dtype=np.int32), A.indices, A.indptr), A.shape)


def _read(dataset: xr.Dataset, f: Field) -> NDArray | float | int | tuple[str, ...]:
    """Value of a field that is not sparse."""
    name, layout = f.name, f.metadata
    values = dataset[name].values
    require(
        (
            dataset[name].dims == layout["dims"],
            f"{name}: dimensions {dataset[name].dims}, not {layout['dims']}",
        ),
        kind=ValueError,
    )
    if f.type == tuple[str, ...]:
        return tuple(map(str, values))
    if f.type is int and values.dtype.kind == "i" and not values.ndim:
        return int(values)
    is_float = values.dtype == float
    require(
        (is_float, f"{name}: of type {values.dtype}, not of floating point"),
        (
            layout["may_be_nan"] or (is_float and np.isfinite(values).all()),
            f"{name}: not finite",
        ),
        kind=ValueError,
    )
    if layout["symmetric"]:
        require_symmetric(name, values)
    return values if values.ndim else float(values)


def _read_sparse(dataset: xr.Dataset, f: Field) -> csr_matrix | tuple[csr_matrix, ...]:
    """Value of a sparse field."""
    data, indices, indptr = (dataset[f"{f.name}_{part}"].values for part in CSR)
    integers = {indices.dtype.kind, indptr.dtype.kind} == {"i"}
    require(
        (
            data.dtype == float
            and integers
            and [*indptr[-1:]] == [len(indices)]
            and len(data) % max(len(indices), 1) == 0,
            f"{f.name}: no sparse matrix",
        ),
        kind=ValueError,
    )
    columns = dataset.sizes[f.metadata["dims"][-1].removesuffix("_")]
    size = len(indptr) - 1, columns
    csr_matrix((data[: len(indices)], indices, indptr), size).check_format(full_check=True)
    require(
        (np.isfinite(data).all() and data.any(), f"{f.name}: not finite, or zero"),
        kind=ValueError,
    )
    if not f.metadata["symmetric"]:
        return csr_matrix((data, indices, indptr), size)
    A = _numbered(csr_matrix((indices, indices, indptr), size))
    below = [A[row : row + columns] for row in range(0, A.shape[0], columns)]
    each = data.reshape(-1, len(indices))
    matrices = tuple(A for upper in below for A in _symmetric(f.name, upper, each))
    return matrices if f.type == tuple[csr_matrix, ...] else matrices[0]


def _symmetric(name: str, upper: csr_matrix, each: NDArray[np.float64]) -> Iterator[csr_matrix]:
    """Matrices of values (matrices, entries) whose numbers, from 1, an upper triangle holds.

    The diagonal of the first one must be positive.
    """
    diagonal = upper.diagonal()
    require(
        (
            upper.shape[0] == upper.shape[1]
            and (diagonal > 0).all()
            and (each[0, diagonal - 1] > 0).all(),
            f"{name}: not square, or not positive on its diagonal",
        ),
        (not tril(upper, -1).nnz, f"{name}: not an upper triangle"),
        kind=ValueError,
    )
    full = (upper + triu(upper, 1).T).tocsr()
    for values in each:
        yield csr_matrix((values[full.data - 1], full.indices, full.indptr), full.shape)


def require_symmetric(name: str, A: NDArray[np.float64]) -> None:
    """Refuse matrices A (..., n, n) that are not symmetric, or zero.

    Raises
    ------
    ValueError
        If they are not, or all are zero.
    """
    require(
        (A.shape[-1] == A.shape[-2], f"{name}: of shape {A.shape}, not square"),
        kind=ValueError,
    )
    largest = abs(A).max(initial=0.0)
    require(
        (largest > 0, f"{name}: zero"),
        (
            abs(A - np.swapaxes(A, -1, -2)).max(initial=0.0) <= SYMMETRIC * largest,
            f"{name}: not symmetric",
        ),
        kind=ValueError,
    )
