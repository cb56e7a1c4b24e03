"""Assembly of ``Matrices`` from mesh, material and speeds."""

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_matrix

from fem.interface import interface_of
from fem.matrices import CODE, Matrices
from fem.prestress import linear_states, mass, nonlinear_states
from fem.solid import read_solid
from geometry.blade import Blade
from geometry.provenance import Provenance, code_hash, file_hash

STATES = {"nonlinear": nonlinear_states, "linear": linear_states}


def assemble(blade: Blade, name: str, mesh_path: str | Path, speeds: ArrayLike) -> Matrices:
    """M, K(Omega) at ascending ``speeds`` (rad/s) with the blade's prestress, and S.

    ``name``: name of the blade, for the provenance.

    Raises
    ------
    fem.prestress.EquilibriumError
        When a static equilibrium is not found.
    geometry.errors.MeshError
        When the facets of the tip do not allow the interface.
    """
    solid = read_solid(str(mesh_path), blade.material)
    interface = interface_of(solid, blade)
    states = list(STATES[blade.prestress](solid, np.asarray(speeds, dtype=float)))
    hub = solid.clamped_coordinates()
    return Matrices(
        M=_symmetric(mass(solid)),
        K=tuple(_symmetric(state.K) for state in states),
        speeds=np.array([state.speed for state in states]),
        u_static=np.array([state.u_static for state in states]),
        residuals=np.array([state.residual for state in states]),
        coordinates=solid.free_coordinates(),
        S=interface.S,
        xi=interface.xi,
        points=interface.points,
        camber=interface.camber,
        span=float(interface.camber[:, 0].mean() - np.hypot(hub[:, 0], hub[:, 1]).mean()),
        provenance=Provenance(
            name, file_hash(mesh_path), blade.settings_of_matrices(), code_hash(*CODE)
        ),
    )


def _symmetric(A: csr_matrix) -> csr_matrix:
    """Exactly symmetric part of A."""
    return ((A + A.T) / 2).tocsr()
