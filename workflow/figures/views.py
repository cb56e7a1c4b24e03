"""Pictures of the blade in three dimensions, off screen: one camera, one scale of colours."""

from dataclasses import dataclass

import numpy as np
import pyvista as pv
from matplotlib.colors import Colormap
from numpy.typing import NDArray

PIXELS = (900, 1100)  # of one blade, before cropping


@dataclass(frozen=True)
class Camera:
    """Parallel projection, radius upwards: where a point of space lies in a picture."""

    centre: NDArray[np.float64]  # (3,), m, in the middle of the picture
    view: NDArray[np.float64]  # (3,), from the blade to the camera
    scale: float  # m, half of the picture's height

    @classmethod
    def on(cls, points: NDArray[np.float64], view: tuple[float, float, float]) -> "Camera":
        """Aim at all ``points`` (n, 3)."""
        low, high = points.min(axis=0), points.max(axis=0)
        return cls((low + high) / 2, np.array(view), 0.75 * (high - low).max())

    def pixels(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Column and row (n, 2) of ``points`` (n, 3) in the picture before cropping."""
        right = np.cross([1.0, 0.0, 0.0], self.view)
        right /= np.linalg.norm(right)
        up = np.cross(self.view, right) / np.linalg.norm(self.view)
        across, height = ((points - self.centre) @ axis for axis in (right, up))
        pixel = 2 * self.scale / PIXELS[1]  # m
        middle = (np.array(PIXELS) - 1) / 2
        return middle + np.stack([across, -height], axis=1) / pixel


def skin(
    points: NDArray[np.float64], cells: NDArray[np.int64], values: NDArray[np.float64]
) -> pv.PolyData:
    """Outer faces of ten-node tetrahedra in VTK's order, with ``values`` at their nodes."""
    grid = pv.UnstructuredGrid({pv.CellType.QUADRATIC_TETRA: cells}, points)
    grid["values"] = values
    return grid.extract_surface(nonlinear_subdivision=1, algorithm="dataset_surface")


def picture(
    surface: pv.PolyData,
    at_rest: pv.PolyData,
    colours: Colormap,
    limits: tuple[float, float],
    view: tuple[float, float, float],
    light: tuple[float, float],
) -> NDArray[np.uint8]:
    """``surface`` in the colours of its values, RGBA (height, width, 4); ``at_rest`` as an outline.

    ``view`` points from the blade to the camera: x is the radius, y the sense of rotation, z the
    engine axis. ``light`` has two parts: that from everywhere keeps the colours, that from the
    camera gives relief.
    """
    plotter = pv.Plotter(off_screen=True, window_size=PIXELS)
    plotter.enable_anti_aliasing("ssaa")
    plotter.add_mesh(
        surface,
        scalars="values",
        clim=limits,
        cmap=colours,
        n_colors=colours.N,
        show_scalar_bar=False,
        smooth_shading=True,
        split_sharp_edges=True,
        ambient=light[0],
        diffuse=light[1],
    )
    outline = at_rest.extract_feature_edges(
        40, boundary_edges=False, non_manifold_edges=False, manifold_edges=False
    )
    plotter.add_mesh(outline, color="#404040", line_width=4)
    _aim(plotter, Camera.on(at_rest.points, view))
    image = plotter.screenshot(return_img=True, transparent_background=True)
    plotter.close()
    return image


def crop(pictures: list[NDArray[np.uint8]]) -> list[NDArray[np.uint8]]:
    """Cut off the margin that is empty in all pictures: their scale stays common."""
    seen = window(pictures)
    return [image[seen] for image in pictures]


def window(pictures: list[NDArray[np.uint8]]) -> tuple[slice, slice]:
    """Rows and columns outside of which all pictures are empty."""
    seen = np.any([image[..., 3] > 0 for image in pictures], axis=0)
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    return slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)


def _aim(plotter: pv.Plotter, camera: Camera) -> None:
    plotter.camera.parallel_projection = True
    plotter.camera.focal_point = camera.centre
    plotter.camera.position = camera.centre + camera.view
    plotter.camera.up = (1, 0, 0)
    plotter.camera.parallel_scale = camera.scale
    plotter.reset_camera_clipping_range()
