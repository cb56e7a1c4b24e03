"""What the page shows of the blade: its motion and stress, and the liner above its tip."""

from itertools import repeat
from pathlib import Path
from typing import Any

import dolfinx_solver  # noqa: F401  orders MPI ahead of the compiled bindings

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from dolfinx.plot import vtk_mesh

from fem.fields import away, dofs_at
from fem.solid import read_solid
from geometry.blade import Blade
from geometry.errors import UserError
from geometry.tetrahedra import surface
from rom.model import Rom
from rom.reconstruct import Basis
from workflow.explore.motion import Motion, at_nodes, largest_stress, motion, stresses
from workflow.explore.pack import LARGEST

MEGA = 1e-6


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
    triangles = surface(cells.reshape(-1, 11)[:, 1:])
    nodes, numbered = np.unique(triangles, return_inverse=True)
    if len(nodes) > LARGEST:
        raise UserError(
            f"{mesh}: its surface has {len(nodes)} corner nodes; allowed on a page are {LARGEST}: "
            "take the scene out of `explore`, or a coarser mesh"
        )
    T = at_nodes(basis, points, nodes)
    found = motion(sweep, T)
    order = dofs_at(basis.coordinates, solid.free_coordinates()).ravel()
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
    """How much the shapes miss at each speed; time of a state in its round; highest speed."""
    time = sweep["motion_time"].values
    return {
        "shapes": found.shapes.shape[1],
        "missed": found.missed.tolist(),
        "of_round": (time % 1.0).tolist(),
        "Omega_m_over_f1": rom.Omega_m / (2 * np.pi * rom.f1),
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
