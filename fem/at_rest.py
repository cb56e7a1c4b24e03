"""The shape at rest of a blade whose geometry is given as it runs."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root

from fem.cholesky import Cholesky
from fem.prestress import nonlinear_states
from fem.solid import Solid, read_solid
from geometry.base import RPM, require
from geometry.blade import Blade
from geometry.mesh import MeshSummary, build_mesh, write_moved

CLOSED = 1e-7  # of the blade's size: largest distance between the shape given and that found
ROUNDS = 30  # most equilibria; six to nine are needed


def build_mesh_at_rest(
    blade: Blade, mesh_path: str | Path, source: str | Path | None = None
) -> MeshSummary:
    """Mesh the blade as ``geometry.mesh.build_mesh``, and write its shape at rest.

    The numbers that are returned are of the geometry as it is given.

    Raises
    ------
    MeshError
        As ``build_mesh``, and when the shape at rest is not found or has cells inside out.
    fem.prestress.EquilibriumError
        When there is no equilibrium at ``geometry_at_rpm``.
    """
    if blade.geometry_at_rpm is None:
        return build_mesh(blade, mesh_path, source)
    with TemporaryDirectory() as folder:
        given = Path(folder, "blade.msh")
        summary = build_mesh(blade, given, source)
        solid = read_solid(str(given), blade.material)
        places = at_rest(solid, blade.geometry_at_rpm / RPM)
        write_moved(given, mesh_path, places)
    return summary


def at_rest(solid: Solid, Omega: float) -> NDArray[np.float64]:
    """Nodes X (n, 3), m, of the shape at rest, in the order of the mesh's file.

    X + u(X) = x, the nodes of ``solid``, with u the deflection of Eq. (a) at ``Omega`` (rad/s). The
    fixed point X <- x - u(X), accelerated after Anderson (1965): alone it closes by a factor of two
    each time, since a blade that is bent otherwise is bent otherwise by its centrifugal load. The
    mesh of ``solid`` is left at rest.

    Raises
    ------
    MeshError
        When it does not close to ``CLOSED`` in ``ROUNDS`` equilibria.
    """
    X = solid.mesh.geometry.x
    x, u, cholesky = X.copy(), np.zeros_like(X), Cholesky()
    size = np.ptp(x, axis=0).max()
    nodes = np.empty(len(X), int)  # of the mesh, by node of the space
    nodes[solid.V.dofmap.list] = solid.mesh.geometry.dofmaps[0]

    def residual(places: NDArray[np.float64]) -> NDArray[np.float64]:
        """X + u(X) - x, (3 n,), over the blade's size, for nodes X at ``places`` (3 n,), m."""
        X[:] = places.reshape(-1, 3)
        (state,) = nonlinear_states(solid, np.array([Omega]), cholesky)
        u[nodes] = solid.field(state.u_static).x.array.reshape(-1, 3)
        return ((X + u - x) / size).ravel()

    # the guess of the derivative of `residual` by X is that of the plain fixed point, 1 / size
    options = {"fatol": CLOSED, "maxiter": ROUNDS, "jac_options": {"alpha": -size}}
    solution = root(residual, x.ravel(), method="anderson", options=options | {"line_search": None})
    closed = abs(solution.fun).max()
    require(
        (
            solution.success,
            f"the shape at rest is not found: after {ROUNDS} steps {closed:.0e} of the blade's "
            f"size is left (allowed {CLOSED:.0e}); is it the speed of the coordinates, in rpm?",
        ),
        key="geometry_at_rpm",
        value=Omega * RPM,
    )
    print(
        f"at rest: nodes moved by up to {1e3 * np.linalg.norm(u, axis=1).max():.4g} mm; at "
        f"{Omega * RPM:g} rpm they are back to {closed:.0e} of the blade's size"
    )
    return X[np.argsort(solid.mesh.geometry.input_global_indices)]
