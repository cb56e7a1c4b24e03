"""Sparse matrices in files of SciPy, CalculiX, Abaqus, Nastran and Ansys.

Programs write one triangle of M and K, and most of them the node and direction of each row.
"""

import re
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.io import mminfo, mmread
from scipy.sparse import csr_matrix, diags, load_npz

from geometry.base import (
    MeshError,
    UserError,
    about,
    number,
    read_text,
    require,
    require_file,
    shown,
)

DIRECTIONS = 100  # more than a node has


class ElsewhereError(UserError):
    """A file of given matrices that cannot be read or does not fit the others."""


class FileMatrix(NamedTuple):
    """A matrix, and the meaning of its rows."""

    A: csr_matrix
    rows: NDArray[np.int64] | None = None  # (n, 2), number of node and direction from 1, if known


def read_matrix(path: Path, letter: str) -> FileMatrix:
    """The matrix at ``path``; of several in a file that with the ``letter``, M or K.

    Raises
    ------
    ElsewhereError
        When it cannot be read whole, or holds other values than finite real numbers.
    """
    with about(path, ElsewhereError):
        require(
            (
                path.suffix.lower() != ".sub",
                "a superelement's rows are no displacements of nodes: give the full matrices "
                "(.full), or reduce by one basis at all speeds (`reduced_model`)",
            )
        )
        require_file(path, READERS)
        try:
            matrix = READERS[path.suffix.lower()](path, letter)
        except (MeshError, ElsewhereError):
            raise
        except Exception as error:  # readers raise various exceptions for damaged files
            raise MeshError(
                f"cannot be read as {path.suffix} ({shown(error)}): is it cut short?"
            ) from None
        require(
            (
                not np.imag(matrix.A.data).any(),
                "is complex: give the real part alone, as of a model without structural damping",
            ),
            (np.isfinite(matrix.A.data).all(), "holds values that are not finite"),
        )
    return matrix._replace(A=csr_matrix(matrix.A.real.astype(float)))


def _mtx(path: Path, letter: str) -> FileMatrix:
    """Matrix Market, or Abaqus's rows: node, direction, twice, and value; or row, column, value."""
    with open(path) as file:
        head = next((line for line in file if line.strip() and line[0] != "*"), "")
    if head.startswith("%%MatrixMarket"):
        return FileMatrix(_market(path))
    *places, values = _columns(path, "," if "," in head else None)
    if len(places) == 2:
        i, j = places
        return FileMatrix(_whole(_placed(i, j, values), len(values)))
    require(
        (
            len(places) == 4,
            f"{len(places) + 1} numbers a line, needs 5: write FORMAT=MATRIX INPUT",
        ),
    )
    return _of_labels(np.array(places, dtype=int).T, values)


def _market(path: Path) -> csr_matrix:
    """A matrix of Matrix Market; ``mmread`` would end a number at a D or a comma, unnoticed."""
    rows, columns, entries, layout, kind, symmetry = mminfo(path)
    require(
        (kind != "pattern", "says which entries there are, not their values: write them too"),
        (symmetry in ("general", "symmetric"), f"is {symmetry}, where M and K are symmetric"),
    )
    text = _of_fortran(path)
    lines = enumerate(text.splitlines(), 1)
    size = next(place for place, line in lines if line.strip() and line[:1] != b"%")
    if layout == "array":
        body = b"".join(text.splitlines(keepends=True)[size:]).split()
        require((rows * columns <= 2 * len(body), f"has {len(body)} numbers, too few for its head"))
        np.array(body, dtype=float)  # refuses what mmread would end a number at
        return csr_matrix(mmread(BytesIO(text)))
    i, j, *values = _columns(path, comments="%", skip=size)
    require(
        (len(i) == entries, f"has {len(i)} entries, its head says {entries}"),
        (
            len(values) == 1 + (kind == "complex"),
            f"has {2 + len(values)} numbers a line, its head says {kind}",
        ),
    )
    A = _placed(i, j, values[0] + 1j * values[1] if values[1:] else values[0], (rows, columns))
    return A + A.T - diags(A.diagonal()) if symmetry == "symmetric" else A


def _calculix(path: Path, letter: str) -> FileMatrix:
    """One triangle; the rows are named in the file .dof of the same job, as 12.3."""
    dof = path.with_suffix(".dof")
    with about(dof, ElsewhereError):
        names = read_text(dof, most=None).split()
    columns = _columns(path)
    require(
        (len(columns) == 3, f"{len(columns)} numbers a line, needs 3"),
    )
    i, j, values = columns
    A = _whole(_placed(i, j, values), len(values))
    require(
        (
            A.shape[0] == len(names) == len(set(names)),
            f"{A.shape[0]} rows, {dof.name} has {len(names)}: is it of another job, or cut short?",
        ),
    )
    return FileMatrix(A, np.array([name.split(".") for name in names], dtype=int))


def _dmig(path: Path, letter: str) -> FileMatrix:
    """The matrix of a punch file whose name begins with a letter; fields have 16 characters."""
    entries, name, line = [], "", ""
    for line in read_text(path, most=None).splitlines(keepends=True):
        first, second, third, imaginary = (line[i : i + 16].strip() for i in range(8, 72, 16))
        if not line.startswith("*"):  # other cards, as GRID*, have such lines too
            name, *column = (first, second, third) if line.startswith("DMIG*") else ("",)
        elif name:
            value = number(third) + 1j * number(imaginary or "0")
            entries.append((name, *column, first, second, value))
    # K4 is structural damping
    names = {name for name, *_ in entries if name.startswith(letter) and name[1:2] != "4"}
    require(
        (
            len(names) == 1,
            f"needs one matrix DMIG* whose name begins with {letter}, has {len(names)}",
        ),
        (line.endswith("\n"), "its last line has no end: is the file cut short?"),
    )
    labels, values = zip(
        *((entry[1:5], entry[5]) for entry in entries if entry[0] in names), strict=True
    )
    return _of_labels(np.array(labels, dtype=int), np.array(values))


def _full(path: Path, letter: str) -> FileMatrix:
    """M or K of Ansys; rows of constrained directions are zero."""
    try:
        from ansys.mapdl.reader import read_binary  # pyright: ignore[reportMissingImports]  optional
    except ImportError:
        raise MeshError("needs ansys-mapdl-reader: see fem/matrices.md") from None
    rows, K, M = read_binary(str(path)).load_km(sort=False)
    return FileMatrix(_whole(csr_matrix({"M": M, "K": K}[letter])), np.add(rows, [0, 1]))


READERS: dict[str, Callable[[Path, str], FileMatrix]] = {
    ".mtx": _mtx,
    ".npz": lambda path, letter: FileMatrix(csr_matrix(load_npz(path))),
    ".sti": _calculix,
    ".mas": _calculix,
    ".pch": _dmig,
    ".full": _full,
}


def _columns(
    path: Path, delimiter: str | None = None, comments: str = "*", skip: int = 0
) -> NDArray[np.float64]:
    """Columns (k, n) of numbers; the last line must have its end, else a number may lack digits."""
    text = _of_fortran(path)
    require(
        (text.endswith(b"\n"), "its last line has no end: is the file cut short?"),
    )
    return np.loadtxt(
        BytesIO(text), delimiter=delimiter, comments=comments, ndmin=2, skiprows=skip
    ).T


def _of_fortran(path: Path) -> bytes:
    """The text of a file, the exponents of its numbers with the letter E."""
    return re.sub(rb"(?<=[\d.])[dD](?=[-+\d])", b"E", path.read_bytes())


def _placed(
    i: NDArray, j: NDArray, values: NDArray, shape: tuple[int, int] | None = None
) -> csr_matrix:
    """A matrix of ``values`` (n,) in rows ``i`` and columns ``j``, from 1."""
    places = np.array([i, j])
    rows = shape[0] if shape else places[0].max()
    require(
        (
            places.min() >= 1 and np.all(places == np.round(places)),
            f"an entry is in row or column {places.min():g}: they are whole numbers, counted from "
            "1",
        ),
        (
            rows <= len(values),
            f"has {rows:.12g} rows, and {len(values)} entries: each row has one at least",
        ),
    )
    return csr_matrix((values, places.astype(int) - 1), shape)


def _of_labels(labels: NDArray, values: NDArray) -> FileMatrix:
    """A matrix by node and direction of row and column, ``labels`` (n, 4) of ``values`` (n,)."""
    codes = DIRECTIONS * labels[:, ::2] + labels[:, 1::2]
    rows, where = np.unique(codes, return_inverse=True)
    A = csr_matrix((values, where.reshape(-1, 2).T), (len(rows), len(rows)))
    return FileMatrix(_whole(A, len(values)), np.column_stack(divmod(rows, DIRECTIONS)))


def _whole(A: csr_matrix, lines: int = 0) -> csr_matrix:
    """The matrix, of which a file may hold one triangle: no place and its mirror image.

    Entries of one place are summed in ``A``; so many ``lines`` must each have a place of its own.
    """
    require(
        (A.nnz >= lines, "names an entry twice: one matrix a file, of one step or subcase"),
    )
    places = A.astype(bool)
    both = places.multiply(places.T).nnz - np.count_nonzero(A.diagonal())
    return A if both else csr_matrix(A + A.T - diags(A.diagonal()))
