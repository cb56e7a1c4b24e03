"""Error of a mesh: frequencies of a blade over the size of its elements, as table and figure.

Rows are those of experiments with ``frequencies.numbers``.

The error is from extrapolated limits of the frequencies and of the tip deflection: Celik,
Ghia, Roache and others (2008), Procedure for estimation and reporting of uncertainty due to
discretization, J. Fluids Eng. 130: an order p observed on the three finest sizes, Richardson's
limit from the two finest, and a band of 1.25 times the difference of the finest from the limit. On
unstructured meshes the orders of single frequencies scatter, so one order is fitted to all. In the
limit the clamp determines it: at a clamped edge of 90 degrees stress grows as r^-0.3 (Williams,
1952), which gives frequencies an order of 1.4.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator, StrMethodFormatter
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize_scalar

from workflow import markdown
from workflow.figures import style
from workflow.many.row import ComputedRow
from workflow.many.table import Whole

ORDERS = (0.5, 4.0)  # range of the order; at most 4 for frequencies of quadratic elements
SAFETY = 1.25  # factor of Celik and others, for three sizes and an observed order
OWN = "own size"  # row of the blade itself
MARKERS = [*"os^vD<>pPX"]  # one for each mode


def numbers(rows: Sequence[ComputedRow]) -> dict[str, Any]:
    """Limits, and the errors of every size against them.

    ``rows``: of an experiment with ``frequencies.numbers``, from coarse to fine; that of the
    blade's own size is named so.
    """
    levels = [row["numbers"] for row in rows]
    sizes = [level["element_size_mm"] for level in levels]
    quantities = {
        "at_rest_Hz": np.array([level["frequencies_Hz"][0] for level in levels]),
        "at_Omega_m_Hz": np.array([level["frequencies_Hz"][-1] for level in levels]),
        "tip_deflection_m": np.array([[level["tip_deflection_m"]] for level in levels]),
    }
    frequencies = np.hstack([quantities["at_rest_Hz"], quantities["at_Omega_m_Hz"]])
    order = common_order(sizes[-3:], frequencies[-3:])
    return {
        "element_size_mm": sizes,
        "own": [row["row"] for row in rows].index(OWN),
        "nodes": [level["nodes"] for level in levels],
        "order": order,
    } | {key: _against_limit(sizes, values, order) for key, values in quantities.items()}


def common_order(sizes: ArrayLike, values: ArrayLike) -> float:
    """Order p of the best fit of limit + slope size^p to values (sizes, quantities).

    Least squares of relative errors over all quantities, each with its own limit and slope.
    """
    sizes, values = np.asarray(sizes, dtype=float), np.asarray(values, dtype=float)

    def misfit(p: float) -> float:
        """Sum of squares that the best limit and slope of order ``p`` leave."""
        A = np.column_stack([np.ones_like(sizes), (sizes / sizes[-1]) ** p])
        residual = values / values[-1] - A @ np.linalg.lstsq(A, values / values[-1])[0]
        return float((residual**2).sum())

    return float(minimize_scalar(misfit, bounds=ORDERS, method="bounded").x)


def limits(sizes: ArrayLike, values: ArrayLike, order: float) -> NDArray[np.float64]:
    """Richardson's limit (quantities,) of values (sizes, quantities) from the two finest sizes."""
    coarse, fine = np.asarray(values, dtype=float)[-2:]
    ratio = sizes[-2] / sizes[-1]
    return fine + (fine - coarse) / (ratio**order - 1)


def _against_limit(sizes: list[float], values: NDArray[np.float64], order: float) -> dict[str, Any]:
    limit = limits(sizes, values, order)
    error = values / limit - 1
    return {
        "limit": limit.tolist(),
        "error": error.tolist(),  # (sizes, quantities), relative to the limit
        "band": (SAFETY * abs(error[-1])).tolist(),  # of the limit, relative
    }


def table(rows: Sequence[ComputedRow]) -> str:
    """Markdown: sizes, and a table with the errors of the blade's own size for each mode."""
    study = numbers(rows)
    sizes, nodes, index = study["element_size_mm"], study["nodes"], study["own"]
    pairs = ", ".join(f"{h:.2f} mm ({n:,} nodes)" for h, n in zip(sizes, nodes, strict=True))
    rest, speed, tip = study["at_rest_Hz"], study["at_Omega_m_Hz"], study["tip_deflection_m"]
    modes = range(len(rest["limit"]))
    errors = [[m + 1, *_cells(rest, m, index), *_cells(speed, m, index)] for m in modes]
    return "\n".join(
        [
            f"Sizes {pairs}; observed order {study['order']:.2f}. The blade's own size is "
            f"{sizes[index]:.2f} mm:",
            "",
            markdown.table(
                ["mode", "limit at rest, Hz", "error, %", "limit at Ω_m, Hz", "error, %"], errors
            ),
            "",
            "Deflection of the tip at 1/16 of the chord at Ω_m: limit "
            f"{1e3 * tip['limit'][0]:.4f} mm, error {_error(tip, 0, index)} %.",
        ]
    )


def _cells(quantity: Mapping[str, Any], m: int, index: int) -> tuple[str, str]:
    return f"{quantity['limit'][m]:.2f}", _error(quantity, m, index)


def _error(quantity: Mapping[str, Any], m: int, index: int) -> str:
    """Error of the blade's own size, and the band of the limit, %."""
    return f"{100 * quantity['error'][index][m]:+.2f} ± {100 * quantity['band'][m]:.2f}"


@style.styled
def draw(study: Whole) -> Figure:
    """Errors against the limit, one line for each mode at rest and one for the tip deflection.

    ``study``: rows of the experiment.
    """
    study = numbers(study)
    drawn, axes = style.subplots(style.SINGLE, 3.1)
    sizes = np.array(study["element_size_mm"])
    frequencies = 100 * np.abs(study["at_rest_Hz"]["error"])
    tip = 100 * np.abs(study["tip_deflection_m"]["error"])[:, 0]
    axes.set_prop_cycle(color=style.MAP(np.linspace(0.25, 0.95, len(MARKERS))), marker=MARKERS)
    modes = [f"mode {m}" for m in range(1, frequencies.shape[1] + 1)]
    axes.plot(sizes, frequencies, lw=0.7, label=modes)
    axes.plot(sizes, tip, "o--", color=style.BLUE, markerfacecolor="white", label="tip deflection")
    _slope(axes, sizes, study["order"], frequencies.max())
    size_of_blade = sizes[study["own"]]
    axes.axvline(size_of_blade, color=style.GREY, linewidth=0.6, linestyle=":", label="own size")
    axes.set(xscale="log", yscale="log", xlabel="element size, mm", ylabel="error, %")
    axes.set_xticks(sizes, [f"{size:.2f}" for size in sizes])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    _nodes(axes, sizes, study["nodes"])
    drawn.legend(loc="outside lower center", ncols=4, handlelength=1.6, columnspacing=1.0)
    return drawn


def _slope(axes: Axes, sizes: NDArray[np.float64], order: float, top: float) -> None:
    """Draw the slope of the common order above all errors."""
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
    """Write the number of nodes of each mesh along the top."""
    top = axes.secondary_xaxis("top")
    top.set_xticks(sizes, [f"{n:,}" for n in nodes])
    top.xaxis.set_minor_locator(NullLocator())
    top.set_xlabel("nodes")
