"""A few shapes of the motion of a sweep, and the stress in them."""

from collections.abc import Iterable
from dataclasses import dataclass

from fem.petsc import MPI  # noqa: F401  ahead of DOLFINx

import numpy as np
from numpy.linalg import norm
from numpy.typing import NDArray

from fem.fields import dofs_at, linearised
from fem.solid import Solid
from rom.polynomial import interpolate
from rom.reconstruct import Basis

SPEEDS = 3  # at which stress is computed; polynomials in Omega^2 between them


@dataclass(frozen=True)
class Shapes:
    """A few shapes of a motion; a state u has the amplitudes ``u @ onto``."""

    shapes: NDArray[np.float64]  # (n, shapes), reduced coordinates
    onto: NDArray[np.float64]  # (n, shapes)
    missed: NDArray[np.float64]  # (speeds,), rms norm of what is missed over the whole


def motion(states: Iterable[NDArray[np.float64]], G: NDArray[np.float64], shapes: int) -> Shapes:
    """Proper orthogonal decomposition of ``states`` with the norm (u^T G u)^(1/2).

    With G = M the first shapes hold the displacement, with G = K the strain energy, and so the
    stress, of which shapes that hold the displacement may miss a part.

    Each speed counts alike, whatever its amplitude. Source: Sirovich, Quarterly of Applied
    Mathematics 45 (1987), with the snapshots in reduced coordinates.

    Parameters
    ----------
    states : of each speed (times, n), m, reduced displacements; nan where none was recorded
    """
    L = np.linalg.cholesky(G)
    there = [state[~np.isnan(state).any(axis=1)] @ L for state in states]
    weighted = [y / norm(y) for y in there if np.any(y)]
    _, _, V = np.linalg.svd(sum(y.T @ y for y in weighted) if weighted else np.eye(len(G)))
    first = V[:shapes].T
    missed = [norm(y - y @ first @ first.T) / norm(y) if np.any(y) else 0 for y in there]
    return Shapes(np.linalg.solve(L.T, first), L @ first, np.array(missed, float))


def stresses(
    solid: Solid, basis: Basis, shapes: NDArray[np.float64], prestress: str
) -> NDArray[np.float64]:
    """Stress (powers, 1 + shapes, nodes, 6), Pa: of rotation, then of a unit of each shape.

    Polynomials in (Omega / Omega_m)^2; ``shapes`` (n, shapes) in reduced coordinates; components in
    the order of ``fem.fields.TENSOR``.
    """
    order = dofs_at(basis.coordinates, solid.free_coordinates()).ravel()
    along = (basis.T @ shapes).T[:, order]
    if prestress == "linear":  # stress in rotation is in Omega^2 alone, that of shapes constant
        static = basis.static(basis.Omega_m)[order]
        at_top = linearised(solid, static, along, prestress, strain=False)[0]
        rotates = (np.arange(len(at_top)) == 0)[:, None, None]
        return np.array([np.where(rotates, 0.0, at_top), np.where(rotates, at_top, 0.0)])
    speeds = np.sqrt((1 - np.cos(np.pi * np.arange(SPEEDS) / (SPEEDS - 1))) / 2)
    static = (basis.static(part * basis.Omega_m)[order] for part in speeds)
    each_speed = [linearised(solid, u, along, prestress, strain=False)[0] for u in static]
    return interpolate(np.array(each_speed), speeds)
