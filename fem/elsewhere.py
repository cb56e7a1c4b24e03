"""Full matrices made elsewhere, read into those of this project, with their interface operator."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix, eye_array

from fem.deck import Deck, deck_of
from fem.interface_operator import directions
from fem.matrices import CODE, Matrices
from fem.matrix_files import ElsewhereError, read_matrix
from geometry.base import (
    Provenance,
    about,
    code_hash,
    csv_rows,
    known,
    numbers,
    require,
    shifted,
    unquoted,
)
from geometry.elsewhere import OFF_LINE, SYMMETRIC, FullMatrices, MatricesElsewhere, tip_checks
from geometry.hats import hat_nodes
from geometry.tip import PLACES, cartesian, on_line

XYZ = ("x", "y", "z")
# Coordinates to a micrometre err by 4e-6 in forces of rotations, one axis longer by a tenth by 4e-5
# to 7e-5, another order of DoFs by 1e-3 and more.
SAME_PLACES = 2e-5
RIGID = 1e-4
# Digits of K: ten err by 5e-11 in forces of translations, and by 5e-5 in f1; nine by 4e-4 in f1,
# seven by a tenth, for bending of a thin blade is the small difference of large entries.
DIGITS = 1e-9
# kg/m3; a quarter of the material's for solid blades, less for hollow ones: units err by 1000.
DENSITY = 20.0, 25000.0
# m/s; a tapered blade of metal has 7000 to 8000. Units err by the root of 1000: from anywhere in
# this range that leads out of it.
WAVE_SPEED = 1000.0, 30000.0
LARGEST = 1e30  # on the diagonal, in any unit: Abaqus constrains a direction by 1e36
# Equal to 1 to 1e-7: speed of a spin softening over the given one, 0 without softening, 6 in Hz;
# the mass where K is not zero over all, with nodes in another order 0.3 and less.
AS_SAID = 0.9, 1.1
CHANGE = 1e-9, 0.5  # blades of this project have 4e-4 to 0.02

# file, quantity, value, allowed, remedy
type Measure = tuple[str, str, float, tuple[float, float], str]


def read_matrices(blade: MatricesElsewhere, name: str, folder: str | Path) -> Matrices:
    """Matrices of the files that ``blade`` names, from ``folder``; ``name`` of the blade.

    The static deflections are not known: the reduced model does not know the growth of its tip.

    Raises
    ------
    ElsewhereError
        When a file cannot be read, or does not fit the others.
    geometry.base.errors.MeshError
        When the facets of the tip do not allow the interface.
    """
    files, folder = blade.full_matrices, Path(folder)
    deck = deck_of(files.mesh_file, folder) if files.mesh_file else _of_nodes(files, folder)
    M = _symmetric(folder / files.M, "M", deck)
    K = tuple(_symmetric(folder / files.K[speed], "K", deck) for speed in blade.speeds)
    S, camber, sides = _interface(files, folder, deck, **blade.settings_of_matrices()["interface"])
    of_files = blade.hash_of_files(folder)
    fom = Matrices(
        M=M,
        K=K,
        weights=np.eye(len(K)),
        S=S,
        coordinates=deck.coordinates,
        xi=hat_nodes(blade.patches),
        points=np.empty((0, 3)),
        camber=camber,
        sides=sides,
        span=float(camber[:, 0].mean() - deck.hub_radius),
        speeds=np.array(blade.speeds),
        u_static=np.full((len(K), M.shape[0]), np.nan),  # not known
        residuals=np.full(len(K), np.nan),
        provenance=Provenance(name, of_files, blade.settings_of_matrices(), code_hash(*CODE)),
    )
    _check(fom, files, folder)
    return fom


def _of_nodes(files: FullMatrices, folder: Path) -> Deck:
    """Nodes of a table, all free, and facets of the tip between them."""
    nodes = _table(folder / known(files.nodes, "nodes"), XYZ)
    return Deck(
        numbers=np.arange(len(nodes)) + 1,
        clamped=np.empty(0, dtype=int),
        coordinates=nodes,
        hub_radius=shifted(known(files.hub_radius_mm, "hub_radius_mm"), -3),
        points=nodes,
        tip=_facets(folder / files.tip, len(nodes)) if files.tip else np.empty((0, 6), dtype=int),
        weights=eye_array(len(nodes)),
    )


def _interface(
    files: FullMatrices, folder: Path, deck: Deck, patches: int, across: int
) -> tuple[csr_matrix, NDArray[np.float64], NDArray[np.float64]]:
    """S, camber line and sides as of ``on_patches``, of files or on the facets of the tip."""
    if files.S is None:
        return deck.interface(patches, across)
    S, needed = read_matrix(folder / files.S, "S").A, (3 * patches, 3 * len(deck.numbers))
    require(
        (
            S.shape == needed,
            f"{S.shape[0]} rows and {S.shape[1]} columns, needs {needed[0]} and {needed[1]}: three "
            "for each of `patches` and `nodes`",
        ),
        kind=ElsewhereError,
        file=folder / files.S,
    )
    return S, _camber(_table(folder / known(files.camber, "camber"), XYZ)), np.empty((2, 0))


def _check(fom: Matrices, files: FullMatrices, folder: Path) -> None:
    """Check that the matrices are those of a blade in SI, in its frame, at its nodes."""
    mesh = files.mesh_file.file if files.mesh_file else known(files.nodes, "nodes")
    require(
        *tip_checks(fom.camber, fom.span, fom.top_speed),
        kind=ElsewhereError,
        file=folder / (files.camber or mesh),
    )
    for file, what, value, (least, most), remedy in (
        *_of_mass(fom, files),
        *_of_stiffness(fom, files),
        *(_of_operator(fom, files.S) if files.S else ()),
    ):
        fault = f"{what}: {value:.3g}, allowed {least:g} to {most:g}: {remedy}"
        require(
            (least <= value <= most, fault),
            kind=ElsewhereError,
            file=folder / file,
        )


def _of_mass(fom: Matrices, files: FullMatrices) -> list[Measure]:
    e = np.tile(np.eye(3), (len(fom.coordinates), 1))
    masses = e.T @ (fom.M @ e)
    mass = masses[0, 0]
    box = np.sqrt(np.linalg.det(12 * np.cov(fom.coordinates.T)))  # a box's own: its volume
    return [
        (
            files.M,
            "difference of the masses in x, y and z, or mass that couples them, over the mass",
            abs(masses - mass * np.eye(3)).max() / mass,
            (0.0, RIGID),
            "DoFs must be x, y, z of each node",
        ),
        (
            files.M,
            f"mass of {mass:.4g} kg over the box of {box:.3g} m3 that the nodes fill, kg/m3",
            mass / box,
            DENSITY,
            "check the units of M (kg) and nodes (m)",
        ),
    ]


def _of_stiffness(fom: Matrices, files: FullMatrices) -> list[Measure]:
    """Rigid motions need forces at the clamp alone; how fast waves run shows units.

    At a speed translations e in x and y meet spin softening, K(Omega) e = -Omega^2 M e away from
    the clamp: -Omega^2 M_spin of Eqs. (c), (d) in fem/README.md.

    Speed changes the matrix little, but does change it.
    """
    x, K = fom.coordinates, fom.K[0]
    turned = np.cross(np.eye(3)[:, None], x - x.mean(axis=0)).reshape(3, -1).T
    moved = np.tile(np.eye(3), (len(x), 1))
    forces, alone, inertia = K @ turned, abs(K) @ abs(turned), fom.M @ moved[:, :2]
    r = np.hypot(x[:, 0], x[:, 1])
    away = np.repeat(r > np.median(r), 3)
    along = (r - fom.camber[:, 0].mean()) / fom.span + 1  # 0 at the hub, 1 at the tip
    stretched = ((along / r)[:, None] * x * [1, 1, 0]).ravel()
    squared = (stretched @ (K @ stretched)) / (stretched @ (fom.M @ stretched))
    return [
        (
            files.K[0],
            "forces away from the clamp in rotations of the whole blade, over those of single DoFs",
            np.linalg.norm(forces[away]) / np.linalg.norm(alone[away]),
            (0.0, SAME_PLACES),
            "nodes must be in the order and the frame of the matrices, DoFs x, y, z of each",
        ),
        (
            files.K[0],
            "forces away from the clamp in translations of the whole blade, over those of single "
            "DoFs",
            np.linalg.norm((K @ moved)[away]) / np.linalg.norm((abs(K) @ moved)[away]),
            (0.0, DIGITS),
            "K needs nine digits, better ten: fewer lose the bending of a thin blade in round-off",
        ),
        (
            files.K[0],
            "forces in rotations of the whole blade, over those of single DoFs",
            np.linalg.norm(forces) / np.linalg.norm(alone),
            (RIGID, 1.0),
            "K must be clamped: leave out the DoFs of clamped nodes",
        ),
        (
            files.K[0],
            "speed of waves along the blade, m/s",
            fom.span * np.sqrt(squared / 3),  # exact for a bar
            WAVE_SPEED,
            "check the units of K (N/m) and M (kg), and hub_radius_mm",
        ),
        (
            files.M,
            "mass between DoFs that K couples, over that between any",
            abs(fom.M).multiply(fom.K[0].astype(bool)).sum() / abs(fom.M).sum(),
            AS_SAID,
            "rows of M and K must be in one order",
        ),
        *(
            (
                files.K[speed],
                "change from K at rest, over its largest entry",
                abs(spun - K).max() / abs(K).max(),
                CHANGE,
                "check the unit (N/m), the order of DoFs, and that it is prestressed",
            )
            for speed, spun in zip(fom.speeds[1:], fom.K[1:], strict=True)
        ),
        *(
            (
                files.K[speed],
                "speed that its spin softening is of, over the given one",
                np.sqrt(
                    max(-((spun @ moved[:, :2]) * inertia)[away].sum(), 0.0)
                    / (inertia[away] ** 2).sum()
                )
                / speed,  # it takes speed squared times the inertia of x and y from K
                AS_SAID,
                "check the speed (rad/s, not Hz or rpm), and that K has the softening",
            )
            for speed, spun in zip(fom.speeds[1:], fom.K[1:], strict=True)
        ),
    ]


def _of_operator(fom: Matrices, file: str) -> list[Measure]:
    """S, of ``file``, finds translations in the directions of each patch, and the nodes there."""
    line = on_line(fom.camber, fom.xi)
    chord = np.linalg.norm(np.diff(cartesian(line[[0, -1]]), axis=0))
    fields = np.column_stack(
        [np.tile(np.eye(3), (len(fom.coordinates), 1)), fom.coordinates.ravel() / chord]
    )
    exact = np.dstack([directions(cartesian(line)), line * [1, 0, 1] / chord])
    error = abs((fom.S @ fields).reshape(exact.shape) - exact).max(axis=(1, 2))
    return [
        (
            file,
            f"error of patch {error.argmax() + 1} in unit translations, or of its place over the "
            f"chord",
            error.max(),
            (0.0, OFF_LINE),  # 5e-3 with S of three patches
            "rows must be radial, tangential, axial of each patch, leading edge first, on hats "
            "evenly spaced on the camber line",
        )
    ]


def _symmetric(path: Path, letter: str, deck: Deck) -> csr_matrix:
    """M or K (3 n, 3 n); symmetric to the last bit."""
    with about(path, ElsewhereError):
        A = deck.matrix(read_matrix(path, letter))
    asymmetry = abs(A - A.T).max() / (abs(A).max() or 1.0)
    diagonal = A.diagonal()
    worst = int(np.argmax(~((diagonal > 0) & (diagonal < LARGEST))))
    require(
        (
            asymmetry <= SYMMETRIC,
            f"not symmetric, by {asymmetry:.2g} of its largest entry; allowed {SYMMETRIC:g} (a "
            f"triangle alone needs the word `symmetric` in its first line)",
        ),
        (
            0 < diagonal[worst] < LARGEST,
            f"{diagonal[worst]:.3g} on the diagonal of row {worst + 1}; must be above 0: each DoF "
            f"has mass and stiffness, and only those that are not clamped belong to it: check node "
            f"{deck.numbers[worst // 3]}, direction {worst % 3 + 1}",
        ),
        kind=ElsewhereError,
        file=path,
    )
    return csr_matrix((A + A.T) / 2)


def _table(path: Path, columns: Sequence[str]) -> NDArray[np.float64]:
    """Numbers (rows, columns) of a CSV file without a header; lines with # are comments."""
    with about(path, ElsewhereError), unquoted(path):
        rows = [numbers(cells, columns, line) for line, cells in csv_rows(path)]
    require(
        (len(rows) > 0, f"has no row of {', '.join(columns)}"),
        kind=ElsewhereError,
        file=path,
    )
    return np.array(rows)


def _facets(path: Path, nodes: int) -> NDArray[np.int64]:
    """Facets (k, 6) by rows of the nodes, from 0."""
    values = _table(path, [f"node {i}" for i in range(1, 7)])
    facets = values.astype(int)
    require(
        (
            np.all(facets == values) and facets.min() >= 1 and facets.max() <= nodes,
            f"needs whole numbers from 1 to {nodes}, the rows of `nodes`",
        ),
        (
            len(np.unique(np.sort(facets), axis=0)) == len(facets),
            "the same facet in two rows; allowed one: take one of them out",
        ),
        kind=ElsewhereError,
        file=path,
    )
    return facets - 1


def _camber(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Camber line (PLACES, 3), r, theta, z, of points x, y, z evenly spaced in xi."""
    x, y, z = points.T
    line = np.column_stack([np.hypot(x, y), np.unwrap(np.arctan2(y, x)), z])
    return on_line(line, np.linspace(0, 1, PLACES))
