"""Pictures of the blade in three dimensions, rendered off screen on a common scale."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any

import meshio
import numpy as np
import pyvista as pv
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, Normalize
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from geometry.base import intact
from workflow.figures import style

PIXELS = (900, 1100)  # of one blade, before cropping
UP = (1, 0, 0)  # the radius
LINE, BAR, NAMES = 0.16, 0.75, 0.4  # in: a line of a title, the colour bar, names above the tip
MARGIN = 1.5  # height of the picture over the blade's largest dimension


def read_mesh(path: str | Path) -> meshio.Mesh:
    """Read a mesh with its facets, as the workflow wrote it."""
    return meshio.read(intact(path))


def read_fields(path: str | Path) -> pv.UnstructuredGrid:
    """Read a blade with fields at its nodes, ``stress.vtu``."""
    return pv.read(intact(path))


type Mesh = Annotated[meshio.Mesh, read_mesh]
type Fields = Annotated[pv.UnstructuredGrid, read_fields]


def solid(mesh: meshio.Mesh) -> pv.UnstructuredGrid:
    """The ten-node tetrahedra of a mesh, without its facets."""
    cells = {pv.CellType.QUADRATIC_TETRA: mesh.cells_dict["tetra10"]}
    return pv.UnstructuredGrid(cells, mesh.points)


def axes_of(view: ArrayLike) -> NDArray[np.float64]:
    """Unit vectors (3, 2) to the right and downwards in the picture.

    ``view`` points from the blade to the camera.
    """
    right = np.cross(UP, view)
    axes = np.column_stack([right, np.cross(right, view)])
    return axes / np.linalg.norm(axes, axis=0)


def pixels(
    grid: pv.UnstructuredGrid, view: ArrayLike, points: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Column and row (n, 2) of ``points`` (n, 3), m, in the picture of ``grid`` before cropping."""
    from_middle = (points - grid.center) @ axes_of(view) * PIXELS[1] / (2 * _half_height(grid))
    return from_middle + (np.array(PIXELS) - 1) / 2


def _half_height(grid: pv.UnstructuredGrid) -> float:
    """Half the height of the picture of ``grid``, m."""
    return MARGIN / 2 * max(grid.bounds_size)


def picture(
    grid: pv.UnstructuredGrid,
    displacement: ArrayLike,
    values: NDArray[np.float64],
    view: tuple[float, float, float],
    colours: Colormap,
    limits: tuple[float, float],
    light: tuple[float, float],
) -> NDArray[np.uint8]:
    """The deformed blade in the colours of ``values`` (nodes,), RGBA (height, width, 4).

    ``grid`` is drawn displaced by ``displacement`` (nodes, 3), m, with the outline of the
    undeformed blade. ``view`` points from the blade to the camera: x is the radius, y the sense of
    rotation, z the engine axis. ``light``: shares of ambient and of diffuse light.
    """
    plotter = pv.Plotter(off_screen=True, window_size=PIXELS)
    plotter.enable_anti_aliasing("ssaa")
    moved = grid.copy()
    moved.points = grid.points + displacement
    moved["values"] = values
    plotter.add_mesh(
        _skin(moved),
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
    outline = _skin(grid).extract_feature_edges(
        40, boundary_edges=False, non_manifold_edges=False, manifold_edges=False
    )
    plotter.add_mesh(outline, color="#404040", line_width=4)
    plotter.camera_position = [np.add(grid.center, view), grid.center, UP]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = _half_height(grid)
    plotter.reset_camera_clipping_range()
    image = plotter.screenshot(return_img=True, transparent_background=True)
    plotter.close()
    return image


def _skin(grid: pv.UnstructuredGrid) -> pv.PolyData:
    """Outer faces of the tetrahedra, each divided once at its mid-edge nodes."""
    return grid.extract_surface(nonlinear_subdivision=1, algorithm="dataset_surface")


def gallery(
    grid: pv.UnstructuredGrid,
    rows: Sequence[tuple[str, ArrayLike, NDArray[np.float64], tuple[float, float, float]]],
    look: tuple[Colormap, tuple[float, float], tuple[float, float]],
    width: float,
    names: Mapping[str, NDArray[np.float64]],
    heading: str,
    marked: Mapping[str, Mapping[str, NDArray[np.float64]]] = MappingProxyType({}),
    **bar: Any,
) -> Figure:
    """Pictures side by side under a heading; ``bar``: arguments of the colour bar below.

    Each of ``rows`` is a title and the displacement, values and view of a picture; ``look`` are the
    colours, limits and light of all; ``names`` are written outside their points (3,), m; those
    that are ``marked``, by title, beside a ring at theirs. Margins empty in all pictures are cut
    off, so that their scale remains the same.
    """
    colours, limits, _ = look
    images = [picture(grid, moved, values, view, *look) for _, moved, values, view in rows]
    seen = window(images)
    height, across = images[0][seen].shape[:2]
    lines = 2 + rows[0][0].count("\n") + heading.count("\n")
    tall = width / len(rows) * height / across + LINE * lines + BAR + NAMES * bool(names)
    drawn, (panels,) = style.subplots(width, tall, 1, len(rows), squeeze=False)
    for axes, image, (title, *_, view) in zip(panels, images, rows, strict=True):
        axes.imshow(image[seen], interpolation="none")
        axes.set_axis_off()
        axes.set_anchor("S")  # leaves room above the picture
        axes.set_title(title, linespacing=1.3, pad=14 if names else None)
        middle, *places = pixels(grid, view, np.array([grid.center, *names.values()]))
        for name, place in zip(names, places, strict=True):
            away = (place - middle) / np.linalg.norm(place - middle)
            pixel = place - (seen[1].start, seen[0].start)
            style.note(
                axes, tuple(pixel), name, (7 * away[0], -7 * away[1]), ha="center", va="center"
            )
        for name, point in marked.get(title, {}).items():
            pixel = pixels(grid, view, point[None])[0] - (seen[1].start, seen[0].start)
            axes.plot(*pixel, "o", color=style.BLACK, markerfacecolor="none", markersize=5)
            inwards = -1 if pixel[0] > across / 2 else 1
            style.note(
                axes,
                tuple(pixel),
                name,
                (5 * inwards, 5),
                ha="left" if inwards > 0 else "right",
                bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.8},
            )
    mappable = ScalarMappable(Normalize(*limits), colours)
    drawn.colorbar(mappable, ax=list(panels), location="bottom", **bar)
    drawn.suptitle(heading, fontsize=8, linespacing=1.3)
    return drawn


def window(pictures: list[NDArray[np.uint8]]) -> tuple[slice, slice]:
    """Slices of rows and columns that hold everything drawn in the pictures."""
    seen = np.any([image[..., 3] > 0 for image in pictures], axis=0)
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    return slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
