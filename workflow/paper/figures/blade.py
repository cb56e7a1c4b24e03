"""Fig. 2: the blade and the patches of its tip."""

from dataclasses import dataclass
from fractions import Fraction

import meshio
import numpy as np
import pyvista as pv
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from numpy.typing import NDArray

from geometry.hats import hats
from geometry.interface import tip_of
from geometry.tip import DevelopedTip, cartesian, on_line
from rom.model import Rom
from simulate.contact.places import SHARES
from simulate.scene import LEADING
from workflow.figures import rendering, style

VIEW = (0.55, 1.0, 0.45)  # the pressure side, from above the tip
PAINT = ListedColormap(["#D0D0D0"])
LIGHT = (0.3, 0.75)
MILLI = 1e3
LENGTH = 0.17  # of the picture's height, a unit vector across the view
START = (-0.2, 0.9)  # of the same, from the upper left corner: origin of the unit vectors
FRAME = {  # unit vector; offset of its label from its end, points of type
    r"$\mathbf{e}_r$": ((1.0, 0.0, 0.0), (0, 5)),
    r"$\mathbf{e}_\theta, \Omega$": ((0.0, 1.0, 0.0), (-2, -7)),
    r"$\mathbf{e}_z$": ((0.0, 0.0, 1.0), (-2, -7)),
}
LEFT = -0.33  # of the picture's height: room for the unit vectors
SLIVER = 0.002  # of the chord, left out at its end, where the sides of the tip meet
BORDER = 0.12  # of the tip's larger dimension, about it
NODES = {"color": style.BLACK, "markersize": 3.2, "linewidth": 0.8}
OUTPUT = {
    "markersize": 4,
    "color": style.VERMILLION,
    "markeredgecolor": style.BLACK,
    "markeredgewidth": 0.6,
}
EIGHTH = {"facecolor": "#F0B98F", "edgecolor": style.BLACK, "linewidth": 0.6}


@dataclass(frozen=True)
class Tipped:
    """The blade's mesh and its tip, with the nodes of the patches."""

    solid: pv.UnstructuredGrid  # its points in m
    facets: NDArray[np.int64]  # (facets, 6), of the tip
    tip: DevelopedTip
    nodes: NDArray[np.float64]  # (patches,), chord fractions at which the hat functions are 1

    def on_camber(self, xi: NDArray[np.float64]) -> NDArray[np.float64]:
        """Places (n, 3), m, on the camber line at chord fractions ``xi`` (n,)."""
        return cartesian(on_line(self.tip.camber_line(), xi))

    def across(self, xi: NDArray[np.float64]) -> NDArray[np.float64]:
        """Outline (2 n, 3), m, of the tip between the first and the last ``xi`` (n,)."""
        ahead = cartesian(self.tip.pressure_side(xi))
        behind = 2 * self.on_camber(xi) - ahead
        return np.vstack([ahead, behind[::-1]])

    def unrolled(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """``points`` (n, 3) on the tip, unrolled at its mean radius: z and r theta (n, 2), m."""
        theta = np.arctan2(points[:, 1], points[:, 0])
        return np.stack([points[:, 2], self.tip.radius * theta], axis=1)


def tipped(mesh: meshio.Mesh, rom: Rom) -> Tipped:
    """The blade of a mesh, with the patches of its reduced model."""
    facets = mesh.cells_dict["triangle6"][mesh.cell_sets_dict["tip"]["triangle6"]]
    return Tipped(
        solid=rendering.solid(mesh), facets=facets, tip=tip_of(facets, mesh.points), nodes=rom.xi
    )


@style.styled
def draw(mesh: rendering.Mesh, rom: Rom) -> Figure:
    """The whole blade; its tip developed on a plane, to scale; hat functions along the chord."""
    blade = tipped(mesh, rom)
    drawn = style.figure(style.SINGLE, 3.2)
    panels = drawn.subplot_mosaic("ab;cc", height_ratios=(3, 1), width_ratios=(1, 1.05))
    _whole(panels["a"], blade)
    _tip(panels["b"], blade)
    _hats(panels["c"], blade.nodes)
    style.letter_panels(panels.values())
    return drawn


def _whole(axes: Axes, blade: Tipped) -> None:
    """Draw the skin, and over it the camber line and the unit vectors as the camera sees them."""
    no_values = np.zeros(blade.solid.n_points)
    picture = rendering.picture(blade.solid, 0, no_values, VIEW, PAINT, (0, 1), LIGHT)
    rows, columns = rendering.window([picture])
    pixels = rendering.pixels(blade.solid, VIEW, blade.on_camber(blade.nodes))
    nodes = pixels - (columns.start, rows.start)
    axes.imshow(picture[rows, columns], interpolation="none")
    axes.set_axis_off()
    axes.plot(*nodes.T, ".-", clip_on=False, **(NODES | {"markersize": 2.5}))
    for text, edge, x in (("LE", nodes[0], -9), ("TE", nodes[-1], 9)):
        _say(axes, edge, text, (x, 3))
    _frame(axes, picture[rows, columns].shape[0])
    axes.set_anchor("N")


def _frame(axes: Axes, height: int) -> None:
    """Draw the unit vectors next to the hub; that of theta is also the sense of rotation."""
    start = height * np.array(START)
    for label, (unit, offset) in FRAME.items():
        end = start + LENGTH * height * np.array(unit) @ rendering.axes_of(VIEW)
        axes.annotate("", end, start, arrowprops=style.ARROW, annotation_clip=False)
        _say(axes, end, label, offset)
    axes.set_xlim(left=LEFT * height)


def _tip(axes: Axes, blade: Tipped) -> None:
    """Draw the tip unrolled: its facets, the nodes of the patches, and the places of outputs."""
    z, arc = MILLI * blade.unrolled(blade.solid.points).T
    corners = blade.facets[:, :3]
    axes.tripcolor(z, arc, corners, np.zeros(len(corners)), cmap=PAINT)
    axes.triplot(z, arc, corners, color=style.GREY, linewidth=0.3)
    eighth = MILLI * blade.unrolled(blade.across(np.linspace(SLIVER, 1 / SHARES, 41)))
    axes.fill(*eighth.T, **EIGHTH)
    nodes = MILLI * blade.unrolled(blade.on_camber(blade.nodes))
    axes.plot(*nodes.T, ".-", **NODES)
    place = MILLI * blade.unrolled(blade.on_camber(np.array([LEADING])))
    axes.plot(*place.T, "o", **OUTPUT)
    border = BORDER * max(np.ptp(z[corners]), np.ptp(arc[corners]))  # room for numbers
    axes.set(
        xlim=(z[corners].min() - border, z[corners].max() + border),
        ylim=(arc[corners].min() - border, arc[corners].max() + border),
        aspect="equal",
        anchor="N",
        xlabel="$z$, downstream (mm)",
        ylabel=r"$r\,\theta$ (mm)",
    )
    _sides(axes, nodes)


def _hats(axes: Axes, nodes: NDArray[np.float64]) -> None:
    """Draw the patches' hat functions over the chord, and the places of outputs."""
    for i, values in enumerate(hats(nodes, nodes).T):
        axes.plot(nodes, values, color=style.BLACK, linewidth=0.8, linestyle=("-", "--")[i % 2])
    axes.axvspan(0, 1 / SHARES, zorder=0, label="leading eighth: wear", **EIGHTH)
    axes.plot(
        LEADING,
        0,
        "o",
        clip_on=False,
        zorder=5,
        label=f"{style.PLACE}: displacement, gap $g$",
        **OUTPUT,
    )
    eighths = ["0", *(f"{Fraction(i, SHARES)}" for i in range(1, SHARES)), "1"]
    axes.set_xticks(np.arange(SHARES + 1) / SHARES, eighths)
    axes.set(
        xlim=(0, 1),
        ylim=(0, 1),
        yticks=(0, 1),
        xlabel=r"chord fraction $\xi$",
        ylabel=f"{len(nodes)} patches",
    )
    axes.legend(
        handles=axes.get_legend_handles_labels()[0][::-1],
        loc="lower right",
        bbox_to_anchor=(1.02, 0.98),
        ncols=2,
        fontsize=6.5,
        handlelength=1.0,
        handletextpad=0.5,
        columnspacing=0.8,
    )


def _sides(axes: Axes, nodes: NDArray[np.float64]) -> None:
    """Label the leading and the trailing edge, and the sense of rotation."""
    for text, node, offset in (("LE", nodes[0], (10, 3)), ("TE", nodes[-1], (-9, -4))):
        _say(axes, node, text, offset)
    within = axes.transAxes
    axes.annotate("", (0.85, 0.95), (0.85, 0.65), xycoords=within, arrowprops=style.ARROW)
    axes.text(0.81, 0.8, r"$\Omega$", transform=within, ha="right", va="center")


def _say(axes: Axes, place: NDArray[np.float64], text: str, offset: tuple[float, float]) -> None:
    """Write ``text`` next to a point, ``offset`` in points of type."""
    style.note(axes, place, text, offset, ha="center", va="center")
