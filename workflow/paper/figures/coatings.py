"""Peaks over the moduli E and K of the liner, Fig. 13."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from simulate.marching import SENSITIVE_FROM
from workflow.figures import cells, style
from workflow.paper.published import ENGINE_ORDER, WORST

NUMBERS = {  # values of a peak: label, digits after the point
    "amplitude": (rf"$\|Y\|$ {style.OVER_GAP}", 2),
    "Omega_c": (r"$\Omega_c/f_1(0)$", 3),
}
NO_PEAK, RISE, OF_PAPER = "-", "*", "\N{DAGGER}"
MARKS = (
    f"bold: largest amplitude;  {OF_PAPER}: largest in the paper;  in brackets: not predictable;\n"
    f"{RISE}: a sweep ends on the rise;  {NO_PEAK}: no run near a peak has a result"
)

type Case = dict[str, Any]


@style.styled
def peaks(grid: Case, order: int = ENGINE_ORDER) -> Figure:
    """Two maps, ||Y|| and Omega_c, with the case of the largest amplitude in bold.

    The paper's worst case, which is one of EO 4, is marked.
    """
    drawn, panels = style.subplots(style.DOUBLE, 4.4, 2, letters=True, sharex=True)
    cases = [case | {"peak": case["peaks"][str(order)]} for case in grid["cases"]]
    peaks_of_order = [case["peak"] for case in cases if case["peak"]]
    largest = max(peaks_of_order, key=lambda peak: peak["amplitude"], default=None)
    crossing = next((peak["Omega_c"] / peak["over_crossing"] for peak in peaks_of_order), np.nan)
    for axes, (name, (label, digits)) in zip(panels, NUMBERS.items(), strict=True):
        records = [
            case
            | {
                "number": case["peak"] and case["peak"][name],
                "text": _text(case, name, digits, order),
                "bold": case["peak"] is largest,
            }
            for case in cases
        ]
        image = cells.matrix(
            axes, records, "E", "K", "number", grid["E"], grid["K"][::-1], text="text", bold="bold"
        )
        drawn.colorbar(image, ax=axes, pad=0.01, aspect=15, ticks=MaxNLocator(5), label=label)
        axes.set_ylabel("plastic modulus $K$")
    panels[0].set_title(rf"amplitude of the peak of EO {order} at {style.PLACE}, {style.OVER_GAP}")
    panels[1].set(
        title=rf"its critical speed $\Omega_c/f_1(0)$; $f_1$ = {order}$\Omega$ at {crossing:.3f}",
        xlabel="Young modulus $E$, paper's unit",
    )
    drawn.supxlabel(MARKS, fontsize=7)
    return drawn


def _text(case: Case, name: str, digits: int, order: int) -> str:
    """A number of the peak of a case, with the ``MARKS`` that it has."""
    peak = case["peak"]
    if peak is None:
        return NO_PEAK
    is_worst_of_paper = order == ENGINE_ORDER and (case["E"], case["K"]) == tuple(WORST)
    marked = f"{peak[name]:.{digits}f}{RISE * peak['at_end']}{OF_PAPER * is_worst_of_paper}"
    return f"({marked})" if is_sensitive(peak) else marked


def is_sensitive(peak: Case) -> bool:
    """Whether a peak cannot be predicted: run and twin differ, or end differently (inf: null)."""
    if peak["departure"] is None:
        return peak["status"] == "sensitive"
    return peak["departure"] > SENSITIVE_FROM
