"""Fig. 2: the blade and the patches of its tip."""

from fractions import Fraction

import meshio
import numpy as np
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
FRAME = {  # unit vector; offset of its label from its end, points of type
    r"$\mathbf{e}_r$": ((1.0, 0.0, 0.0), (0, 5)),
    r"$\mathbf{e}_\theta, \Omega$": ((0.0, 1.0, 0.0), (-2, -7)),
    r"$\mathbf{e}_z$": ((0.0, 0.0, 1.0), (-2, -7)),
}
SLIVER = 0.002  # of the chord, left out at its end, where the sides of the tip meet
SAID = {"ha": "center", "va": "center"}
NODES = {"color": style.BLACK, "markersize": 3.2, "linewidth": 0.8}
OUTPUT = {
    "markersize": 4,
    "color": style.VERMILLION,
    "markeredgecolor": style.BLACK,
    "markeredgewidth": 0.6,
}
EIGHTH = {"facecolor": "#F0B98F", "edgecolor": style.BLACK, "linewidth": 0.6}


def facets_of(mesh: meshio.Mesh) -> NDArray[np.int64]:
    """Nodes (facets, 6) of the tip's facets."""
    return mesh.cells_dict["triangle6"][mesh.cell_sets_dict["tip"]["triangle6"]]


@style.styled
def draw(mesh: rendering.Mesh, rom: Rom) -> Figure:
    """The whole blade; its tip developed on a plane, to scale; hat functions along the chord."""
    drawn = style.figure(style.SINGLE, 3.2)
    panels = drawn.subplot_mosaic("ab;cc", height_ratios=(3, 1), width_ratios=(1, 1.05))
    tip = tip_of(facets_of(mesh), mesh.points)
    _whole(panels["a"], mesh, cartesian(on_line(tip.camber_line(), rom.xi)))
    _tip(panels["b"], mesh, tip, rom.xi)
    _hats(panels["c"], rom.xi)
    style.letter_panels(panels.values())
    return drawn


def _whole(axes: Axes, mesh: meshio.Mesh, camber: NDArray[np.float64]) -> None:
    """Draw the skin, and over it nodes (n, 3), m, and the unit vectors as the camera sees them.

    These stand next to the hub; that of theta is also the sense of rotation.
    """
    solid = rendering.solid(mesh)
    picture = rendering.picture(solid, 0, np.zeros(solid.n_points), VIEW, PAINT, (0, 1), LIGHT)
    rows, columns = rendering.window([picture])
    nodes = rendering.pixels(solid, VIEW, camber) - (columns.start, rows.start)
    axes.imshow(picture[rows, columns], interpolation="none")
    axes.set_axis_off()
    axes.plot(*nodes.T, ".-", clip_on=False, **(NODES | {"markersize": 2.5}))
    style.note(axes, nodes[0], "LE", (-9, 3), **SAID)
    style.note(axes, nodes[-1], "TE", (9, 3), **SAID)
    height = rows.stop - rows.start
    start = height * np.array([-0.2, 0.9])
    for label, (unit, offset) in FRAME.items():
        end = start + 0.17 * height * np.array(unit) @ rendering.axes_of(VIEW)
        axes.annotate("", end, start, arrowprops=style.ARROW, annotation_clip=False)
        style.note(axes, end, label, offset, **SAID)
    axes.set(xlim=(-0.33 * height, None), anchor="N")  # with room for the unit vectors


def _tip(axes: Axes, mesh: meshio.Mesh, tip: DevelopedTip, xi: NDArray[np.float64]) -> None:
    """Draw the tip unrolled at its mean radius: facets, the patches' nodes, places of outputs."""
    used, corners = np.unique(facets_of(mesh)[:, :3], return_inverse=True)
    x, y, z = mesh.points[used].T
    facets = MILLI * z, MILLI * tip.radius * np.arctan2(y, x), corners.reshape(-1, 3)
    axes.tripcolor(*facets, np.zeros(len(facets[2])), cmap=PAINT)
    axes.triplot(*facets, color=style.GREY, linewidth=0.3)
    camber, eighth = tip.camber_line(), np.linspace(SLIVER, 1 / SHARES, 41)
    ahead = tip.pressure_side(eighth)
    behind = 2 * on_line(camber, eighth) - ahead
    outline, nodes, place = (
        MILLI * line[:, [2, 1]] * (1, tip.radius)
        for line in (
            np.vstack([ahead, behind[::-1]]),
            on_line(camber, xi),
            on_line(camber, np.array([LEADING])),
        )
    )
    axes.fill(*outline.T, **EIGHTH)
    axes.plot(*nodes.T, ".-", **NODES)
    axes.plot(*place.T, "o", **OUTPUT)
    axes.margins(0.12)  # room for numbers
    axes.set(aspect="equal", anchor="N", xlabel="$z$, downstream (mm)", ylabel=r"$r\,\theta$ (mm)")
    style.note(axes, nodes[0], "LE", (10, 3), **SAID)
    style.note(axes, nodes[-1], "TE", (-9, -4), **SAID)
    axes.annotate("", (0.85, 0.95), (0.85, 0.65), xycoords="axes fraction", arrowprops=style.ARROW)
    axes.text(0.81, 0.8, r"$\Omega$", transform=axes.transAxes, ha="right", va="center")


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
    axes.set(
        xticks=np.arange(SHARES + 1) / SHARES,
        xticklabels=[str(Fraction(i, SHARES)) for i in range(SHARES + 1)],
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
