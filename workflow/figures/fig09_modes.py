"""Fig. 9: natural modes of the blade at rest."""

from dataclasses import dataclass
from string import ascii_lowercase
from typing import Any

import meshio
import numpy as np
import pyvista as pv
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from rom.full_model import FullModel
from workflow.figures import style, views

SHOWN = 0.15  # of the blade's largest dimension: the largest displacement in the pictures
MATCH = 1e-6  # of the blade's largest dimension; a farther node is another one: a clamped one
COLOURS = colormaps["viridis"].resampled(10)  # few enough to read as contours
TIP = 0.01  # of the blade's height, what counts as its tip
LIGHT = (0.6, 0.45)
VIEW = (0.25, 1.0, -0.35)  # the blade's broad side at an angle


@dataclass(frozen=True)
class Modes:
    """Mode shapes at rest on the whole mesh."""

    points: NDArray[np.float64]  # (nodes, 3), m
    cells: NDArray[np.int64]  # (cells, 10), ten-node tetrahedra in VTK's order
    shapes: NDArray[np.float64]  # (modes, nodes, 3), zero where clamped, largest length 1
    frequencies: NDArray[np.float64]  # (modes,), over f1(0)

    @property
    def tip_rotation(self) -> NDArray[np.float64]:
        """Share (modes,) of the tip's mean square displacement that is a turn about the radius.

        0 is a tip that moves as one, as in bending; 1 one that turns about its own centre.
        """
        tip = self.points[:, 0] > self.points[:, 0].max() - TIP * np.ptp(self.points[:, 0])
        return np.array([rotation_share(self.points[tip], shape[tip]) for shape in self.shapes])


def rotation_share(points: NDArray[np.float64], shape: NDArray[np.float64]) -> float:
    """Share of ``shape`` (nodes, 3) that is a rotation about x and the centre of ``points``."""
    arm = points - points.mean(axis=0)
    turn = np.cross([1.0, 0.0, 0.0], arm)
    return float((turn * shape).sum() ** 2 / (turn**2).sum() / (shape**2).sum())


def load(files: Any) -> tuple[Modes]:
    """Read the mesh, ``files.mesh``, and the shapes of its free nodes, ``files.full``."""
    full = FullModel.load(files.full)
    mesh = meshio.read(files.mesh)
    shapes = spread(mesh.points, full.coordinates, full.shapes)
    frequencies = full.omega[0, : len(shapes)] / full.omega[0, 0]
    return (Modes(mesh.points, mesh.cells_dict["tetra10"], unit_length(shapes), frequencies),)


def spread(
    points: NDArray[np.float64], free: NDArray[np.float64], shapes: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Shapes (modes, free, 3) given at ``free`` (free, 3) on all ``points``; zero elsewhere.

    Raises
    ------
    ValueError
        When a free node is not on the mesh: the files do not belong together.
    """
    distance, at = cKDTree(points).query(free)
    if distance.max() > MATCH * np.ptp(points, axis=0).max():
        raise ValueError(f"mode shapes are of another mesh: nodes {distance.max():.3g} m apart")
    whole = np.zeros((len(shapes), len(points), 3))
    whole[:, at] = shapes
    return whole


def unit_length(shapes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Every shape scaled to a largest displacement of 1; its sign is free and stays."""
    return shapes / np.linalg.norm(shapes, axis=2).max(axis=1)[:, None, None]


@style.styled
def draw(modes: Modes) -> Figure:
    """All shapes side by side, one camera, one scale of colours."""
    at_rest = _surface(modes, np.zeros_like(modes.points))
    pictures = [
        views.picture(_surface(modes, shape), at_rest, COLOURS, (0, 1), VIEW, LIGHT)
        for shape in modes.shapes
    ]
    return style.gallery(
        views.crop(pictures),
        [_title(modes, m) for m in range(len(pictures))],
        style.DOUBLE,
        mappable=ScalarMappable(Normalize(0, 1), COLOURS),
        shrink=0.4,
        aspect=40,
        label="displacement over its largest value (outline: undeformed blade)",
    )


def _title(modes: Modes, m: int) -> str:
    return (
        f"({ascii_lowercase[m]}) mode {m + 1}\n$f/f_1(0)$ = {modes.frequencies[m]:.2f}\n"
        f"tip rotation {100 * modes.tip_rotation[m]:.0f} %"
    )


def _surface(modes: Modes, shape: NDArray[np.float64]) -> pv.PolyData:
    """Skin of the mesh, deformed by ``shape`` (nodes, 3), with the length of its displacement."""
    size = np.ptp(modes.points, axis=0).max()
    points = modes.points + SHOWN * size * shape
    return views.skin(points, modes.cells, np.linalg.norm(shape, axis=1))
