"""Pictures of the blade in three dimensions, off screen: one camera, one scale of colours."""

import numpy as np
import pyvista as pv
from matplotlib.colors import Colormap
from numpy.typing import NDArray

PIXELS = (900, 1100)  # of one blade, before cropping


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
    _aim(plotter, at_rest.points, view)
    image = plotter.screenshot(return_img=True, transparent_background=True)
    plotter.close()
    return image


def crop(pictures: list[NDArray[np.uint8]]) -> list[NDArray[np.uint8]]:
    """Cut off the margin that is empty in all pictures: their scale stays common."""
    seen = np.any([image[..., 3] > 0 for image in pictures], axis=0)
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    return [image[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1] for image in pictures]


def _aim(
    plotter: pv.Plotter, points: NDArray[np.float64], view: tuple[float, float, float]
) -> None:
    """Parallel projection, radius upwards."""
    low, high = points.min(axis=0), points.max(axis=0)
    centre = (low + high) / 2
    plotter.camera.parallel_projection = True
    plotter.camera.focal_point = centre
    plotter.camera.position = centre + view
    plotter.camera.up = (1, 0, 0)
    plotter.camera.parallel_scale = 0.75 * (high - low).max()
    plotter.reset_camera_clipping_range()
