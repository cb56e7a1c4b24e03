"""The blade on the page: its motion and stress, and the liner above its tip.

The motion is held by a few shapes, and with them its stress.
"""

from pathlib import Path
from typing import Any

from fem.petsc import MPI  # noqa: F401  ahead of DOLFINx

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from fem.fields import dofs_at, grid_of
from fem.solid import read_solid
from geometry.base import UserError
from geometry.blade import Blade
from geometry.tetrahedra import exterior
from rom.model import Rom
from rom.polynomial import evaluate
from rom.reconstruct import Basis
from simulate.marching import WITH_RESULT
from workflow.explore.page import LARGEST
from workflow.shapes import motion, stresses

MPA = 1e-6
SHAPES = 6  # of the motion at all speeds


def moving(
    blade: Blade, mesh: str | Path, basis: Basis, sweep: xr.Dataset, rom: Rom
) -> tuple[dict[str, Any], dict[str, NDArray[np.float64]]]:
    """Facts and arrays: points (nodes, 3), m; triangles; shapes (shapes, nodes, 3), m.

    a (speeds, times, shapes), the amplitudes; static (powers, nodes, 6) and of_shapes (shapes,
    nodes, 6), MPa, that about the deflection at half the highest speed; radius, axial place and
    gap of the liner at the ends of the strips, m, (strips + 1,) each. Facts are the number of the
    shapes, the share that they miss at each speed, times of states in a revolution, the top speed.

    Raises
    ------
    UserError
        When the surface has more nodes than a page can hold.
    """
    solid = read_solid(str(mesh), blade.material)
    cells, points = grid_of(solid)
    triangles = np.sort(exterior(cells)[:, :3], axis=1)
    nodes, numbered = np.unique(triangles, return_inverse=True)
    if len(nodes) > LARGEST:
        raise UserError(
            f"{mesh}: its surface has {len(nodes)} corner nodes; allowed on a page are {LARGEST}: "
            "take the scene out of `explore`, or a coarser mesh"
        )
    states = sweep["motion"].where(sweep["status"].isin(WITH_RESULT)).values.astype(float)
    moved = motion(states, rom.M, SHAPES)
    sigma = MPA * stresses(solid, basis, moved.shapes, blade.prestress)[:, :, nodes]
    order = dofs_at(basis.coordinates, solid.free_coordinates()).ravel()
    displaced = map(solid.field, (basis.T @ moved.shapes)[order].T)
    ends = sweep["end"].values
    radius, _, z = rom.line(ends).T
    arrays = {
        "points": points[nodes],
        "triangles": numbered.reshape(-1, 3).astype(float),
        "shapes": np.array([u.x.array.reshape(-1, 3)[nodes] for u in displaced]),
        "a": states @ moved.onto,
        "static": sigma[:, 0],
        "of_shapes": evaluate(sigma, 0.5)[1:],
        "liner_radius": radius,
        "liner_z": z,
        "liner_gap": np.interp(ends, sweep["xi"].values, sweep["gap"].values),
    }
    facts = {
        "shapes": moved.shapes.shape[1],
        "missed": moved.missed.tolist(),
        "of_round": (sweep["motion_time"].values % 1.0).tolist(),
        "Omega_m_over_f1": rom.Omega_m / rom.omega1,
    }
    return facts, arrays
