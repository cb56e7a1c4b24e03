"""Parameters that the paper leaves open: their posteriors, and claims that hold together."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from workflow.figures import cells, style
from workflow.identify.fits import POSTERIORS, PRIOR, of_fit
from workflow.identify.likelihood import SHIFTS, WITH_ORDER
from workflow.identify.priors import Prior, Priors

PANELS = {  # by parameter: label, ticks, scale of its values
    "unit_Pa": ("unit of $E$, reference blade (GPa)", (0.1, 1, 10), 1e-9),
    "casing_gaps": ("casing, largest inward (gaps)", (1, 1.5, 2, 3, 4), 1.0),
    "fourth_over_second": ("fourth harmonic over second", (-0.5, 0, 0.5), 1.0),
    "constant_over_second": ("constant over second harmonic", (0, 0.5, 1), 1.0),
    "damping_ratio": ("damping ratio (%)", (0.1, 1), 100),
}
BINS = 10
FEW = 0.6  # pt, line of a fit with too few effective points for ranges
# Lines by K of E = 1 and data: label, colour, style
LINES = {
    (0.45, SHIFTS): ("$K$ = 0.45, shifts", style.VERMILLION, "--"),
    (4.55, SHIFTS): ("$K$ = 4.55, shifts", style.BLUE, "-"),
    (4.55, WITH_ORDER): ("$K$ = 4.55, with C12 and C16", style.BLACK, ":"),
}
MODULUS = "4.55"  # of E = 1
TITLES = {PRIOR: "prior", **dict.fromkeys(POSTERIORS, "posterior")}
SHARE = "share (%) of the draws with the claim of the row in which that of the column holds, too"


@style.styled
def posterior(fits: Mapping[str, Any], priors: Priors) -> Figure:
    """A panel for each parameter: densities over the prior's range; the prior is 1."""
    drawn, panels = style.subplots(style.DOUBLE, 3.8, rows=2, columns=3, sharey=True)
    style.letter_panels(panels.flat[: len(PANELS)])
    for axes, name in zip(panels.flat, PANELS, strict=False):
        _densities(axes, fits, name, getattr(priors, name))
    for axes in panels[:, 0]:
        axes.set_ylabel("density over the prior's")
    panels.flat[-1].set_axis_off()
    panels.flat[-1].legend(*panels.flat[0].get_legend_handles_labels(), loc="center")
    return drawn


def _densities(axes: Axes, fits: Mapping[str, Any], name: str, prior: Prior) -> None:
    """Weighted histograms of one parameter."""
    xlabel, ticks, scale = PANELS[name]
    spaced = np.geomspace if prior.log else np.linspace
    edges = scale * spaced(*prior.between, BINS + 1)
    values = scale * np.array(fits["values"][name])
    axes.axhline(1, color=style.GREY, linewidth=0.8, label="prior")
    for (K, data), (label, color, line) in LINES.items():
        numbers = of_fit(fits, K)[data]
        counts, _ = np.histogram(values, edges, weights=numbers["weights"])
        label = f"{label}\n({numbers['effective']:.0f} effective points)"
        width = FEW if numbers["ranges"] is None else None
        axes.stairs(BINS * counts, edges, color=color, linestyle=line, linewidth=width, label=label)
    axes.set_xscale("log" if prior.log else "linear")
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xticks([], minor=True)
    axes.set(xlabel=xlabel, ylim=(0, None))


def together(shares: Mapping[str, Any]) -> Figure:
    """A panel for the prior and one for the posterior: claims that hold, with one and another.

    A posterior of too few effective points has no draws, and no panel. On the diagonal is the
    share of all draws, in bold.
    """
    drawn = {name: shares[name][MODULUS] for name in TITLES if name in shares}
    records = [cell for name, part in drawn.items() for cell in _cells(name, part)]
    return cells.draw(
        records,
        "other",
        "one",
        "share",
        text="text",
        bold="alone",
        panel="of",
        labels=TITLES | {"share": SHARE},
        limits=(0, 100),
    )


def _cells(name: str, shares: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Shares in percent."""
    for one, held in shares["holds"].items():
        for other in shares["holds"]:
            share = 100 * np.array(held if one == other else shares["together"][one][other], float)
            yield {
                "of": name,
                "one": one,
                "other": other,
                "alone": one == other,
                "share": share,
                "text": f"{share:.0f}" if np.isfinite(share) else "",
            }
