"""Full matrices made elsewhere, read into those of this project, with their interface operator."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.io import mmread
from scipy.sparse import csr_matrix, load_npz

from fem.interface import directions, on_patches
from fem.matrices import CODE, Matrices
from geometry.given import (
    OFF_LINE,
    SYMMETRIC,
    Check,
    FullMatrices,
    GivenMatrices,
    failed,
    tip_checks,
)
from geometry.hats import hat_nodes
from geometry.project import (
    Provenance,
    UserError,
    about,
    code_hash,
    csv_rows,
    file_hash,
    fingerprint,
    numbers,
    require_file,
)
from geometry.tip import PLACES, cartesian, on_line

XYZ = ("x", "y", "z")
READERS = {".mtx": partial(mmread, spmatrix=False), ".npz": load_npz}
# Coordinates to a micrometre err by 6e-6 in forces of rotations, six digits of K by 6e-7; another
# order of DoFs by 1e-3 and more.
RIGID = 1e-4
# kg/m3; a quarter of the material's for solid blades, less for hollow ones: units err by 1000.
DENSITY = 20.0, 25000.0
# m/s; a tapered blade of metal has 7000 to 8000. Units err by the root of 1000: from anywhere in
# this range that leads out of it.
WAVE_SPEED = 1000.0, 30000.0
CHANGE = 1e-9, 0.5  # blades of this project have 4e-4 to 0.02

# file, what, value, allowed, remedy
type Measure = tuple[str, str, float, tuple[float, float], str]


class GivenError(UserError):
    """A file of given matrices that cannot be read or does not fit the others."""


def read_matrices(blade: GivenMatrices, name: str, folder: str | Path) -> Matrices:
    """Matrices of the files that ``blade`` names, from ``folder``; ``name`` of the blade.

    The static deflections are not known: the reduced model does not know the growth of its tip.

    Raises
    ------
    GivenError
        When a file cannot be read, or does not fit the others.
    geometry.project.errors.MeshError
        When the facets of the tip do not allow the interface.
    """
    of, folder = blade.full_matrices, Path(folder)
    nodes = _table(folder / of.nodes, XYZ)
    n_full = 3 * len(nodes)
    M = _symmetric(folder / of.M, n_full)
    K = tuple(_symmetric(folder / of.K[speed], n_full) for speed in blade.speeds)
    if of.tip is None:
        S = _matrix(folder / of.S, (3 * blade.patches, n_full))
        camber = _camber(_table(folder / of.camber, XYZ))
    else:
        facets = _facets(folder / of.tip, len(nodes))
        S, camber = on_patches(nodes, facets, np.arange(n_full), blade.patches)
    files = [file_hash(folder / file) for file in blade.files]
    fom = Matrices(
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
    _check(fom, of, folder)
    return fom


def _require(path: Path, *checks: Check) -> None:
    """Refuse the file at ``path`` by the first fault whose check does not hold."""
    if faults := failed(*checks):
        raise GivenError(faults[0], file=path)


def _check(fom: Matrices, of: FullMatrices, folder: Path) -> None:
    """Check that the matrices are those of a blade in SI, in its frame, at its nodes."""
    _require(folder / (of.camber or of.nodes), *tip_checks(fom.camber, fom.span, fom.top_speed))
    measures = [
        *_of_mass(fom, of),
        *_of_stiffness(fom, of),
        *(_of_operator(fom, of) if of.S else ()),
    ]
    for file, what, value, (least, most), remedy in measures:
        fault = f"{what}: {value:.3g}, allowed {least:g} to {most:g}: {remedy}"
        _require(folder / file, (least <= value <= most, fault))


def _of_mass(fom: Matrices, of: FullMatrices) -> list[Measure]:
    e = np.tile(np.eye(3), (len(fom.coordinates), 1))
    masses = e.T @ (fom.M @ e)
    mass = masses[0, 0]
    box = np.sqrt(np.linalg.det(12 * np.cov(fom.coordinates.T)))  # a box's own: its volume
    return [
        (
            of.M,
            "difference of the masses in x, y and z, or mass that couples them, over the mass",
            abs(masses - mass * np.eye(3)).max() / mass,
            (0.0, RIGID),
            "DoFs must be x, y, z of each node",
        ),
        (
            of.M,
            f"mass of {mass:.4g} kg over the box of {box:.3g} m3 that the nodes fill, kg/m3",
            mass / box,
            DENSITY,
            "check the units of M (kg) and nodes (m)",
        ),
    ]


def _of_stiffness(fom: Matrices, of: FullMatrices) -> list[Measure]:
    """Rotations need forces at the clamp alone; how fast waves run shows units.

    Speed changes the matrix little, but does change it.
    """
    x, K = fom.coordinates, fom.K[0]
    turned = np.cross(np.eye(3)[:, None], x - x.mean(axis=0)).reshape(3, -1).T
    forces, alone = K @ turned, abs(K) @ abs(turned)
    r = np.hypot(x[:, 0], x[:, 1])
    away = np.repeat(r > np.median(r), 3)
    along = (r - fom.camber[:, 0].mean()) / fom.span + 1  # 0 at the hub, 1 at the tip
    stretched = ((along / r)[:, None] * x * [1, 1, 0]).ravel()
    squared = (stretched @ (K @ stretched)) / (stretched @ (fom.M @ stretched))
    return [
        (
            of.K[0],
            "forces away from the clamp in rotations of the whole blade, over those of single DoFs",
            np.linalg.norm(forces[away]) / np.linalg.norm(alone[away]),
            (0.0, RIGID),
            "nodes must be in the order and the frame of the matrices, DoFs x, y, z of each",
        ),
        (
            of.K[0],
            "forces in rotations of the whole blade, over those of single DoFs",
            np.linalg.norm(forces) / np.linalg.norm(alone),
            (RIGID, 1.0),
            "K must be clamped: leave out the DoFs of clamped nodes",
        ),
        (
            of.K[0],
            "speed of waves along the blade, m/s",
            fom.span * np.sqrt(squared / 3),  # exact for a bar
            WAVE_SPEED,
            "check the units of K (N/m) and M (kg), and hub_radius_m",
        ),
        *(
            (
                of.K[speed],
                "change from K at rest, over its largest entry",
                abs(spun - K).max() / abs(K).max(),
                CHANGE,
                "check the unit (N/m), the order of DoFs, and that it is prestressed",
            )
            for speed, spun in zip(fom.speeds[1:], fom.K[1:], strict=True)
        ),
    ]


def _of_operator(fom: Matrices, of: FullMatrices) -> list[Measure]:
    """S finds translations in the directions of each patch, and the nodes at its place."""
    line = on_line(fom.camber, fom.xi)
    chord = np.linalg.norm(np.diff(cartesian(line[[0, -1]]), axis=0))
    fields = np.column_stack(
        [np.tile(np.eye(3), (len(fom.coordinates), 1)), fom.coordinates.ravel() / chord]
    )
    known = np.dstack([directions(cartesian(line)), line * [1, 0, 1] / chord])
    error = abs((fom.S @ fields).reshape(known.shape) - known).max(axis=(1, 2))
    return [
        (
            of.S,
            f"error of patch {error.argmax() + 1} in unit translations, or of its place over the "
            f"chord",
            error.max(),
            (0.0, OFF_LINE),  # 5e-3 with S of three patches
            "rows must be radial, tangential, axial of each patch, leading edge first, on hats "
            "evenly spaced on the camber line",
        )
    ]


def _matrix(path: Path, shape: tuple[int, int]) -> csr_matrix:
    with about(path, GivenError):
        require_file(path, READERS)
    try:
        A = csr_matrix(READERS[path.suffix.lower()](path))
    except Exception as error:  # readers raise various exceptions for damaged files
        raise GivenError(f"cannot be read as {path.suffix} ({error!r})", file=path) from None
    _require(
        path,
        (
            A.shape == shape,
            f"{A.shape[0]} rows and {A.shape[1]} columns, needs {shape[0]} and {shape[1]}: "
            f"three for each row of `nodes`, and in S for each of `patches`",
        ),
        (
            np.isrealobj(A.data) and np.isfinite(A.data).all(),
            "holds values that are not finite real numbers",
        ),
    )
    return A.astype(float)


def _symmetric(path: Path, n: int) -> csr_matrix:
    """A symmetric matrix (n, n); symmetric to the last bit."""
    A = _matrix(path, (n, n))
    apart = abs(A - A.T).max() / (abs(A).max() or 1.0)
    least = A.diagonal().argmin()
    _require(
        path,
        (
            apart <= SYMMETRIC,
            f"not symmetric, by {apart:.2g} of its largest entry; allowed {SYMMETRIC:g} (a "
            f"triangle alone needs the word `symmetric` in its first line)",
        ),
        (
            A[least, least] > 0,
            f"{A[least, least]:.3g} on the diagonal of row {least + 1}; must be above 0: each DoF "
            f"has mass and stiffness, and only those that are not clamped belong to it",
        ),
    )
    return csr_matrix((A + A.T) / 2)


def _table(path: Path, columns: Sequence[str]) -> NDArray[np.float64]:
    """Numbers (rows, columns) of a CSV file without a header; lines with # are comments."""
    with about(path, GivenError):
        rows = [numbers(cells, columns, line) for line, cells in csv_rows(path)]
    _require(path, (len(rows) > 0, f"has no row of {', '.join(columns)}"))
    return np.array(rows)


def _facets(path: Path, nodes: int) -> NDArray[np.int64]:
    """Facets (k, 6) by rows of the nodes, from 0."""
    values = _table(path, [f"node {i}" for i in range(1, 7)])
    facets = values.astype(int)
    _require(
        path,
        (
            np.all(facets == values) and facets.min() >= 1 and facets.max() <= nodes,
            f"needs whole numbers from 1 to {nodes}, the rows of `nodes`",
        ),
        (
            len(np.unique(np.sort(facets), axis=0)) == len(facets),
            "the same facet in two rows; allowed one: take one of them out",
        ),
    )
    return facets - 1


def _camber(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Camber line (PLACES, 3), r, theta, z, of points x, y, z evenly spaced in xi."""
    x, y, z = points.T
    line = np.column_stack([np.hypot(x, y), np.unwrap(np.arctan2(y, x)), z])
    return on_line(line, np.linspace(0, 1, PLACES))
