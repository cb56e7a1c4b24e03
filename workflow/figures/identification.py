"""Parameters that the paper leaves open: their posteriors, and claims that hold together."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from workflow.figures import cells, style
from workflow.identify.fits import ENOUGH, of_fit
from workflow.identify.likelihood import SHIFTS, WITH_ORDER
from workflow.identify.priors import Prior, Priors

PANELS = {  # by parameter: label, scale of its values
    "span_mm": ("span (mm)", 1.0),
    "tip_lean_tangential_mm": ("lean, tangential (mm)", 1.0),
    "tip_lean_axial_mm": ("lean, axial (mm)", 1.0),
    "hub_thickness_mm": ("hub thickness (mm)", 1.0),
    "tip_thickness_mm": ("tip thickness (mm)", 1.0),
    "hub_stagger_deg": ("hub stagger (deg)", 1.0),
    "tip_stagger_deg": ("tip stagger (deg)", 1.0),
    "unit_Pa": ("unit of $E$ (GPa)", 1e-9),
    "casing_gaps": ("casing, inward (gaps)", 1.0),
    "fourth_over_second": ("fourth over second", 1.0),
    "constant_over_second": ("constant over second", 1.0),
    "fifth_over_second": ("fifth over second", 1.0),
    "damping_ratio": ("damping ratio (%)", 100),
}
TICKS = {"casing_gaps": (1, 2, 4), "fifth_over_second": (0.3, 1, 3)}  # of short logarithmic ranges
BINS = 10
THIN = 0.6  # pt, line of a fit whose ranges are rough
# Lines by K of E = 1 and data: label, colour, style
LINES = {
    (0.45, SHIFTS): ("$K$ = 0.45, shifts", style.VERMILLION, "--"),
    (4.55, SHIFTS): ("$K$ = 4.55, shifts", style.BLUE, "-"),
    (4.55, WITH_ORDER): ("$K$ = 4.55, with C12 and C16", style.BLACK, ":"),
}
SHARE = "share (%) of the draws with the claim of the row in which that of the column holds, too"


@style.styled
def posterior(fits: Mapping[str, Any], priors: Priors) -> Figure:
    """A panel for each parameter: densities over the prior's range; the prior is 1."""
    drawn, panels = style.subplots(style.DOUBLE, 4.6, rows=3, columns=5, sharey=True)
    style.letter_panels(panels.flat[: len(PANELS)])
    for axes, name in zip(panels.flat, PANELS, strict=False):
        _densities(axes, fits, name, getattr(priors, name))
    drawn.supylabel("density over the prior's")
    for axes in panels.flat[len(PANELS) :]:
        axes.set_axis_off()
    panels.flat[0].set_ylim(bottom=0)
    key = panels.flat[-2].legend(*panels.flat[0].get_legend_handles_labels(), loc="upper left")
    key.set_in_layout(False)  # it is wider than a panel
    return drawn


def _densities(axes: Axes, fits: Mapping[str, Any], name: str, prior: Prior) -> None:
    """Weighted histograms of one parameter."""
    xlabel, scale = PANELS[name]
    spaced = np.geomspace if prior.log else np.linspace
    edges = scale * spaced(*prior.between, BINS + 1)
    values = scale * np.array(fits["values"][name])
    axes.axhline(1, color=style.GREY, linewidth=0.8, label="prior")
    for (K, data), (label, color, line) in LINES.items():
        numbers = of_fit(fits, K)[data]
        counts, _ = np.histogram(values, edges, weights=numbers["weights"])
        axes.stairs(
            BINS * counts,
            edges,
            color=color,
            linestyle=line,
            linewidth=THIN if numbers["effective"] < ENOUGH else None,
            label=f"{label}\n({numbers['effective']:.0f} effective points)",
        )
    if prior.log:
        axes.set_xscale("log")
        axes.xaxis.set_minor_locator(NullLocator())
    if ticks := TICKS.get(name):
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xlabel(xlabel)


def together(shares: Mapping[str, Any]) -> Figure:
    """Claims that hold, with one and another; the share of all draws on the diagonal, in bold."""
    return cells.draw(
        [*_cells(shares)],
        "other",
        "one",
        "share",
        text="text",
        bold="alone",
        labels={"share": SHARE},
        limits=(0, 100),
    )


def _cells(shares: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Shares in percent."""
    for one, held in shares["holds"].items():
        for other in shares["holds"]:
            share = 100 * np.array(held if one == other else shares["together"][one][other], float)
            yield {
                "one": one,
                "other": other,
                "alone": one == other,
                "share": share,
                "text": f"{share:.0f}" if np.isfinite(share) else "",
            }
