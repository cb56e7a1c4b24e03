"""Fig. 9: natural modes of the blade at rest."""

from string import ascii_lowercase

import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from rom.full_model import FullModel
from workflow.figures import rendering, style

SHOWN = 0.15  # largest displacement in the pictures, over the blade's largest dimension
MATCH = 1e-6  # distance of equal nodes at most, over the blade's largest dimension
TIP = 0.01  # height of the part that counts as the tip, over the blade's height
LIGHT = (0.6, 0.45)
VIEW = (0.25, 1.0, -0.35)  # the blade's broad side at an angle


@style.styled
def draw(mesh: rendering.Mesh, full: FullModel) -> Figure:
    """All mode shapes side by side, with the same view and colour scale."""
    blade = rendering.solid(mesh)
    shapes = unit_length(spread(blade.points, full.coordinates, full.shapes))
    frequencies = full.omega[0, : len(shapes)] / (2 * np.pi)
    height = blade.points[:, 0]
    tip = height > height.max() - TIP * np.ptp(height)
    rows = [
        (
            f"({ascii_lowercase[m]}) mode {m + 1}\n{frequency:.0f} Hz\n"
            f"$f/f_1(0)$ = {frequency / frequencies[0]:.2f}\n"
            f"tip rotation {100 * rotation_share(blade.points[tip], shape[tip]):.0f} %",
            SHOWN * max(blade.bounds_size) * shape,
            np.linalg.norm(shape, axis=1),
            VIEW,
        )
        for m, (shape, frequency) in enumerate(zip(shapes, frequencies, strict=True))
    ]
    return rendering.gallery(
        blade,
        rows,
        (colormaps["viridis"].resampled(10), (0, 1), LIGHT),  # few, to read as contours
        style.DOUBLE,
        {},
        f"blade {full.provenance.blade}, at rest",
        shrink=0.4,
        aspect=40,
        label="displacement over its largest value (outline: undeformed blade)\n"
        "tip rotation: share of the tip's squared displacement that is rotation about the radius",
    )


def rotation_share(points: NDArray[np.float64], shape: NDArray[np.float64]) -> float:
    """Share of the mean square of ``shape`` (nodes, 3) due to rotation about the radius, x.

    0 for a tip in translation, as in bending; 1 for a rotation about the centre of ``points``.
    """
    arm = points - points.mean(axis=0)
    turn = np.cross([1.0, 0.0, 0.0], arm)
    return float((turn * shape).sum() ** 2 / (turn**2).sum() / (shape**2).sum())


def spread(
    points: NDArray[np.float64], free: NDArray[np.float64], shapes: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Mode shapes (modes, points, 3) on all ``points`` (points, 3), zero at those not free.

    ``shapes`` (modes, free, 3) are given at ``free`` (free, 3).

    Raises
    ------
    ValueError
        When a free node is not on the mesh: the files do not belong together.
    """
    distance, nearest = cKDTree(points).query(free)
    if distance.max() > MATCH * np.ptp(points, axis=0).max():
        raise ValueError(
            f"mode shapes belong to another mesh: a node is {distance.max():.3g} m off"
        )
    whole = np.zeros((len(shapes), len(points), 3))
    whole[:, nearest] = shapes
    return whole


def unit_length(shapes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mode shapes scaled to a largest displacement of 1, with their sign unchanged."""
    return shapes / np.linalg.norm(shapes, axis=2).max(axis=1)[:, None, None]
