"""Fig. 13: amplitude and critical speed of a peak over the moduli E and K of the liner."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from simulate.marching import SENSITIVE_FROM
from workflow.figures import style
from workflow.figures.cells import matrix
from workflow.paper.cases import WORST

NUMBERS = {  # values of a peak: label, digits after the point
    "amplitude": (rf"$\|Y\|$ {style.OVER_GAP}", 2),
    "Omega_c": (r"$\Omega_c/f_1(0)$", 3),
}
COATINGS = {"E": "Young modulus $E$, paper's unit", "K": "plastic modulus $K$"}
PRINTED = 4  # engine order of the paper's worst case
NO_PEAK, RISE, OF_PAPER = "-", "*", "\N{DAGGER}"
MARKS = (
    f"bold: largest amplitude;  {OF_PAPER}: largest in the paper;  in brackets: not predictable;\n"
    f"{RISE}: a sweep ends on the rise;  {NO_PEAK}: no run near a peak has a result"
)

type Case = dict[str, Any]


@style.styled
def draw(grid: Case, order: int = 4) -> Figure:
    """Two maps, ||Y|| and Omega_c, with the case of the largest amplitude in bold.

    The paper's worst case, which is one of k = 4, is marked.
    """
    drawn, panels = style.subplots(style.DOUBLE, 4.4, 2, letters=True, sharex=True)
    cases = [case | {"peak": case["peaks"][str(order)]} for case in grid["cases"]]
    peaks = [case["peak"] for case in cases if case["peak"]]
    largest = max(peaks, key=lambda peak: peak["amplitude"], default=None)
    crossing = next((peak["Omega_c"] / peak["over_crossing"] for peak in peaks), np.nan)
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
        rows = grid["K"][::-1]
        image = matrix(axes, records, "E", "K", "number", grid["E"], rows, text="text", bold="bold")
        drawn.colorbar(image, ax=axes, pad=0.01, aspect=15, ticks=MaxNLocator(5), label=label)
        axes.set_ylabel(COATINGS["K"])
    panels[0].set_title(rf"amplitude of the peak $k$ = {order} at {style.PLACE}, {style.OVER_GAP}")
    said = rf"its critical speed $\Omega_c/f_1(0)$; $f_1$ = {order}$\Omega$ at {crossing:.3f}"
    panels[1].set(title=said, xlabel=COATINGS["E"])
    drawn.supxlabel(MARKS, fontsize=7)
    return drawn


def is_sensitive(peak: Case) -> bool | None:
    """Whether the peak's spectrum cannot be predicted; None where no twin was marched.

    JSON has no inf: where run and twin end differently, the departure is None and the status is
    `sensitive`.
    """
    if peak["departure"] is None:
        return True if peak["status"] == "sensitive" else None
    return peak["departure"] > SENSITIVE_FROM


def _text(case: Case, name: str, digits: int, order: int) -> str:
    """A number of the peak of a case, with the ``MARKS`` that it has."""
    peak = case["peak"]
    if peak is None:
        return NO_PEAK
    of_paper = order == PRINTED and (case["E"], case["K"]) == tuple(WORST)
    marked = f"{peak[name]:.{digits}f}{RISE * peak['at_end']}{OF_PAPER * of_paper}"
    return f"({marked})" if is_sensitive(peak) else marked
