"""Fig. 6: shapes of the casing, two nodal diameters, and two with five."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulate.errors.signals import leading_gap
from workflow.figures import style
from workflow.figures.marks import over_casing
from workflow.figures.response import Response

DEGREES = np.linspace(0, 360, 721)
DRAWN = 0.3  # of the radius, the largest distortion or the gap in the drawing
CASING = {"color": style.BLACK, "linewidth": 1.4}
ROUND = {"color": style.GREY, "linestyle": "--", "linewidth": 0.8}
TIP = {"color": style.BLUE, "linestyle": "-.", "linewidth": 0.9}
CLOSED = {"facecolor": "#F0C8AA", "edgecolor": style.VERMILLION, "hatch": "////", "linewidth": 0}


def inward(response: Response) -> NDArray[np.float64]:
    """Distortion d (721,) at DEGREES, over gap g, at the end of the ramp."""
    gap = leading_gap(response.sweep)
    return response.scene.casing.inward(np.radians(DEGREES), gap) / gap


@style.styled
def draw(two: Response, two_five: Response) -> Figure:
    """Above, the shapes around the blade, equally exaggerated; below, to scale over the angle.

    ``two`` and ``two_five``: sweeps, of which the scenes are drawn.
    """
    responses = two, two_five
    drawn, rows = style.subplots(
        style.SINGLE, 3.4, 2, len(responses), height_ratios=(1.6, 1), sharey="row"
    )
    shapes = [inward(response) for response in responses]
    scale = DRAWN / max(1.0, np.abs(shapes).max())
    for response, d, around, over in zip(responses, shapes, *rows, strict=True):
        _around(around, d, scale, 1.02 * (1 + scale * max(0.0, -np.min(shapes))))
        _over_angle(over, d)
        orders = sorted({harmonic.order for harmonic in response.scene.casing.harmonics})
        around.set_title(f"harmonics {', '.join(map(str, orders))}", fontsize=7, loc="right")
    style.letter_panels(rows[0])
    rows[1][0].set_ylabel(f"distortion $d$ inward,\n{style.OVER_GAP}")
    style.legend(drawn, "lower center", ncols=2)
    return drawn


def _around(axes: Axes, d: NDArray[np.float64], scale: float, limit: float) -> None:
    """Draw the casing around the blade; one gap is ``scale`` of the radius.

    ``limit``: half of the drawing's width, over the radius.
    """
    casing, tip = 1 - scale * d, np.full_like(DEGREES, 1 - scale)
    axes.plot(*_circle(casing), label="casing, distorted", **CASING)
    axes.plot(*_circle(np.ones_like(DEGREES)), label="casing, undistorted", **ROUND)
    axes.plot(*_circle(tip), label=f"tip of undeformed blade, {style.PLACE}", **TIP)
    inner = np.minimum(casing, tip)
    ring = np.concatenate([_circle(tip), _circle(inner)[:, ::-1]], axis=1)
    axes.fill(*ring, label="gap closed by the casing alone", **CLOSED)
    axes.set(aspect="equal", xlim=(-limit, limit), ylim=(-limit, limit))
    axes.set_axis_off()
    _sense(axes)


def _sense(axes: Axes) -> None:
    """Mark theta = 0 and the sense of rotation, and state that the scale is exaggerated."""
    axes.plot([0.45, 1.03], [0, 0], color=style.GREY, linewidth=0.5)
    axes.text(1.05, 0, r"$\theta$ = 0", fontsize=7, va="center")
    turn = {"arrowstyle": "-|>", "connectionstyle": "arc3,rad=0.3", "color": style.BLACK}
    axes.annotate("", (0.22, 0.43), (0.45, 0.05), arrowprops=turn)
    axes.text(0.2, 0.2, r"$\Omega$", ha="center", va="center")
    axes.text(0, -0.2, "exaggerated", fontsize=6.5, ha="center", va="center")


def _circle(radius: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points (2, 721) at ``radius`` (721,) and DEGREES."""
    theta = np.radians(DEGREES)
    return radius * np.stack([np.cos(theta), np.sin(theta)])


def _over_angle(axes: Axes, d: NDArray[np.float64]) -> None:
    over_casing(axes, d[:-1], **CASING)
    axes.axhline(0, **ROUND)
    axes.axhline(1, **TIP)
    axes.fill_between(DEGREES, 1, d, where=d > 1, **CLOSED)
    axes.set_xticks(range(0, 361, 90))
