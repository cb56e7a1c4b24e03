"""Which claims of the paper hold together, and which exclude each other."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from geometry.project import read_json
from workflow.figures import style
from workflow.identify.fits import POSTERIORS, PRIOR

K = "4.55"  # of E = 1
DARK = 0.55  # share above which text is white


def load(files: Any) -> tuple[Mapping[str, Any]]:
    """Read the shares, ``files.shares``."""
    return (read_json(files.shares),)


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
    axes.imshow(values, cmap=style.MAP_FROM_ZERO, vmin=0, vmax=1, aspect="auto")
    for (i, j), value in np.ndenumerate(values):
        if np.isfinite(value):
            color = "white" if value > DARK else style.BLACK
            look = {"ha": "center", "va": "center", "fontsize": 6.5, "color": color}
            weight = "bold" if i == j else "normal"
            axes.text(j, i, f"{100 * value:.0f}", fontweight=weight, **look)
    axes.set_xticks(range(len(claims)), claims, rotation=90)
    axes.set_yticks(range(len(claims)), claims)
