"""Sobol indices of amplitude and wear: which factors of a design matter."""

from typing import Annotated

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulate.scene.sobol import indices
from simulate.sweeps.design_runs import load as load_table
from workflow.figures import style

QUANTITIES = {"largest_amplitude": "largest amplitude", "largest_wear": "deepest wear"}
WIDTH = 0.36  # of a bar


type Rows = Annotated[xr.Dataset, load_table]


@style.styled
def draw(rows: Rows) -> Figure:
    """One panel for each quantity: first-order and total indices with their intervals.

    ``rows``: the table of a design, by row.
    """
    found = indices(rows, [*QUANTITIES])
    drawn, panels = style.subplots(
        style.DOUBLE, 2.6, columns=len(QUANTITIES), letters=True, sharey=True
    )
    for i, (axes, title) in enumerate(zip(panels, QUANTITIES.values(), strict=True)):
        first, total = found.first_interval[:, i], found.total_interval[:, i]
        _bars(axes, -WIDTH / 2, found.first[i], first, color=style.BLUE, label="first order")
        _bars(axes, WIDTH / 2, found.total[i], total, color=style.VERMILLION, label="total")
        axes.set_xticks(range(len(found.factors)), found.factors)
        axes.set_title(title, loc="right")
        axes.axhline(0, color=style.BLACK, linewidth=0.6)
    panels[0].set_ylabel("share of the variance")
    not_ok = int((rows["not_ok"] > 0).sum())
    counted = f"{rows.sizes['row']} rows, {not_ok} with runs not ok"
    style.legend(drawn, "lower center", ncols=2, title=counted)
    return drawn


def _bars(
    axes: Axes,
    offset: float,
    values: NDArray[np.float64],
    interval: NDArray[np.float64],
    **look: str,
) -> None:
    """Bars of the indices (factors,), with their ``interval`` (2, factors)."""
    places = np.arange(len(values)) + offset
    axes.bar(places, values, WIDTH, **look)
    axes.vlines(places, *interval, color=style.BLACK, linewidth=0.8)
