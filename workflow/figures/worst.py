"""Amplitude of the worst cases over 200 rounds: whether it still grows."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from workflow.figures import style

LOOKS = (("o-", style.BLACK), ("s--", style.VERMILLION))
PAPER_ROUNDS = 20


@style.styled
def draw(worst: dict[str, Any]) -> Figure:
    """Amplitude over successive windows of ten rounds, and that of the bare rigid casing."""
    drawn, axes = style.subplots(style.SINGLE, 3.1)
    for case, (line, colour) in zip(worst["cases"], LOOKS, strict=True):
        amplitude = np.array(case["amplitude"], dtype=float)  # nan for a window not marched
        label = f"{case['name']}: $E$ = {case['E']:g}, $K$ = {case['K']:g},{_at(case)}"
        axes.plot(case["rounds"], amplitude, line, color=colour, label=label)
    rigid = worst["rigid"]
    look = {"color": style.GREY, "linestyle": ":", "linewidth": 1.4}
    axes.axhline(rigid["amplitude"], label=f"bare rigid casing,{_at(rigid)}", **look)
    axes.margins(0.03, 0.15)
    axes.set(
        xlabel="rounds, end of a window of ten",
        ylabel=rf"$\|Y\|$ at {style.PLACE}, {style.OVER_GAP}",
        xlim=(0, None),
        ylim=(0, None),
    )
    axes.xaxis.set_major_locator(MultipleLocator(PAPER_ROUNDS))
    axes.axvline(PAPER_ROUNDS, color=style.GREY, linewidth=0.6, zorder=0)
    at = axes.get_xaxis_transform()
    style.note(axes, (PAPER_ROUNDS, 0.03), "end of the paper's runs", (3, 0), xycoords=at)
    drawn.legend(loc="outside upper center", ncols=1, handlelength=2.8)
    return drawn


def _at(case: dict[str, Any]) -> str:
    ends = "" if case["status"] == "ok" else f", {case['status']}"
    return rf" $\Omega_c/f_1(0)$ = {case['Omega_c']:.3f}{ends}"
