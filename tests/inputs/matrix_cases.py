"""Matrices in files of other programs, changed as people and accidents do; sizes that lie."""

import io
import re
import tempfile
import zipfile
from functools import cache, partial
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from case import Case
from changes import SIZES, binary, cell, cut, line, long, size
from hypothesis import strategies as st
from programs import WRITERS, Files
from scipy.io import mmwrite
from scipy.sparse import csr_matrix
from yaml_cases import Cases

from fem.matrix_files import read_matrix

NUMBERS = ["nan", "inf", "", "x", "1_0", "1.0D+01", "٣", "1e400", "--1", "1.5", "0", "-1", *SIZES]
SHAPES = ((10**12,), (2**33, 2**33), (7 * 10**9,), (2**63,), (-1,), (0,), ())
ARRAYS = ("data", "indices", "indptr", "format", "shape")  # of SciPy's archive
HEADS = r"^(\d+)[, ] ?(\d+)(?:[, ] ?(\d+))?"
CARDS = r"^(?:DMIG\*   KAAX|\*)( +\d+)( +\d+)"


@cache
def stiffness() -> csr_matrix:
    """A symmetric matrix of four nodes with zeros."""
    A = np.random.default_rng(1).normal(size=(12, 12))
    A[abs(A) < 0.5] = 0.0
    return csr_matrix(A + A.T + 20 * np.eye(12))


@cache
def files() -> list[tuple[str, dict[str, bytes]]]:
    """The matrix in all formats: the name of the file with K, and all files of its program."""
    A, found, rows = stiffness(), [], np.array([*product(range(1, 5), (1, 2, 3))])
    market = {
        "market.mtx": lambda folder, *_: mmwrite(folder / "market.mtx", A, symmetry="symmetric"),
        "array.mtx": lambda folder, *_: mmwrite(folder / "array.mtx", A.toarray()),
    }
    for name, write in (WRITERS | market).items():
        with tempfile.TemporaryDirectory() as folder:
            written = write(Path(folder), A, A, rows) or Files(name, name)
            paths = sorted(Path(folder).iterdir())
            found.append((written.K, {path.name: path.read_bytes() for path in paths}))
    return found


def _case(change: str, main: str, held: dict[str, bytes]) -> Case:
    def read(folder: Path) -> Any:
        return read_matrix(folder / main, "K").A

    return Case("matrix", change, held, read, "either", partial(_fault, held[main]))


def _fault(data: bytes, A: csr_matrix) -> str:
    """Entries that no text says; or others than those of an archive, which has check sums."""
    if data.startswith(b"PK"):
        same = A.shape == stiffness().shape and not (stiffness() != A).nnz
        return "" if same else "another matrix"
    text = re.sub(r"(?<=[\d.])[dD](?=[-+\d])", "E", data.decode(errors="replace"))
    numbers = map(float, re.findall(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", text))
    return "" if {*A.data} <= {0.0, *numbers} else "holds numbers that the file has not"


@st.composite
def texts(draw: st.DrawFn) -> Case:
    """Lines, cells and sizes; DoFs of CalculiX."""
    main, held = draw(st.sampled_from([of for of in files() if not of[0].endswith(".npz")]))
    file = draw(st.sampled_from([main, main, *(name for name in held if name == "job.dof")]))
    text = held[file].decode()
    rows = range(text.count("\n"))
    changed = [line(text, rows, "lost", "twice", "cut"), long(text, rows), cut(text)]
    changed += [cell(text, rows, NUMBERS)] * 2
    if file == main:
        changed += [size(text, CARDS if main.endswith(".pch") else HEADS)] * 3
    change, text = draw(st.one_of(changed))
    return _case(change, main, held | {file: text.encode()})


@st.composite
def archives(draw: st.DrawFn) -> Case:
    """Bytes of an archive; the head of an array with another shape, its check sums right."""
    main, held = next(of for of in files() if of[0].endswith(".npz"))
    if draw(st.booleans()):
        change, data = draw(binary(held[main]))
        return _case(change, main, held | {main: data})
    array, shape = draw(st.sampled_from(ARRAYS)), draw(st.sampled_from(SHAPES))
    with zipfile.ZipFile(changed := io.BytesIO(), "w") as new:
        for name, values in np.load(io.BytesIO(held[main])).items():
            about = {"descr": values.dtype.str, "fortran_order": False, "shape": values.shape}
            about |= {"shape": shape} if name == array else {}
            np.lib.format.write_array_header_2_0(head := io.BytesIO(), about)
            new.writestr(f"{name}.npy", head.getvalue() + values.tobytes())
    return _case("shape", main, held | {main: changed.getvalue()})


def matrix_cases() -> Cases:
    """All of these; a matrix of Ansys is none."""
    none = st.binary(max_size=200).map(lambda data: _case("binary", "K.full", {"K.full": data}))
    return st.one_of(texts(), texts(), archives(), none)
