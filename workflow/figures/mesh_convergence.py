"""Mesh study: errors of the frequencies and of the tip deflection against the element size."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator, StrMethodFormatter
from numpy.typing import NDArray

from geometry.files import read_json
from workflow.figures import style
from workflow.study.mesh_level import MODES, OWN

MARKERS = "os^vD<>pPX"  # one for each mode


def load(files: Any) -> tuple[dict[str, Any]]:
    """Read the summary of the study, ``files.study``."""
    return (read_json(files.study),)


@style.styled
def draw(study: dict[str, Any]) -> Figure:
    """Errors against the limit, one line for each mode at rest and one for the tip deflection."""
    drawn = style.figure(style.SINGLE, 3.1)
    axes = drawn.subplots()
    sizes = np.array(study["element_size_mm"])
    frequencies = 100 * np.abs(study["at_rest_Hz"]["error"])
    tip = 100 * np.abs(study["tip_deflection_m"]["error"])[:, 0]
    shades = style.MAP(np.linspace(0.25, 0.95, MODES))
    for m, marker in zip(range(MODES), MARKERS, strict=True):
        label = f"mode {m + 1}"
        axes.plot(sizes, frequencies[:, m], f"{marker}-", color=shades[m], lw=0.7, label=label)
    axes.plot(sizes, tip, "o--", color=style.BLUE, markerfacecolor="white", label="tip deflection")
    _slope(axes, sizes, study["order"], frequencies.max())
    axes.axvline(sizes[OWN], color=style.GREY, linewidth=0.6, linestyle=":", label="own size")
    axes.set(xscale="log", yscale="log", xlabel="element size, mm", ylabel="error, %")
    axes.set_xticks(sizes, [f"{size:.2f}" for size in sizes])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    _nodes(axes, sizes, study["nodes"])
    drawn.legend(loc="outside lower center", ncols=4, handlelength=1.6, columnspacing=1.0)
    return drawn


def _slope(axes: Axes, sizes: NDArray[np.float64], order: float, top: float) -> None:
    """Line of the common order, above all errors."""
    line = 1.6 * top * (sizes / sizes[0]) ** order
    axes.plot(sizes, line, "--", color=style.GREY, linewidth=0.8)
    axes.annotate(
        f"order {order:.2f}",
        (sizes[1], line[1]),
        (-6, 2),
        textcoords="offset points",
        ha="right",
        fontsize=7,
    )


def _nodes(axes: Axes, sizes: NDArray[np.float64], nodes: list[int]) -> None:
    """Nodes of each mesh along the top."""
    top = axes.secondary_xaxis("top")
    top.set_xticks(sizes, [f"{n:,}" for n in nodes])
    top.xaxis.set_minor_locator(NullLocator())
    top.set_xlabel("nodes")
