"""Assembly of M, K(Omega) and S from mesh, material and speeds."""

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from fem.cholesky import Cholesky
from fem.interface_operator import interface_of
from fem.matrices import CODE, Constants, Matrices, Prestressed
from fem.prestress import linear_states, mass, nonlinear_states
from fem.solid import Solid, read_solid
from geometry.base import Provenance, code_hash, file_hash
from geometry.blade import Blade
from geometry.shape import source_of

STATES = {"nonlinear": nonlinear_states, "linear": linear_states}


def assemble(blade: Blade, name: str, mesh_path: str | Path, speeds: Iterable[float]) -> Matrices:
    """M, K(Omega) at ascending ``speeds`` (rad/s) with the blade's prestress, and S.

    ``name``: name of the blade, for the provenance. Raises the errors of ``over_speeds``.
    """
    return Matrices.of(*over_speeds(blade, name, mesh_path, speeds))


def over_speeds(
    blade: Blade,
    name: str,
    mesh_path: str | Path,
    speeds: Iterable[float],
    cholesky: Cholesky | None = None,
    solid: Solid | None = None,
) -> tuple[Constants, Iterator[Prestressed]]:
    """M and S, and the state at each of the ``speeds`` (rad/s), taken when it is asked for.

    Parameters
    ----------
    name : name of the blade, for the provenance
    speeds : ascending, but for those between equilibria that are known
    cholesky : holds the factor of K of each state, with prestress `nonlinear`; see there
    solid : the mesh, where it is read already

    Raises
    ------
    fem.prestress.EquilibriumError
        When a static equilibrium is not found.
    geometry.base.errors.MeshError
        When the facets of the tip do not allow the interface.
    """
    solid = solid or read_solid(str(mesh_path), blade.material)
    interface = interface_of(solid, blade)
    hub = solid.clamped_coordinates()
    settings, made_of = blade.settings_of_matrices(), source_of(mesh_path)
    settings |= {"source": made_of} if made_of else {}
    constants = Constants(
        M=mass(solid),
        coordinates=solid.free_coordinates(),
        **vars(interface),
        span=float(interface.camber[:, 0].mean() - np.hypot(hub[:, 0], hub[:, 1]).mean()),
        provenance=Provenance(name, file_hash(mesh_path), settings, code_hash(*CODE)),
    )
    return constants, STATES[blade.prestress](solid, speeds, cholesky)
