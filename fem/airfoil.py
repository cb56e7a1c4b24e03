"""The part of the blade whose stress is read, away from clamp and contact."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from fem.fields import away, cells_of, grid_of
from fem.solid import Solid
from geometry.base import SettingsError
from geometry.blade import Stress
from geometry.facets import shape_functions
from geometry.tetrahedra import exterior

PLACES = 31  # along an edge of a facet, at which distances are taken


def airfoil(solid: Solid, asked: Stress) -> tuple[NDArray[np.bool_], float]:
    """Nodes (nodes,) whose stress is read, and their least distance from the clamp, m.

    That of ``asked``; without one the ``thickness`` at a sharp clamp, where the stress has no
    limit. With a fillet all but the cells that touch the clamp (distance 0), which is its edge.
    From the tip they are as far as those of ``away``.

    Raises
    ------
    SettingsError
        When there are none.
    """
    sharp = asked.root == "sharp"
    distance = 1e-3 * asked.away_mm if asked.away_mm else thickness(solid) if sharp else 0.0
    settled = away(solid, distance)
    if not sharp and not asked.away_mm:
        settled[solid.V.dofmap.list[cells_of(solid, np.flatnonzero(solid.clamped))]] = False
    if not settled.any():
        raise SettingsError(
            "no node of the mesh is farther from the clamp, and away from the contact",
            key="stress.away_mm",
            value=1e3 * distance,
        )
    return settled, distance


def thickness(solid: Solid) -> float:
    """Thickness of the blade at its clamp, m: of the largest circle in the clamped face.

    0 where no face is clamped.
    """
    cells, points = grid_of(solid)
    facets = exterior(cells)
    clamped = solid.clamped[facets]
    root, beside = clamped.all(axis=1), clamped.any(axis=1) & ~clamped.all(axis=1)
    if not root.any() or not beside.any():
        return 0.0
    one, other = np.meshgrid(*2 * [np.linspace(0, 1, PLACES)])
    shapes = shape_functions(np.stack([one, other], axis=-1)[one + other <= 1 + 1e-9])
    inside, near = (shapes @ points[facets[of]] for of in (root, beside))
    rim = near[clamped[beside] @ shapes.T > 1 - 1e-9]  # places between clamped nodes alone
    return 2 * float(cKDTree(rim).query(inside.reshape(-1, 3))[0].max())
