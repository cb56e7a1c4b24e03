"""Rods and masses that meet a stop: "blades" whose tip they are."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag, eigh

from geometry.base import Provenance, check_settings
from rom.model import Rom
from simulate.scene import Scene

# m, of the casing and of its one strip of liner. The footprint is a 25,000th of the circumference:
# a harmonic of the casing hardly changes under it. Five times as wide it takes 3e-4 off A1.
RADIUS, WIDTH, FOOTPRINT, THICKNESS, RODS = 10.0, 0.8, 0.0025, 0.1, 32749


def clamped_rod(stiffness: float, mass: float, length: float, elements: int, highest: float) -> Rom:
    """Model of a clamped-free rod of linear elements with consistent masses.

    Parameters
    ----------
    stiffness : E A / L, N/m
    mass : of the rod, kg
    length : m
    highest : highest speed of a scene, rad/s
    """
    M, K = matrices(stiffness, mass, elements)
    return of_end(M, K, ("radial",), length, highest)


def of_end(
    M: NDArray[np.float64],
    K: NDArray[np.float64],
    directions: tuple[str, ...],
    length: float,
    highest: float,
    by_rotation: NDArray[np.float64] | None = None,
) -> Rom:
    """Model of matrices whose first DoFs are the displacements of the end in some directions.

    ``by_rotation``: what each Omega^2 adds to ``K``.

    The interface has two places: the end is a rigid face, whose tilts, of masses and stiffnesses of
    their own, the force in its middle does not move.
    """
    n, many = len(M), len(directions)
    # displacements, tilts and others, by the displacements of both places and others
    to_both = np.eye(n + many)
    to_both[: 2 * many, : 2 * many] = np.kron([[0.5, 0.5], [0.5, -0.5]], np.eye(many))
    with_tilts = np.r_[:many, n : n + many, many:n]
    M, K, *more = (
        to_both.T @ block_diag(A, A.max() * np.eye(many))[np.ix_(with_tilts, with_tilts)] @ to_both
        for A in (M, K, *(() if by_rotation is None else (by_rotation,)))
    )
    ends = np.linspace(0, WIDTH, 3)
    return Rom(
        M=M,
        K=np.stack([K, *more]),
        directions=directions,
        xi=np.array([0.0, 1.0]),
        points=np.zeros((0, 3)),
        camber=np.column_stack([np.full(3, RADIUS), np.zeros(3), ends]),
        Omega_m=highest,
        f1=np.sqrt(eigh(K, M, eigvals_only=True)[0]) / (2 * np.pi),
        span=length,
        provenance=Provenance("rod", "", {}, ""),
    )


def matrices(
    stiffness: float, mass: float, elements: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """M and K of the rod, its free end first, without the clamped one."""
    return (
        _chain(elements, 2, 1) * mass / (6 * elements),
        _chain(elements, 1, -1) * stiffness * elements,
    )


def _chain(elements: int, own: float, coupling: float) -> NDArray[np.float64]:
    """Sum of the element matrices over the nodes from the free end on, without the clamped one."""
    matrix = np.zeros((elements + 1, elements + 1))
    for e in range(elements):
        matrix[e : e + 2, e : e + 2] += [[own, coupling], [coupling, own]]
    return matrix[:-1, :-1]


def elastic(stiffness: float) -> dict:
    """Law of a liner that is a stop of ``stiffness``, N/m."""
    E = stiffness * THICKNESS / (WIDTH * FOOTPRINT)
    return {"kind": "elastic", "E": E / 1e9, "unit_MPa": 1000}


def scene_of(law: dict, gap: float, **more: object) -> Scene:
    """Scene of a stop with a ``law`` behind a ``gap`` (m)."""
    liner = {"law": law, "thickness_m": THICKNESS, "strips": 1, "footprint_m": FOOTPRINT}
    values = {
        "blade": "rod",
        "clearance": {"leading_edge_m": gap, "trailing_edge_m": gap},
        "liner": liner | {"rods_per_round": RODS},
    }
    return check_settings(Scene, values | more, "rod")


def of_modes(
    omega: NDArray[np.float64], tip: NDArray[np.float64], length: float, highest: float
) -> Rom:
    """Model of modes ``omega`` (n,), rad/s, of 1 kg, with displacements (n,) of the end.

    Besides those of its tilt. The first DoF is the end, each other a mode of its own.
    """
    own = np.eye(len(omega))
    own[0] = tip
    back = np.linalg.inv(own)
    M, K = (back.T @ np.diag(of) @ back for of in (np.ones_like(omega), omega**2))
    return of_end(M, K, ("radial",), length, highest)
