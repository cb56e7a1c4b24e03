"""Pictures of the blade in three dimensions, off screen: one camera, one scale of colours."""

import numpy as np
import pyvista as pv
from matplotlib.colors import Colormap
from numpy.typing import ArrayLike, NDArray
from pyvista.core.utilities.transformations import apply_transformation_to_points

PIXELS = (900, 1100)  # of one blade, before cropping


def camera(centre: ArrayLike, view: ArrayLike, scale: float) -> pv.Camera:
    """Parallel projection, radius upwards, with ``centre`` (3,), m, in the middle of the picture.

    ``view`` points from the blade to the camera; ``scale`` is half of the picture's height, m.
    """
    made = pv.Camera()
    made.parallel_projection = True
    made.focal_point = centre
    made.position = np.add(centre, view)
    made.up = (1, 0, 0)
    made.parallel_scale = scale
    return made


def aimed(points: NDArray[np.float64], view: ArrayLike) -> pv.Camera:
    """Camera on all ``points`` (n, 3), m."""
    low, high = points.min(axis=0), points.max(axis=0)
    return camera((low + high) / 2, view, 0.75 * (high - low).max())


def pixels(camera: pv.Camera, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Column and row (n, 2) of ``points`` (n, 3) in the picture before cropping."""
    projection = camera.GetCompositeProjectionTransformMatrix(PIXELS[0] / PIXELS[1], -1, 1)
    matrix = pv.array_from_vtkmatrix(projection)  # to the picture's width and height, -1 to 1
    across, up, _ = apply_transformation_to_points(matrix, points).T
    return (np.array(PIXELS) * (1 + np.column_stack([across, -up])) - 1) / 2


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
    plotter.camera = aimed(at_rest.points, view)
    plotter.reset_camera_clipping_range()
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
