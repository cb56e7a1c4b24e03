"""Stress of a rub at the nodes of the blade, from a few shapes of its motion, and its margin."""

from dataclasses import dataclass
from typing import Any

from fem.petsc import MPI  # noqa: F401  ahead of DOLFINx

import numpy as np
from numpy.linalg import norm
from numpy.typing import NDArray

from fem.fatigue import largest_cycle, margin, von_mises
from fem.fields import away, dofs_at, grid_of, linearised, save_vtu
from fem.solid import Solid, read_solid
from geometry.blade import RPM, Blade, Fatigue
from geometry.frame import to_file
from rom.model import Rom
from rom.polynomial import evaluate, interpolate
from rom.reconstruct import Basis
from simulate.marching import WITH_RESULT
from simulate.scene import GROWING
from simulate.sweeps.dataset import Sweep, origin
from simulate.sweeps.peak_results import asked

SHAPES = 12  # of the motion at all speeds
LABELS = {
    "mean_stress": "mean stress (Pa)",
    "alternating": "alternating stress (Pa)",
    "margin": "margin",
}
SPEEDS = 3  # at which stress is computed; polynomials in Omega^2 between them
BLOCK = 128  # nodes at a time


def write(
    blade: Blade, mesh: str, rom: Rom, basis: str, sweep: Sweep, names: dict[str, str], vtu: str
) -> dict[str, Any]:
    """Write the fields at the reported peaks; return the worst node at every speed.

    Its place is in the axes and unit of the blade's file; ``missed`` is the share of the motion
    that the shapes leave out, in the norm of the strain energy. A motion that still grows has no
    mean and no amplitude yet, and no stresses in its row.
    """
    full_basis = Basis.load(basis, origin(sweep))
    solid, fatigue = read_solid(mesh, blade.material), blade.fatigue
    moved = motion(sweep, rom.stiffness(rom.Omega_m / 2), SHAPES)
    sigma = stresses(solid, full_basis, moved.shapes, blade.prestress)
    settled, (cells, points) = away(solid), grid_of(solid)
    nodes, fields = np.flatnonzero(settled), {"away from clamp and contact": settled.astype(float)}
    away_from, peaks, rows = sigma[:, :, nodes], {peak.index for peak in asked(sweep, rom)}, []
    columns = (sweep[name].values.tolist() for name in ("speed", "speed_over_f1", "trend"))
    for speed, (missed, Omega, over_f1, trend) in enumerate(
        zip(moved.missed, *columns, strict=True)
    ):
        rows.append({"speed_over_f1": over_f1, "trend": trend, "missed": float(missed)})
        part, a = Omega / full_basis.Omega_m, moved.with_rotation(speed)
        if trend == GROWING or len(a) == 0:
            continue
        node, stresses_there = worst(evaluate(away_from, part), a, fatigue)
        rows[-1] |= {
            **stresses_there,
            "at": to_file(points[nodes[node]], blade.drawn).tolist(),
            "unit": blade.drawn.unit,
        }
        if speed in peaks:
            everywhere = numbers(*cycles(evaluate(sigma, part), a), fatigue)
            fields |= {
                f"{LABELS[label]}, {RPM * Omega:.0f} rpm": everywhere[label] for label in everywhere
            }
    save_vtu(points, cells, fields, vtu)
    return {
        **names,
        "fatigue": fatigue and fatigue.model_dump(mode="json"),
        "speeds": rows,
    }


@dataclass(frozen=True)
class Decomposition:
    """Displacement at speed i and time t: sum of a[i, t] over the shapes."""

    shapes: NDArray[np.float64]  # (n, shapes), reduced coordinates
    a: NDArray[np.float64]  # (speeds, times, shapes); nan where no state was recorded
    missed: NDArray[np.float64]  # (speeds,), rms norm of what is missed over the whole

    def with_rotation(self, speed: int) -> NDArray[np.float64]:
        """Amplitudes (times, 1 + shapes) of the states recorded at a speed: 1, then the shapes'."""
        a = self.a[speed][~np.isnan(self.a[speed]).any(axis=1)]
        return np.hstack([np.ones((len(a), 1)), a])


def motion(sweep: Sweep, G: NDArray[np.float64], shapes: int) -> Decomposition:
    """Proper orthogonal decomposition of ``sweep.motion`` with the norm (u^T G u)^(1/2).

    With G = M the first shapes hold the displacement, with G = K the strain energy, and so the
    stress, of which shapes that hold the displacement may miss a part.

    Each speed counts alike, whatever its amplitude. Source: Sirovich, Quarterly of Applied
    Mathematics 45 (1987), with the snapshots in reduced coordinates.
    """
    states = sweep["motion"].values.astype(float)
    states = np.where(np.isin(sweep["status"], WITH_RESULT)[:, None, None], states, np.nan)
    L = np.linalg.cholesky(G)
    there = [state[~np.isnan(state).any(axis=1)] @ L for state in states]
    weighted = [y / norm(y) for y in there if np.any(y)]
    _, _, V = np.linalg.svd(sum(y.T @ y for y in weighted) if weighted else np.eye(len(G)))
    first = V[:shapes].T
    outside = [y - y @ first @ first.T for y in there]
    missed = [
        norm(out) / norm(y) if np.any(y) else 0 for out, y in zip(outside, there, strict=True)
    ]
    return Decomposition(np.linalg.solve(L.T, first), states @ L @ first, np.array(missed, float))


def stresses(
    solid: Solid, basis: Basis, shapes: NDArray[np.float64], prestress: str
) -> NDArray[np.float64]:
    """Stress (powers, 1 + shapes, nodes, 6), Pa: of rotation, then of a unit of each shape.

    Polynomials in (Omega / Omega_m)^2; ``shapes`` (n, shapes) in reduced coordinates; components in
    the order of ``fem.fields.TENSOR``.
    """
    order = dofs_at(basis.coordinates, solid.free_coordinates()).ravel()
    along = (basis.T @ shapes).T[:, order]
    speeds = np.sqrt((1 - np.cos(np.pi * np.arange(SPEEDS) / (SPEEDS - 1))) / 2)
    static = (basis.static(part * basis.Omega_m)[order] for part in speeds)
    each_speed = [linearised(solid, u, along, prestress)[1] for u in static]
    return interpolate(np.array(each_speed), speeds)


def cycles(
    sigma: NDArray[np.float64], a: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean and alternating stress (nodes,), Pa, of the motion a (times, 1 + shapes).

    ``sigma`` (1 + shapes, nodes, 6): as of ``stresses`` at one speed; of rotation a is 1.
    """
    blocks = np.split(sigma, range(BLOCK, sigma.shape[1], BLOCK), axis=1)
    by_block = [largest_cycle(np.tensordot(a, block, 1)) for block in blocks]
    mean, alternating = map(np.concatenate, zip(*by_block, strict=True))
    return mean, alternating


def worst(
    sigma: NDArray[np.float64], a: NDArray[np.float64], fatigue: Fatigue | None
) -> tuple[int, dict[str, float]]:
    """The node of least margin, or without strength of largest alternating stress; its numbers.

    Nodes are searched by bounds of their stresses: the von Mises stress is a seminorm, so that mean
    and alternating stress are at most those of rotation and of each shape by itself, added. Those
    whose bounds leave less margin than the worst of a first few are computed. Arguments as of
    ``cycles``.
    """
    turn = np.linalg.eigh(np.cov(a.T, bias=True))[1].T
    a, sigma = a @ turn.T, np.tensordot(turn, sigma, 1)  # in its own directions: close bounds
    each = von_mises(sigma)
    bound = _reserve(numbers(np.abs(a).max(axis=0) @ each, np.ptp(a, axis=0) / 2 @ each, fatigue))
    first = np.argsort(bound)[:BLOCK]
    least = _reserve(numbers(*cycles(sigma[:, first], a), fatigue)).min()
    nodes = np.union1d(first, np.flatnonzero(bound < least))
    exact = numbers(*cycles(sigma[:, nodes], a), fatigue)
    best = _reserve(exact).argmin()
    return nodes[best], {name: float(values[best]) for name, values in exact.items()}


def numbers(mean: Any, alternating: Any, fatigue: Fatigue | None) -> dict[str, Any]:
    """Stresses, Pa, and their margin where there is a strength, by name."""
    reserve = {"margin": margin(mean, alternating, fatigue)} if fatigue else {}
    return {"mean_stress": mean, "alternating": alternating, **reserve}


def _reserve(numbers: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    """What is least at the worst node."""
    return numbers.get("margin", -numbers["alternating"])
