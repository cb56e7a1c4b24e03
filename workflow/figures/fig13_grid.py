"""Fig. 13: amplitude and critical speed of a peak over the moduli E and K of the liner."""

import numpy as np
from matplotlib.figure import Figure

from workflow.figures import style
from workflow.figures.heat_map import Case, by_cell, explain, fill, heat_map, marks_of, ring, square
from workflow.paper.cases import WORST

NUMBERS = {  # values of a peak: label, digits after the point
    "amplitude": (rf"$\|Y\|$ {style.OVER_GAP}", 2),
    "Omega_c": (r"$\Omega_c/f_1(0)$", 3),
}
PRINTED = 4  # engine order of the paper's worst case


@style.styled
def draw(grid: Case, order: int = 4) -> Figure:
    """Two maps, ||Y|| and Omega_c; the case of the largest amplitude is ringed in both.

    The first marks the paper's worst case, which is one of k = 4.
    """
    drawn, panels = style.subplots(style.DOUBLE, 4.6, 2, letters=True, sharex=True)
    cases = by_cell(grid, "E", "K")
    peaks = {cell: case["peaks"][str(order)] for cell, case in cases.items()}
    seen = {cell: peak for cell, peak in peaks.items() if peak}
    marks = {cell: marks_of(peak) for cell, peak in peaks.items()}
    for axes, (name, (label, digits)) in zip(panels, NUMBERS.items(), strict=True):
        numbers = {cell: peak and peak[name] for cell, peak in peaks.items()}
        heat_map(axes, grid["E"], grid["K"], numbers, label=label)
        fill(axes, numbers, marks, digits)
        axes.set_ylabel("plastic modulus $K$")
        if seen:
            ring(axes, max(seen, key=lambda cell: seen[cell]["amplitude"]))
    top, bottom = panels
    at = grid["K"].index(WORST[1]), grid["E"].index(WORST[0])
    paper = [square(top, at, "largest in the paper")] if order == PRINTED else []
    top.set_title(rf"amplitude of the peak $k$ = {order} at {style.PLACE}, {style.OVER_GAP}")
    crossing = next((peak["Omega_c"] / peak["over_crossing"] for peak in seen.values()), np.nan)
    bottom.set(
        title=rf"its critical speed $\Omega_c/f_1(0)$; $f_1$ = {order}$\Omega$ at {crossing:.3f}",
        xlabel="Young modulus $E$, paper's unit",
    )
    explain(drawn, "largest amplitude", marks, *paper)
    return drawn
