"""Which claims of the paper hold together, and which exclude each other."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from workflow.figures import style
from workflow.figures.heat_map import cells, write
from workflow.identify.fits import POSTERIORS, PRIOR

K = "4.55"  # of E = 1


@style.styled
def draw(shares: Mapping[str, Any]) -> Figure:
    """One panel for the prior, one for the posterior: share of draws with one claim and another."""
    drawn, panels = style.subplots(style.DOUBLE, 3.5, columns=2, letters=True, sharey=True)
    for axes, name, title in zip(panels, (PRIOR, *POSTERIORS), ("prior", "posterior"), strict=True):
        if name in shares:  # a posterior of too few effective points has no draws
            _matrix(axes, shares[name][K])
        axes.set_title(title, loc="right")
        axes.set_xlabel("... this one holds in so many %")
    panels[0].set_ylabel("where this claim holds, ...")
    return drawn


def _matrix(axes: Axes, of: Mapping[str, Any]) -> None:
    """Shares in percent; on the diagonal the share of all draws."""
    claims = [*of["holds"]]
    values = np.array([[of["together"][one][other] for other in claims] for one in claims], float)
    np.fill_diagonal(values, [*of["holds"].values()])
    shares = dict(np.ndenumerate(values))
    cells(axes, claims, claims, shares, style.MAP_FROM_ZERO, Normalize(0, 1))
    for (i, j), share in shares.items():
        if np.isfinite(share):
            weight = "bold" if i == j else "normal"
            write(axes, (i, j), f"{100 * share:.0f}", fontsize=6.5, fontweight=weight)
    axes.set_ylim(len(claims) - 0.5, -0.5)
    axes.tick_params(axis="x", rotation=90)
