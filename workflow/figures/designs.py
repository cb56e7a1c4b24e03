"""Designs: their rows as a table and a picture, and the factors that matter."""

from itertools import cycle

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulate.scene import TRENDS
from workflow.figures import lines, style
from workflow.figures.units import MICRO, RPM_PER_HZ
from workflow.many import quantiles as over_seeds
from workflow.many.design import SEED
from workflow.many.design_tables import Rows
from workflow.many.sobol import indices

LARGEST, DEEPEST = "largest amplitude (µm)", "deepest wear (µm)"  # of all runs of a row
VALUE = "value (in the unit of its key)"
QUANTITIES = {"largest_amplitude": "largest amplitude", "largest_wear": "deepest wear"}
WIDTH = 0.36  # of a bar


def table(rows: xr.Dataset) -> pd.DataFrame:
    """A line for each row of a design: its changes, its extremes, its reported peaks.

    In rpm, micrometres and newtons; a peak that is not reported has no numbers. Where a row is
    refused, or runs of it ended otherwise than ok, `why` says so.
    """
    reported = rows["reported"] > 0
    by_quantity = {
        "critical speed (rpm)": RPM_PER_HZ * rows["f1_Hz"] * rows["critical_speed"],
        "amplitude (µm)": MICRO * rows["gap"] * rows["peak"],
        "motion": reported.copy(data=np.array([*TRENDS, ""])[rows["trend"]]),
        "wear (µm)": MICRO * rows["wear"],
        "peak force (N)": rows["force_peak"],
    }
    by_order = {
        f"EO {k} {name}": values.where(reported).sel(order=k, drop=True)
        for k in rows["order"].values[reported.any("row")]
        for name, values in by_quantity.items()
    }
    row_columns = given(rows) | {
        LARGEST: MICRO * rows["largest_amplitude"],
        DEEPEST: MICRO * rows["largest_wear"],
        "runs": rows["runs"],
        "runs not ok": rows["not_ok"],
        **({"why": rows["why"]} if (rows["why"] != "").any() else {}),
    }
    return xr.Dataset(row_columns | by_order).to_dataframe()


def given(rows: xr.Dataset) -> dict[str, xr.DataArray]:
    """Values (rows,) of the columns that the design gives."""
    return {
        str(name): values
        for name, values in rows.items()
        if values.attrs.get("long_name") == "given"
    }


def csv(rows: Rows) -> str:
    """The same as CSV."""
    return table(rows).to_csv(float_format="%.6g")


def quantiles(rows: xr.Dataset) -> str:
    """Quantiles of largest amplitude and deepest wear over the seeds as CSV, with intervals.

    Apart for each value of the other columns of the design.
    """
    frame = table(rows)
    return over_seeds.table(frame, _no_seeds(rows), [LARGEST, DEEPEST]).to_csv(
        index=False, float_format="%.6g"
    )


def _no_seeds(rows: xr.Dataset) -> list[str]:
    """Columns that the design gives, but for seeds."""
    return [name for name in given(rows) if not name.endswith(SEED)]


@style.styled
def distribution(rows: Rows) -> Figure:
    """Shares of the rows up to each largest amplitude and deepest wear, with quantiles.

    A line for each value of the columns that are no seeds; bars: intervals of the quantiles.
    """
    drawn, panels = style.subplots(style.SINGLE, 4.0, 2, letters=True, sharey=True)
    groups = over_seeds.apart(table(rows), _no_seeds(rows))
    for axes, name in zip(panels, (LARGEST, DEEPEST), strict=True):
        for (values, frame), (_, color) in zip(groups, cycle(lines.LOOKS)):
            draws = frame[name].dropna()
            if not len(draws):
                continue
            said = [f"{key} {value}" for key, value in values.items()]
            axes.ecdf(draws, color=color, label=", ".join([*said, f"{len(draws)} draws"]))
            for share in over_seeds.SHARES:
                of = over_seeds.quantile(draws, share)
                enough = {} if of.draws >= of.draws_needed else {"markerfacecolor": "none"}
                axes.plot([of.low, of.high], [share, share], color=color, linewidth=2.5, alpha=0.4)
                axes.plot(of.value, share, "o", color=color, **enough)
        axes.set(xlabel=name, ylabel="share of the draws", ylim=(0, 1.02))
    style.legend(drawn, "lower center", title="bars: 95 % intervals; hollow: too few draws")
    return drawn


def draw(rows: Rows) -> Figure:
    """Largest amplitude and deepest wear of each row over each number that the design changes.

    Over the number of the row where it changes words alone. Rows of which a run ended otherwise
    than ok are marked; those that are refused are counted.
    """
    frame = table(rows).reset_index().sort_values("runs not ok", kind="stable")
    refused, bad = int((frame["runs"] == 0).sum()), frame["runs not ok"] > 0
    frame["ended"] = np.where(bad, "with runs not ok", "all runs ok")
    marked = "ended" if refused or bad.any() else ""
    keys = [name for name in frame if name in rows and frame[name].dtype.kind == "f"]
    records = frame.melt([LARGEST, DEEPEST, "ended"], keys or ["row"], value_name=VALUE)
    return lines.draw(
        records,
        VALUE,
        [LARGEST, DEEPEST],
        panel="variable",
        line=marked,
        labels={"ended": f"{len(frame)} rows, {refused} refused"},
        looks=[("o", style.BLACK), ("x", style.VERMILLION)],
    )


@style.styled
def sensitivity(rows: Rows) -> Figure:
    """One panel for each quantity: first-order and total indices with their intervals.

    ``rows``: the table of a design, by row.
    """
    sobol = indices(rows, [*QUANTITIES])
    drawn, panels = style.subplots(
        style.DOUBLE, 2.6, columns=len(QUANTITIES), letters=True, sharey=True
    )
    for i, (axes, title) in enumerate(zip(panels, QUANTITIES.values(), strict=True)):
        first, total = sobol.first_interval[:, i], sobol.total_interval[:, i]
        _bars(axes, -WIDTH / 2, sobol.first[i], first, color=style.BLUE, label="first order")
        _bars(axes, WIDTH / 2, sobol.total[i], total, color=style.VERMILLION, label="total")
        axes.set_xticks(range(len(sobol.factors)), sobol.factors)
        axes.set_title(title, loc="right")
        axes.axhline(0, color=style.BLACK, linewidth=0.6)
    panels[0].set_ylabel("share of the variance")
    not_ok = int((rows["not_ok"] > 0).sum())
    style.legend(
        drawn,
        "lower center",
        ncols=2,
        title=f"{rows.sizes['row']} rows, {not_ok} with runs not ok; lines: 95 % intervals",
    )
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
