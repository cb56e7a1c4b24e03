"""Mesh, material and speeds -> ``Matrices``."""

import hashlib
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_matrix

from fem.interface import cylindrical, dofs_at
from fem.matrices import Matrices
from fem.prestress import linear_states, mass, nonlinear_states
from fem.solid import read_solid
from geometry.blade import Blade
from geometry.interface import InterfaceNodes

STATES = {"nonlinear": nonlinear_states, "linear": linear_states}


def assemble(
    blade: Blade, mesh_path: str | Path, interface_path: str | Path, speeds: ArrayLike
) -> Matrices:
    """M and K(Omega) at ascending ``speeds`` (rad/s) with the blade's prestress.

    Raises
    ------
    fem.prestress.EquilibriumError
        When a static equilibrium is not found.
    """
    interface = InterfaceNodes.load(interface_path)
    solid = read_solid(str(mesh_path), blade.material)
    coordinates = solid.free_coordinates()
    dofs = dofs_at(coordinates, interface.points)
    Q = cylindrical(len(solid.free), dofs, interface.theta)
    states = list(STATES[blade.prestress](solid, np.asarray(speeds, dtype=float)))
    return Matrices(
        M=_turn(mass(solid), Q),
        K=tuple(_turn(state.K, Q) for state in states),
        speeds=np.array([state.speed for state in states]),
        u_static=np.array([state.u_static for state in states]),
        residuals=np.array([state.residual for state in states]),
        coordinates=coordinates,
        interface_dofs=dofs,
        interface_points=interface.points,
        span=float(interface.radius.mean() - _radius(solid.clamped_coordinates()).mean()),
        mesh_hash=hashlib.sha256(Path(mesh_path).read_bytes()).hexdigest(),
    )


def _radius(points: NDArray) -> NDArray:
    return np.hypot(points[:, 0], points[:, 1])


def _turn(A: csr_matrix, Q: csr_matrix) -> csr_matrix:
    """Q^T A Q, symmetric to the last bit."""
    turned = Q.T @ A @ Q
    return ((turned + turned.T) / 2).tocsr()
