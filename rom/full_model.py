"""``full-model.nc``: results of the full model with which a reduced model is compared."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fem.cholesky import Cholesky
from fem.matrices import CODE, Constants, Prestressed
from geometry.base import Provenance
from geometry.hats import hat_nodes, mean, middles, over_edges
from geometry.stored import Stored, frozen, stored
from geometry.tip import EDGES, on_line
from rom.modes import ShiftInvert

MODES = 10  # frequencies compared
SHAPES = 5  # mode shapes at rest, for figures
BENT = 3  # modes whose second order is computed


type Along = Callable[[NDArray, NDArray, NDArray], float]  # ``SecondOrder.along``


@frozen
class FullModel(Stored):
    """Frequencies and compliance of the interface of the full model over its speeds."""

    code = CODE

    speeds: NDArray[np.float64] = stored("speed", "rad s-1")  # rest first
    omega: NDArray[np.float64] = stored("speed mode", "rad s-1")
    residuals: NDArray[np.float64] = stored("speed mode")  # of these modes
    # C = S K^-1 S^T, (speeds, 3 across n, 3 across n), order as in S
    compliance: NDArray[np.float64] = stored("speed dof dof_", "m N-1")
    shapes: NDArray[np.float64] = stored("shape point xyz", "kg-1/2")  # modes at rest, Cartesian
    coordinates: NDArray[np.float64] = stored("point xyz", "m")  # free nodes of the mesh
    provenance: Provenance  # that of the matrices
    # of the first modes at ``EDGES``, per modal displacement: u_r, u_t, u_z, and per square of it
    # the change of the tip's radius of second order; nan: not known
    tip: NDArray[np.float64] = stored(
        "bent_speed rtz edge bent_mode", "kg-1/2", default_factory=lambda: np.empty((0, 3, 2, 0))
    )
    second_order: NDArray[np.float64] = stored(
        "bent_speed edge bent_mode",
        "m-1 kg-1",
        default_factory=lambda: np.empty((0, 2, 0)),
        may_be_nan=True,
    )

    def joined(self, other: Self) -> Self:
        """With the results of ``other``, at further speeds."""
        order = np.argsort(np.concatenate([self.speeds, other.speeds]))
        names = "speeds", "omega", "residuals", "compliance", "tip", "second_order"
        both = {
            name: np.concatenate([getattr(model, name) for model in (self, other)])
            for name in names
        }
        return replace(self, **{name: values[order] for name, values in both.items()})


def solve(
    fom: Constants,
    states: Iterable[Prestressed],
    cholesky: Cholesky | None = None,
    along: Along | None = None,
) -> FullModel:
    """First modes, and compliance of the interface, at every state.

    Parameters
    ----------
    states : at ascending speeds; one at a time is kept
    cholesky : factorises K of the states, unless it holds the factor already
    along : of ``fem.second_order``; None: the second order is not known

    Raises
    ------
    rom.modes.ModesError
        When K is not positive definite, or modes do not converge.
    """
    cholesky, loads = cholesky or Cholesky(), fom.S.T.toarray()
    P = over_edges(EDGES, fom.xi, mean(fom.across))
    edges = np.stack([P @ fom.rows(letter) for letter in "rtz"])
    radius = on_line(fom.camber, np.array(EDGES))[:, :1]
    rows: list[tuple] = []
    shapes: list[NDArray[np.float64]] = []  # at rest, once known
    for state in states:
        inverse = ShiftInvert(state.K, fom.M, cholesky)
        modes = inverse.modes(MODES)
        compliance = fom.S @ inverse.solve(loads)
        Phi, omega = modes.Phi[:, :BENT], modes.omega[:BENT]
        tip = edges @ Phi
        second = np.full(tip.shape[1:], np.nan)
        if along:
            loaded = inverse.solve(edges[0].T)
            for edge, mode in np.ndindex(*second.shape):
                # the mode itself leaves the static field: its amplitude is given
                x = loaded[:, edge] - Phi[:, mode] * tip[0, edge, mode] / omega[mode] ** 2
                second[edge, mode] = along(state.u_static, x, Phi[:, mode])
        second += tip[1] ** 2 / 2 / radius
        rows.append((state.speed, modes.omega, modes.residuals, compliance, tip, second))
        shapes = shapes or [modes.Phi]
    speeds, omega, residuals, compliances, tip, second = map(np.array, zip(*rows, strict=True))
    return FullModel(
        speeds=speeds,
        omega=omega,
        residuals=residuals,
        compliance=compliances,
        shapes=shapes[0][:, :SHAPES].T.reshape(SHAPES, -1, 3),
        coordinates=fom.coordinates,
        provenance=fom.provenance,
        tip=tip,
        second_order=second,
    )


def compliance_of_strips(C: NDArray[np.float64], across: int = 1) -> NDArray[np.float64]:
    """Displacement (n,), m/N, of the middle of each of n strips under a unit load at it.

    ``C`` (across n, across n): compliance of n patches in one direction.
    """
    n = len(C) // across
    P = over_edges(middles(n), hat_nodes(n), mean(across))
    return np.diag(P @ C @ P.T)
