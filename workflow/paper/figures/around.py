"""Around the casing: its shapes (Fig. 6), and worn depth at the peaks of EO 4 (Fig. 12)."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulate.signals import leading_gap, maxima
from workflow.figures import style
from workflow.figures.annotations import CASING_ANGLE, over_casing, speed_text
from workflow.figures.response import Response
from workflow.figures.wear import LABEL
from workflow.paper.published import ENGINE_ORDER

LINES = (("-", style.BLACK), ("--", style.VERMILLION))  # E = 1, E = 10, dashed as in the paper


def inward(response: Response, degrees: NDArray[Any]) -> NDArray[np.float64]:
    """Distortion d (n,) at angles (n,), deg, over gap g, at the end of the ramp."""
    gap = leading_gap(response.sweep)
    return response.scene.casing.inward(np.radians(degrees), gap) / gap


@style.styled
def shapes(two: Response, two_five: Response) -> Figure:
    """Above, the shapes around the blade, equally exaggerated; below, to scale over the angle.

    ``two`` and ``two_five``: sweeps, of which the scenes are drawn.
    """
    drawn = style.figure(style.SINGLE, 3.4)
    panels = drawn.subplot_mosaic(
        "ab;cd", height_ratios=(1.6, 1), per_subplot_kw={"ab": {"projection": "polar"}}
    )
    theta = np.linspace(0, 360, 721)
    distortions = [inward(response, theta) for response in (two, two_five)]
    # the largest distortion, or the gap, is 0.3 of the radius
    scale = 0.3 / max(1.0, np.abs(distortions).max())
    for response, d, above, below in zip((two, two_five), distortions, "ab", "cd", strict=True):
        around, over = panels[above], panels[below]
        heights = np.array([d, 0 * d, 0 * d + 1])
        _shape(around, np.radians(theta), 1 - scale * heights, d > 1)
        around.set(ylim=(0, 1.02 * (1 + scale * max(0.0, -np.min(distortions)))), yticks=[])
        around.set_xticks([0], ["$\\theta$ = 0"], fontsize=7)
        around.tick_params(pad=0)
        around.spines[:].set_visible(False)
        turn = style.ARROW | {"connectionstyle": "arc3,rad=0.3"}
        around.annotate("", (1.0, 0.5), (0.1, 0.5), arrowprops=turn)
        around.text(0.7, 0.3, "$\\Omega$", ha="center", va="center")
        around.text(-np.pi / 2, 0.2, "exaggerated", fontsize=6.5, ha="center", va="center")
        orders = sorted({harmonic.order for harmonic in response.scene.casing.harmonics})
        over.set_title(f"harmonics {', '.join(map(str, orders))}", fontsize=7)
        _shape(over, theta, heights, d > 1)
        over.set(xlabel=CASING_ANGLE, xlim=(0, 360), xticks=range(0, 361, 90))
    panels["d"].sharey(panels["c"])
    panels["d"].tick_params(labelleft=False)
    panels["c"].set_ylabel(f"distortion $d$ inward,\n{style.OVER_GAP}")
    style.letter_panels([panels["a"], panels["b"]])
    style.legend(drawn, "lower center", ncols=2)
    return drawn


def _shape(
    axes: Axes,
    theta: NDArray[np.float64],
    heights: NDArray[np.float64],
    closed: NDArray[np.bool_],
) -> None:
    """Draw heights (3, n) of casing, undistorted casing and tip, and where the gap is closed."""
    casing, undistorted, tip = heights
    axes.plot(theta, casing, color=style.BLACK, linewidth=1.4, label="casing, distorted")
    axes.plot(theta, undistorted, "--", color=style.GREY, lw=0.8, label="casing, undistorted")
    label = f"tip of undeformed blade, {style.PLACE}"
    axes.plot(theta, tip, "-.", color=style.BLUE, linewidth=0.9, label=label)
    axes.fill_between(
        theta,
        tip,
        casing,
        closed,
        label="gap closed by the casing alone",
        facecolor="#F0C8AA",
        edgecolor=style.VERMILLION,
        hatch="////",
        linewidth=0,
    )


@style.styled
def profiles(sweeps: Sequence[Response]) -> Figure:
    """Depth over the casing angle at the EO 4 peak, one line for each scene.

    Without a peak, the legend says so. Dotted: the angles at which the first scene's casing is
    closest to the blade.
    """
    drawn, axes = style.subplots(style.SINGLE, 2.6)
    for response, (dashes, colour) in zip(sweeps, LINES, strict=True):
        peak = response.of_f1(ENGINE_ORDER)
        depth, said = np.array([np.nan]), "no speed near the peak"
        if peak is not None:
            chance = ", not predictable" if response.sensitive("wear")[peak.index] else ""
            depth, said = response.wear[peak.index], f"{speed_text(response, peak)}{chance}"
        over_casing(
            axes,
            response.units["length"][0].scale * depth,
            label=f"{response.names}: {said}",
            linestyle=dashes,
            color=colour,
        )
    degrees = np.arange(-1, 362)  # one beyond 0 and 360: maxima may lie there
    axes.vlines(
        degrees[maxima(inward(sweeps[0], degrees))[0]],
        0,
        1,
        transform=axes.get_xaxis_transform(),
        color=style.GREY,
        linestyle=":",
        linewidth=0.8,
        label="casing nearest",
    )
    first, second = sweeps[0].units["length"]
    axes.set(ylabel=LABEL + first.label, ylim=(0, None))
    style.beside(axes, second.scale / first.scale, f"worn depth {second.label}")
    drawn.legend(loc="outside upper center", ncols=1)
    return drawn
