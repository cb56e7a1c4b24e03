"""Fig. 2: the blade and the interface nodes of its tip."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from numpy.typing import NDArray

from geometry.interface import InterfaceNodes
from geometry.mesh_file import read_mesh_file
from workflow.figures import style, views

VIEW = (0.55, 1.0, 0.45)  # the pressure side, from above so that the tip is seen
PAINT = ListedColormap(["#D0D0D0"])
LIGHT = (0.3, 0.75)
MILLI = 1e3
LENGTH = 0.17  # of the picture's height, a unit vector across the view
START = (-0.2, 0.9)  # of the same, from the upper left corner: where unit vectors start
FRAME = {  # unit vector; where its label lies from its end, points of type
    r"$\mathbf{e}_r$": ((1.0, 0.0, 0.0), (0, 5)),
    r"$\mathbf{e}_\theta, \Omega$": ((0.0, 1.0, 0.0), (-2, -7)),
    r"$\mathbf{e}_z$": ((0.0, 0.0, 1.0), (-2, -7)),
}
LEFT = -0.33  # of the picture's height: room for the unit vectors
BORDER = 0.12  # of the tip's larger dimension, about it
ARROW = {"arrowstyle": "-|>", "linewidth": 1.0, "color": style.BLACK, "shrinkA": 0, "shrinkB": 0}
NODES = {"color": style.VERMILLION, "markeredgecolor": style.BLACK, "markeredgewidth": 0.5}


@dataclass(frozen=True)
class Tipped:
    """The blade's mesh and what of it meets the casing."""

    points: NDArray[np.float64]  # (n, 3), m
    cells: NDArray[np.int64]  # (cells, 10), ten-node tetrahedra in VTK's order
    tip: NDArray[np.int64]  # (faces, 3), corner nodes of the tip's faces
    interface: InterfaceNodes

    def on_tip(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """``points`` (n, 3) on the tip's cylinder, unrolled: z and r theta (n, 2), m."""
        theta = np.arctan2(points[:, 1], points[:, 0])
        return np.stack([points[:, 2], self.interface.radius.mean() * theta], axis=1)


def load(files: Any) -> tuple[Tipped]:
    """Read the mesh, ``files.mesh``, and the interface nodes, ``files.interface``."""
    mesh = read_mesh_file(files.mesh)
    nodes = InterfaceNodes.load(files.interface)
    return (Tipped(mesh.points, mesh.cells, mesh.face_groups["tip"], nodes),)


@style.styled
def draw(blade: Tipped) -> Figure:
    """The whole blade in space; its tip developed on a plane, to scale."""
    drawn = style.figure(style.SINGLE, 2.3)
    whole, tip = drawn.subplots(1, 2, width_ratios=(1, 1.05))
    _whole(whole, blade)
    _tip(tip, blade)
    for axes, letter in ((whole, "a"), (tip, "b")):
        style.panel_letter(axes, letter)
    return drawn


def _whole(axes: Axes, blade: Tipped) -> None:
    """Draw the skin, and over it the nodes and the unit vectors where the camera sees them."""
    surface = views.skin(blade.points, blade.cells, np.zeros(len(blade.points)))
    picture = views.picture(surface, surface, PAINT, (0, 1), VIEW, LIGHT)
    rows, columns = views.window([picture])
    camera = views.Camera.on(blade.points, VIEW)

    def seen(points: NDArray[np.float64]) -> NDArray[np.float64]:
        return camera.pixels(points) - (columns.start, rows.start)

    axes.imshow(picture[rows, columns], interpolation="none")
    axes.set_axis_off()
    nodes = seen(blade.interface.points)
    axes.plot(*nodes.T, "o", markersize=2.8, clip_on=False, **NODES)
    for number, which in ((1, 0), (len(nodes), -1)):
        _say(axes, nodes[which], str(number), (0, 7))
    for text, edge, x in (("LE", nodes[0], -11), ("TE", nodes[-1], 11)):
        _say(axes, edge, text, (x, -12))
    _frame(axes, picture[rows, columns].shape[0])
    axes.set_anchor("N")


def _frame(axes: Axes, height: int) -> None:
    """Draw the unit vectors beside the hub; that of theta is also the sense of rotation."""
    camera = views.Camera(np.zeros(3), np.array(VIEW), 1.0)
    origin, *ends = camera.pixels(np.array([np.zeros(3), *(unit for unit, _ in FRAME.values())]))
    start, length = height * np.array(START), 2 * LENGTH * height / views.PIXELS[1]
    for end, (label, (_, offset)) in zip(ends, FRAME.items(), strict=True):
        at = start + length * (end - origin)
        axes.annotate("", at, start, arrowprops=ARROW, annotation_clip=False)
        _say(axes, at, label, offset)
    axes.set_xlim(left=LEFT * height)


def _tip(axes: Axes, blade: Tipped) -> None:
    """Draw the tip unrolled, its faces and its nodes, with edges and sense of rotation named."""
    z, arc = MILLI * blade.on_tip(blade.points).T
    axes.tripcolor(z, arc, blade.tip, np.zeros(len(blade.tip)), cmap=PAINT)
    axes.triplot(z, arc, blade.tip, color=style.GREY, linewidth=0.3)
    nodes = MILLI * blade.on_tip(blade.interface.points)
    axes.plot(*nodes.T, "o", markersize=4, **NODES)
    for number, node in enumerate(nodes, start=1):
        _say(axes, node, str(number), (6, 6))
    _limits(axes, z[blade.tip], arc[blade.tip])
    axes.set(aspect="equal", xlabel="$z$, downstream (mm)", ylabel=r"$r\,\theta$ (mm)")
    axes.set_anchor("N")
    _sides(axes, nodes)


def _limits(axes: Axes, z: NDArray[np.float64], arc: NDArray[np.float64]) -> None:
    """Same border all around, room for numbers."""
    border = BORDER * max(np.ptp(z), np.ptp(arc))
    axes.set(xlim=(z.min() - border, z.max() + border))
    axes.set(ylim=(arc.min() - border, arc.max() + border))


def _sides(axes: Axes, nodes: NDArray[np.float64]) -> None:
    """Name the edges beside the first and the last node, and the sense of rotation."""
    for text, node, offset in (("LE", nodes[0], (-9, 0)), ("TE", nodes[-1], (-7, -9))):
        _say(axes, node, text, offset)
    within = axes.transAxes
    axes.annotate("", (0.85, 0.95), (0.85, 0.65), xycoords=within, arrowprops=ARROW)
    axes.text(0.81, 0.8, r"$\Omega$", transform=within, ha="right", va="center")


def _say(axes: Axes, at: NDArray[np.float64], text: str, offset: tuple[float, float]) -> None:
    """Write ``text`` beside a point, ``offset`` in points of type."""
    axes.annotate(
        text,
        at,
        offset,
        textcoords="offset points",
        ha="center",
        va="center",
        fontsize=7,
        annotation_clip=False,
    )
