"""Full matrices made elsewhere, read into those of this project, with their interface operator."""

from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.io import mmread
from scipy.sparse import csr_matrix, load_npz

from fem.interface import on_patches
from fem.matrices import CODE, Matrices
from geometry.errors import UserError
from geometry.given import GivenMatrices
from geometry.hats import hat_nodes
from geometry.provenance import Provenance, code_hash, file_hash, fingerprint
from geometry.tip import PLACES, on_line

READERS = {".mtx": partial(mmread, spmatrix=False), ".npz": load_npz}
SYMMETRIC = 1e-9  # of the largest entry


class GivenError(UserError):
    """A file of given matrices that cannot be read or does not fit the others."""


def read_matrices(blade: GivenMatrices, name: str, folder: str | Path) -> Matrices:
    """Matrices of the files that ``blade`` names, from ``folder``; ``name`` of the blade.

    The static deflections are not known: the reduced model does not know the growth of its tip.

    Raises
    ------
    GivenError
        When a file cannot be read, or does not fit the others.
    geometry.errors.MeshError
        When the facets of the tip do not allow the interface.
    """
    of, folder = blade.full_matrices, Path(folder)
    nodes = _table(folder / of.nodes, 3)
    n_full = 3 * len(nodes)
    M = _symmetric(folder / of.M, n_full)
    K = tuple(_symmetric(folder / of.K[speed], n_full) for speed in blade.speeds)
    if of.tip is None:
        S = _matrix(folder / of.S, (3 * blade.patches, n_full))
        camber = _camber(_table(folder / of.camber, 3))
    else:
        facets = _facets(folder / of.tip, len(nodes))
        S, camber = on_patches(nodes, facets, np.arange(n_full), blade.patches)
    files = [file_hash(folder / file) for file in blade.files]
    return Matrices(
        M=M,
        K=K,
        S=S,
        coordinates=nodes,
        xi=hat_nodes(blade.patches),
        points=np.empty((0, 3)),
        camber=camber,
        span=float(camber[:, 0].mean() - of.hub_radius_m),
        speeds=np.array(blade.speeds),
        u_static=np.full((len(K), n_full), np.nan),  # not known
        residuals=np.full(len(K), np.nan),
        provenance=Provenance(
            name, fingerprint(files), blade.settings_of_matrices(), code_hash(*CODE)
        ),
    )


def _matrix(path: Path, shape: tuple[int, int]) -> csr_matrix:
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise GivenError(
            f"{path}: suffix {path.suffix or 'missing'}: known are {', '.join(READERS)}"
        )
    try:
        A = csr_matrix(reader(path))
    except Exception as error:  # readers raise various exceptions for damaged files
        what = " ".join(f"{type(error).__name__} {error}".split())
        raise GivenError(f"{path}: cannot be read as {path.suffix} ({what})") from None
    if A.shape != shape:
        raise GivenError(
            f"{path}: {A.shape[0]} rows and {A.shape[1]} columns, needs {shape[0]} and {shape[1]}: "
            f"three DoFs for each row of `nodes`"
        )
    if not np.isfinite(A.data).all():
        raise GivenError(f"{path}: holds values that are not finite")
    return A


def _symmetric(path: Path, n: int) -> csr_matrix:
    """A symmetric matrix (n, n); symmetric to the last bit."""
    A = _matrix(path, (n, n))
    apart, largest = abs(A - A.T).max(), abs(A).max()
    if apart > SYMMETRIC * largest:
        raise GivenError(
            f"{path}: not symmetric, by {apart / largest:.2g} of its largest entry; allowed "
            f"{SYMMETRIC:g} (a triangle alone needs the word `symmetric` in its first line)"
        )
    return csr_matrix((A + A.T) / 2)


def _table(path: Path, columns: int) -> NDArray[np.float64]:
    """Numbers (rows, columns) of a CSV file; lines that begin with # are comments."""
    try:
        values = np.loadtxt(path, delimiter=",", ndmin=2)
    except (OSError, ValueError) as error:
        raise GivenError(f"{path}: cannot be read as CSV ({error})") from None
    if values.shape[1] != columns or not np.isfinite(values).all():
        raise GivenError(f"{path}: {values.shape[1]} columns, needs {columns} finite numbers a row")
    return values


def _facets(path: Path, nodes: int) -> NDArray[np.int64]:
    """Facets (k, 6) by rows of the nodes, from 0."""
    values = _table(path, 6)
    facets = values.astype(int)
    if np.any(facets != values) or facets.min() < 1 or facets.max() > nodes:
        raise GivenError(f"{path}: needs whole numbers from 1 to {nodes}, the rows of `nodes`")
    return facets - 1


def _camber(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Camber line (PLACES, 3), r, theta, z, of points x, y, z evenly spaced in xi."""
    x, y, z = points.T
    line = np.column_stack([np.hypot(x, y), np.unwrap(np.arctan2(y, x)), z])
    return on_line(line, np.linspace(0, 1, PLACES))
