"""Stress of a rub at the nodes of the blade, from a few shapes of its motion, and its margin."""

from dataclasses import dataclass
from typing import Any

from fem.petsc import MPI  # noqa: F401  ahead of DOLFINx

import numpy as np
import xarray as xr
from numpy.linalg import norm
from numpy.typing import NDArray

from fem.fatigue import largest_cycle, margin, von_mises
from fem.fields import TENSOR, dofs_at, rates, stress
from fem.solid import Solid
from geometry.blade import Fatigue
from rom.polynomial import evaluate, interpolate
from rom.reconstruct import Basis
from simulate.marching import WITH_RESULT

SPEEDS = 3  # at which stress is computed; polynomials in Omega^2 between them
BLOCK = 128  # nodes at a time


@dataclass(frozen=True)
class Motion:
    """Displacement at speed i and time t: sum of a[i, t] over the shapes."""

    shapes: NDArray[np.float64]  # (n, shapes), reduced coordinates
    a: NDArray[np.float64]  # (speeds, times, shapes); nan where no state was recorded
    missed: NDArray[np.float64]  # (speeds,), rms norm of what is missed over the whole

    def at(self, speed: int) -> NDArray[np.float64]:
        """Amplitudes (times, shapes) of the states that were recorded at a speed."""
        return self.a[speed][~np.isnan(self.a[speed]).any(axis=1)]


def motion(sweep: xr.Dataset, G: NDArray[np.float64], shapes: int) -> Motion:
    """Proper orthogonal decomposition of ``sweep.motion`` with the norm (u^T G u)^(1/2).

    With G = M the first shapes hold the displacement, with G = K the strain energy, and so the
    stress: with M five shapes may miss it by a fifth that hold the displacement to 1 %.

    Each speed counts alike, whatever its amplitude. Source: Sirovich, Quarterly of Applied
    Mathematics 45 (1987), with the snapshots in reduced coordinates.
    """
    states = sweep["motion"].values.astype(float)
    states = np.where(np.isin(sweep["status"], WITH_RESULT)[:, None, None], states, np.nan)
    L = np.linalg.cholesky(G)
    there = [of[~np.isnan(of).any(axis=1)] @ L for of in states]
    weighted = [y / norm(y) for y in there if np.any(y)]
    _, _, V = np.linalg.svd(sum(y.T @ y for y in weighted) if weighted else np.eye(len(G)))
    first = V[:shapes].T
    left_out = [y - y @ first @ first.T for y in there]
    missed = [
        norm(out) / norm(y) if np.any(y) else 0 for out, y in zip(left_out, there, strict=True)
    ]
    return Motion(np.linalg.solve(L.T, first), states @ L @ first, np.array(missed, float))


@dataclass(frozen=True)
class Stresses:
    """Stress of rotation and of a unit of each shape, about the static state, Pa.

    Polynomials in (Omega / Omega_m)^2; components in the order of ``fem.fields.TENSOR``.
    """

    static: NDArray[np.float64]  # (powers, nodes, 6)
    moving: NDArray[np.float64]  # (powers, shapes, nodes, 6)

    @classmethod
    def of(
        cls, solid: Solid, basis: Basis, shapes: NDArray[np.float64], prestress: str
    ) -> "Stresses":
        """Those of all nodes; ``shapes`` (n, shapes) in reduced coordinates."""
        order = dofs_at(basis.coordinates, solid.free_coordinates()).ravel()
        along = (basis.T @ shapes).T[:, order]
        speeds = np.sqrt((1 - np.cos(np.pi * np.arange(SPEEDS) / (SPEEDS - 1))) / 2)
        static = [basis.static(part * basis.Omega_m)[order] for part in speeds]
        of_rotation = [stress(solid, u, prestress).stress[:, *TENSOR] for u in static]
        of_shapes = [rates(solid, u, along, prestress)[1] for u in static]
        return cls(*(interpolate(np.array(of), speeds) for of in (of_rotation, of_shapes)))

    def at(self, part: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Static (nodes, 6) and moving (shapes, nodes, 6) at Omega / Omega_m."""
        return evaluate(self.static, part), evaluate(self.moving, part)

    def on(self, nodes: NDArray[np.int64]) -> "Stresses":
        """Those of some nodes."""
        return Stresses(self.static[:, nodes], self.moving[:, :, nodes])


def cycles(
    static: NDArray[np.float64], moving: NDArray[np.float64], a: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean and alternating stress (nodes,), Pa, of static (nodes, 6) and a (times, shapes)."""
    blocks = range(BLOCK, len(static), BLOCK)
    pairs = zip(np.split(static, blocks), np.split(moving, blocks, axis=1), strict=True)
    found = [largest_cycle(of + np.tensordot(a, along, 1)) for of, along in pairs]
    mean, alternating = map(np.concatenate, zip(*found, strict=True))
    return mean, alternating


def worst(
    static: NDArray[np.float64],
    moving: NDArray[np.float64],
    a: NDArray[np.float64],
    fatigue: Fatigue | None,
) -> tuple[int, dict[str, float]]:
    """The node of least margin, or without strength of largest alternating stress; its numbers.

    Nodes are searched by bounds of their stresses: the von Mises stress is a seminorm, so that mean
    and alternating stress are at most those of the static stress and of each shape by itself,
    added. They are tried from the one on whose bounds the margin is least.
    """
    _, _, turn = np.linalg.svd(a - a.mean(axis=0), full_matrices=False)
    a, moving = a @ turn.T, np.tensordot(turn, moving, 1)  # in its own directions: close bounds
    of_shapes = von_mises(moving)
    most = von_mises(static) + np.abs(a).max(axis=0) @ of_shapes
    bound = _reserve(most, np.ptp(a, axis=0) / 2 @ of_shapes, fatigue)
    order, least = np.argsort(bound), np.inf
    for nodes in np.split(order, range(BLOCK, len(order), BLOCK)):
        if bound[nodes[0]] >= least:
            break
        mean, alternating = cycles(static[nodes], moving[:, nodes], a)
        reserve = _reserve(mean, alternating, fatigue)
        best = reserve.argmin()
        if reserve[best] < least:
            least = reserve[best]
            found = nodes[best], numbers(mean[best], alternating[best], fatigue)
    return found


def numbers(mean: Any, alternating: Any, fatigue: Fatigue | None) -> dict[str, Any]:
    """Stresses, Pa, and their margin where there is a strength, by name."""
    of_strength = {"margin": margin(mean, alternating, fatigue)} if fatigue else {}
    return {"mean_stress": mean, "alternating": alternating, **of_strength}


def _reserve(
    mean: NDArray[np.float64], alternating: NDArray[np.float64], fatigue: Fatigue | None
) -> NDArray[np.float64]:
    """What is least at the worst node."""
    return margin(mean, alternating, fatigue) if fatigue else -alternating
