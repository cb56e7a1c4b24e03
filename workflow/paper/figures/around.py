"""Around the casing: its shapes (Fig. 6), and worn depth at the peaks of EO 4 (Fig. 12)."""

from collections.abc import Callable, Sequence
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

DEGREES = np.linspace(0, 360, 721)
DRAWN = 0.3  # of the radius, the largest distortion or the gap in the drawing
CASING = {"color": style.BLACK, "linewidth": 1.4}
ROUND = {"color": style.GREY, "linestyle": "--", "linewidth": 0.8}
TIP = {"color": style.BLUE, "linestyle": "-.", "linewidth": 0.9}
CLOSED = {"facecolor": "#F0C8AA", "edgecolor": style.VERMILLION, "hatch": "////", "linewidth": 0}
TURN = {"arrowstyle": "-|>", "connectionstyle": "arc3,rad=0.3", "color": style.BLACK}
LINES = (("-", style.BLACK), ("--", style.VERMILLION))  # E = 1, E = 10, dashed as in the paper
WITHIN = np.arange(-1, 362)  # deg, one beyond 0 and 360: maxima may lie there


def inward(response: Response) -> NDArray[np.float64]:
    """Distortion d (721,) at DEGREES, over gap g, at the end of the ramp."""
    gap = leading_gap(response.sweep)
    return response.scene.casing.inward(np.radians(DEGREES), gap) / gap


@style.styled
def shapes(two: Response, two_five: Response) -> Figure:
    """Above, the shapes around the blade, equally exaggerated; below, to scale over the angle.

    ``two`` and ``two_five``: sweeps, of which the scenes are drawn.
    """
    drawn = style.figure(style.SINGLE, 3.4)
    panels = drawn.subplot_mosaic(
        "ab;cd", height_ratios=(1.6, 1), per_subplot_kw={"ab": {"projection": "polar"}}
    )
    distortions = [inward(response) for response in (two, two_five)]
    scale = DRAWN / max(1.0, np.abs(distortions).max())
    for response, d, above, below in zip((two, two_five), distortions, "ab", "cd", strict=True):
        around, over = panels[above], panels[below]
        _shape(around, np.radians(DEGREES), d, lambda inward: 1 - scale * inward)
        around.set(ylim=(0, 1.02 * (1 + scale * max(0.0, -np.min(distortions)))), yticks=[])
        around.set_xticks([0], ["$\\theta$ = 0"], fontsize=7)
        around.tick_params(pad=0)
        around.spines[:].set_visible(False)
        around.annotate("", (1.0, 0.5), (0.1, 0.5), arrowprops=TURN)
        around.text(0.7, 0.3, "$\\Omega$", ha="center", va="center")
        around.text(-np.pi / 2, 0.2, "exaggerated", fontsize=6.5, ha="center", va="center")
        orders = sorted({harmonic.order for harmonic in response.scene.casing.harmonics})
        over.set_title(f"harmonics {', '.join(map(str, orders))}", fontsize=7)
        _shape(over, DEGREES, d, np.copy)
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
    d: NDArray[np.float64],
    height: Callable[[NDArray[np.float64]], NDArray[np.float64]],
) -> None:
    """Draw a casing of distortion ``d`` and the tip, at the ``height`` of their way inward."""
    none, gap = np.zeros_like(d), np.ones_like(d)
    axes.plot(theta, height(d), label="casing, distorted", **CASING)
    axes.plot(theta, height(none), label="casing, undistorted", **ROUND)
    axes.plot(theta, height(gap), label=f"tip of undeformed blade, {style.PLACE}", **TIP)
    axes.fill_between(
        theta, height(gap), height(d), d > 1, label="gap closed by the casing alone", **CLOSED
    )


@style.styled
def profiles(sweeps: Sequence[Response]) -> Figure:
    """Depth over the casing angle at the EO 4 peak, one line for each scene."""
    drawn, axes = style.subplots(style.SINGLE, 2.6)
    for response, (dashes, colour) in zip(sweeps, LINES, strict=True):
        _profile(axes, response, linestyle=dashes, color=colour)
    _nearest(axes, sweeps[0])
    first, second = sweeps[0].units["length"]
    axes.set(ylabel=LABEL + first.label, ylim=(0, None))
    style.beside(axes, second.scale / first.scale, f"worn depth {second.label}")
    drawn.legend(loc="outside upper center", ncols=1)
    return drawn


def _profile(axes: Axes, response: Response, **line: Any) -> None:
    """Draw the profile at the peak; without a peak, the legend says so."""
    peak = response.of_f1(ENGINE_ORDER)
    if peak is None:
        axes.plot([], [], label=f"{response.names}: no speed near the peak", **line)
        return
    chance = ", not predictable" if response.sensitive("wear")[peak.index] else ""
    over_casing(
        axes,
        response.units["length"][0].scale * response.wear[peak.index],
        label=f"{response.names}: {speed_text(response, peak)}{chance}",
        **line,
    )


def _nearest(axes: Axes, response: Response) -> None:
    """Mark the angles at which the casing is closest to the blade."""
    inward = response.scene.casing.inward(np.radians(WITHIN), leading_gap(response.sweep))
    nearest = WITHIN[maxima(inward)[0]]
    axes.vlines(
        nearest,
        0,
        1,
        transform=axes.get_xaxis_transform(),
        color=style.GREY,
        linestyle=":",
        linewidth=0.8,
        label="casing nearest",
    )
