"""The worst cases over 200 rounds: whether their amplitude goes on growing."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from geometry.files import read_json
from workflow.figures import style

LOOKS = (("o-", style.BLACK), ("s--", style.VERMILLION))
HEADROOM = 1.15  # of the largest amplitude: the top of the axes
PAPER_ROUNDS = 20


def load(files: Any) -> tuple[dict[str, Any]]:
    """Read the cases, ``files.worst``."""
    return (read_json(files.worst),)


@style.styled
def draw(worst: dict[str, Any]) -> Figure:
    """Amplitude over successive windows of ten rounds, and that of the bare rigid casing."""
    drawn = style.figure(style.SINGLE, 3.1)
    axes = drawn.subplots()
    rigid = worst["rigid"]
    tops = [rigid["amplitude"]]
    for case, (line, colour) in zip(worst["cases"], LOOKS, strict=True):
        tops.append(_case(axes, case, line, colour))
    axes.axhline(
        rigid["amplitude"],
        color=style.GREY,
        linestyle=":",
        linewidth=1.4,
        label=f"bare rigid casing,{_at(rigid)}",
    )
    axes.set(
        xlabel="rounds, end of a window of ten",
        ylabel=rf"$\|Y\|$ at {style.PLACE}, {style.OVER_GAP}",
    )
    rounds = [r for case in worst["cases"] for r in case["rounds"]]
    axes.set(xlim=(0, 1.03 * max(rounds)), ylim=(0, HEADROOM * max(tops)))
    axes.xaxis.set_major_locator(MultipleLocator(PAPER_ROUNDS))
    axes.axvline(PAPER_ROUNDS, color=style.GREY, linewidth=0.6, zorder=0)
    axes.annotate(
        "end of the paper's runs",
        (PAPER_ROUNDS, 0.03),
        (3, 0),
        xycoords=axes.get_xaxis_transform(),
        textcoords="offset points",
        fontsize=7,
    )
    drawn.legend(loc="outside upper center", ncols=1, handlelength=2.8)
    return drawn


def _case(axes: Axes, case: dict[str, Any], line: str, colour: str) -> float:
    """Draw one case; returns its largest amplitude. A window that was not marched has no point."""
    amplitude = np.array(case["amplitude"], dtype=float)  # null becomes nan
    label = f"{case['name']}: $E$ = {case['E']:g}, $K$ = {case['K']:g},{_at(case)}"
    axes.plot(case["rounds"], amplitude, line, color=colour, label=label)
    return float(np.nanmax(amplitude, initial=0.0))


def _at(case: dict[str, Any]) -> str:
    ends = "" if case["status"] == "ok" else f", {case['status']}"
    return rf" $\Omega_c/f_1(0)$ = {case['Omega_c']:.3f}{ends}"
