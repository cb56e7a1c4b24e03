"""The blade on the page: its motion and stress, and the liner above its tip.

The motion is held by a few shapes, and with them its stress.
"""

from dataclasses import dataclass
from itertools import repeat
from pathlib import Path
from typing import Any

from fem.petsc import MPI  # noqa: F401  ahead of DOLFINx

import numpy as np
import xarray as xr
from numpy.linalg import norm
from numpy.typing import NDArray

from dolfinx.plot import vtk_mesh

from fem.fields import FULL, TENSOR, away, dofs_at, stress, von_mises
from fem.solid import Solid, read_solid
from geometry.blade import Blade
from geometry.project import UserError
from geometry.tetrahedra import exterior
from rom.model import Rom
from rom.polynomial import interpolate
from rom.reconstruct import Basis
from simulate.marching import WITH_RESULT
from workflow.explore.page import LARGEST

MEGA = 1e-6
SHAPES = 5  # of the motion at all speeds
STRESSED = 1e-4  # m, largest displacement at which the stress of a shape is linearised
FIRST = 64  # nodes from which a lower bound of the largest stress is taken
SPEEDS = 4  # at which the static stress is computed, a polynomial in Omega^2 between them


@dataclass(frozen=True)
class Motion:
    """Displacement at speed i and time t: sum of a[i, t] over the shapes."""

    shapes: NDArray[np.float64]  # (n, shapes), reduced coordinates
    a: NDArray[np.float64]  # (speeds, times, shapes); nan where no state was recorded
    missed: NDArray[np.float64]  # (speeds,), rms displacement that is missed over the whole


def motion(sweep: xr.Dataset, T: NDArray[np.float64], shapes: int = SHAPES) -> Motion:
    """Proper orthogonal decomposition of ``sweep.motion`` on the nodes of ``T`` (nodes, n).

    Each speed counts alike, whatever its amplitude. Source: Sirovich, Quarterly of Applied
    Mathematics 45 (1987), with the snapshots in reduced coordinates.
    """
    states = sweep["motion"].values.astype(float)
    states = np.where(np.isin(sweep["status"], WITH_RESULT)[:, None, None], states, np.nan)
    values, vectors = np.linalg.eigh(T.T @ T)
    kept = values > values.max() * 1e-14
    root = vectors[:, kept] * np.sqrt(values[kept])  # |T u| = |root^T u|
    there = [of[~np.isnan(of).any(axis=1)] @ root for of in states]
    weighted = [y / norm(y) for y in there if np.any(y)]
    _, _, V = np.linalg.svd(sum(y.T @ y for y in weighted) if weighted else np.eye(root.shape[1]))
    first = V[:shapes].T
    left_out = [y - y @ first @ first.T for y in there]
    missed = [
        norm(out) / norm(y) if np.any(y) else 0 for out, y in zip(left_out, there, strict=True)
    ]
    return Motion(
        shapes=vectors[:, kept] / np.sqrt(values[kept]) @ first,
        a=states @ root @ first,
        missed=np.array(missed, float),
    )


def stresses(
    solid: Solid, order: NDArray[np.int64], basis: Basis, shapes: NDArray[np.float64], kind: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Stress of rotation and of each shape, Pa, at all nodes.

    Parameters
    ----------
    order : DoFs of the basis in the order of the solid's free ones
    shapes : (n, shapes), reduced coordinates
    kind : prestress of the blade, `nonlinear` or `linear`

    Returns
    -------
    static : (SPEEDS, nodes, 6), coefficients of the powers of (Omega / Omega_m)^2
    of_shapes : (shapes, nodes, 6), of a unit of each shape, linearised about the deflection at
        half the highest speed
    """
    squares = (1 - np.cos(np.pi * np.arange(SPEEDS) / (SPEEDS - 1))) / 2  # Chebyshev-Lobatto
    speeds = np.sqrt(squares)
    static = [_stress(solid, basis.static(part * basis.Omega_m)[order], kind) for part in speeds]
    about = basis.static(basis.Omega_m / 2)[order]
    of_shapes = []
    for u in (basis.T @ shapes).T:
        step = STRESSED / np.abs(u).max()
        ends = [_stress(solid, about + sign * step * u[order], kind) for sign in (1, -1)]
        of_shapes.append((ends[0] - ends[1]) / (2 * step))
    return interpolate(np.array(static), speeds), np.array(of_shapes)


def largest_stress(
    static: NDArray[np.float64], of_shapes: NDArray[np.float64], a: NDArray[np.float64]
) -> float:
    """Largest von Mises stress, Pa, of static (nodes, 6) and moving stress, at all times; or nan.

    Only nodes count whose bound |static| + sum |a| |shape| is not below the stress at a node near
    them: the von Mises stress is a seminorm.

    Parameters
    ----------
    of_shapes : (shapes, nodes, 6), of a unit of each shape
    a : (times, shapes); nan where no state was recorded
    """
    a = a[~np.isnan(a).any(axis=1)]
    if len(a) == 0:
        return float("nan")
    bound = von_mises(static[..., FULL]) + np.abs(a).max(axis=0) @ von_mises(of_shapes[..., FULL])
    first = np.argpartition(bound, -min(FIRST, len(bound)))[-FIRST:]
    reached = _reached(static, of_shapes, a, first)
    return max(reached, _reached(static, of_shapes, a, np.flatnonzero(bound > reached)))


def _reached(static: NDArray, of_shapes: NDArray, a: NDArray, nodes: NDArray) -> float:
    """Largest von Mises stress of some nodes at all times."""
    if len(nodes) == 0:
        return 0.0
    sigma = static[nodes] + np.tensordot(a, of_shapes[:, nodes], 1)
    return float(von_mises(sigma[..., FULL]).max())


def _stress(solid: Solid, u: NDArray[np.float64], kind: str) -> NDArray[np.float64]:
    """Cauchy stress (nodes, 6), Pa: xx, yy, zz, xy, yz, xz."""
    return stress(solid, u, kind).stress[:, *TENSOR]


def moving(
    blade: Blade, mesh: str | Path, basis: Basis, sweep: xr.Dataset, rom: Rom
) -> tuple[dict[str, Any], dict[str, NDArray[np.float64]]]:
    """Facts and arrays: points (nodes, 3), m; triangles; shapes (shapes, nodes, 3), m.

    a (speeds, times, shapes), the amplitudes; static (powers, nodes, 6) and of_shapes (shapes,
    nodes, 6), MPa; radius, axial place and gap of the liner at the ends of the strips, m. The
    facts have the largest stress of each speed away from clamp and contact, Pa.

    Raises
    ------
    UserError
        When the surface has more nodes than a page can hold.
    """
    solid = read_solid(str(mesh), blade.material)
    cells, _, points = vtk_mesh(solid.V)
    triangles = np.sort(exterior(cells.reshape(-1, 11)[:, 1:])[:, :3], axis=1)
    nodes, numbered = np.unique(triangles, return_inverse=True)
    if len(nodes) > LARGEST:
        raise UserError(
            f"{mesh}: its surface has {len(nodes)} corner nodes; allowed on a page are {LARGEST}: "
            "take the scene out of `explore`, or a coarser mesh"
        )
    order = dofs_at(basis.coordinates, solid.free_coordinates()).ravel()
    of_all = np.zeros((3 * len(points), basis.T.shape[1]))  # clamped nodes, too
    of_all[solid.free] = basis.T[order]
    T = of_all[(3 * nodes[:, None] + np.arange(3)).ravel()]  # of the surface
    found = motion(sweep, T)
    static, of_shapes = stresses(solid, order, basis, found.shapes, blade.prestress)
    settled = nodes[away(solid)[nodes]]
    squares = (sweep["speed"].values / basis.Omega_m) ** 2
    arrays = {
        "points": points[nodes],
        "triangles": numbered.reshape(-1, 3).astype(float),
        "shapes": (T @ found.shapes).T.reshape(-1, len(nodes), 3),
        "a": found.a,
        "static": MEGA * static[:, nodes],
        "of_shapes": MEGA * of_shapes[:, nodes],
    }
    largest = [
        largest_stress(np.tensordot(s ** np.arange(len(static)), static[:, settled], 1), *of)
        for s, *of in zip(squares, repeat(of_shapes[:, settled]), found.a, strict=False)
    ]
    return _facts(found, sweep, rom) | {"stress": largest}, arrays | _liner(sweep, rom)


def _facts(found: Motion, sweep: xr.Dataset, rom: Rom) -> dict[str, Any]:
    """Share missed by the shapes at each speed; times of states in a revolution; top speed."""
    time = sweep["motion_time"].values
    return {
        "shapes": found.shapes.shape[1],
        "missed": found.missed.tolist(),
        "of_round": (time % 1.0).tolist(),
        "Omega_m_over_f1": rom.Omega_m / rom.omega1,
    }


def _liner(sweep: xr.Dataset, rom: Rom) -> dict[str, NDArray[np.float64]]:
    """Radius, axial place and gap at the ends of the strips, m, (strips + 1,) each."""
    ends = sweep["end"].values
    radius, _, z = rom.line(ends).T
    return {
        "liner_radius": radius,
        "liner_z": z,
        "liner_gap": np.interp(ends, sweep["xi"].values, sweep["gap"].values),
    }
