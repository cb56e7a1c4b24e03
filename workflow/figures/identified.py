"""Posteriors of the parameters that the paper leaves open."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from geometry.files import read_json
from workflow.figures import style
from workflow.identify.likelihood import SHIFTS, WITH_ORDER, Fit

LABELS = {
    "unit_Pa": "unit of $E$ and $K$ (Pa)",
    "casing_gaps": "casing, largest inward (gaps)",
    "fourth_over_second": "fourth harmonic over second",
    "constant_over_second": "constant over second harmonic",
    "damping_ratio": "damping ratio",
}
LOG = ("unit_Pa", "casing_gaps", "damping_ratio")
BINS = 10
# Lines by K of E = 1 and data: label, colour, style
LINES = {
    (0.45, SHIFTS): ("$K$ = 0.45, shifts", style.VERMILLION, "--"),
    (4.55, SHIFTS): ("$K$ = 4.55, shifts", style.BLUE, "-"),
    (4.55, WITH_ORDER): ("$K$ = 4.55, with C12 and C16", style.BLACK, ":"),
}


def load(files: Any) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
    """Read the fits, ``files.fits``, and the ranges of the priors, ``files.priors``."""
    from workflow.identify.priors import Priors

    return read_json(files.fits), Priors.load(files.priors).model_dump()


@style.styled
def draw(fits: Mapping[str, Any], priors: Mapping[str, Any]) -> Figure:
    """A panel for each parameter: densities over the prior's range; the prior is 1."""
    drawn, panels = style.subplots(style.DOUBLE, 3.8, rows=2, columns=3, sharey=True)
    style.letter_panels(panels.flat[: len(LABELS)])
    for axes, (name, label) in zip(panels.flat, LABELS.items(), strict=False):
        _densities(axes, fits, name, priors[name]["between"])
        axes.set(xlabel=label, ylim=(0, None))
    for axes in panels[:, 0]:
        axes.set_ylabel("density over the prior's")
    panels.flat[-1].set_axis_off()
    panels.flat[-1].legend(*panels.flat[0].get_legend_handles_labels(), loc="center")
    return drawn


def _densities(axes: Axes, fits: Mapping[str, Any], name: str, between: list[float]) -> None:
    """Weighted histograms of one parameter."""
    low, high = between
    edges = np.geomspace(low, high, BINS + 1) if name in LOG else np.linspace(low, high, BINS + 1)
    axes.axhline(1, color=style.GREY, linewidth=0.8, label="prior")
    for (K, data), (label, color, line) in LINES.items():
        weights = fits["fits"][Fit(K, fits["served"]).name][data]["weights"]
        counts, _ = np.histogram(fits["values"][name], edges, weights=weights)
        axes.stairs(BINS * counts, edges, color=color, linestyle=line, label=label)
    if name in LOG:
        axes.set_xscale("log")
