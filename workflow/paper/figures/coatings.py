"""Peaks over the moduli E and K of the liner, Fig. 13, and what comes after twenty revolutions.

Growth of the worst coatings; 2000 revolutions of one, a run-up and run-down through its peak.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, MultipleLocator

from simulate.marching import SENSITIVE_FROM
from simulate.sweeps.peak import along_order
from workflow.figures import cells, lines, style
from workflow.figures.response import Response
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
WAYS = {  # through the peak: format and colour
    "from rest": ("-", style.BLACK),
    "run-up": ("--", style.VERMILLION),
    "run-down": ("-.", style.BLUE),
    "from rest, worn liner": (":", style.GREEN),
}
LABELS = {
    "amplitude": f"amplitude, EO {ENGINE_ORDER}, {style.OVER_GAP}",
    "wear": f"deepest wear {style.OVER_GAP}",
}
PAPER_ROUNDS = 20


@style.styled
def peaks(grid: dict[str, Any], order: int = ENGINE_ORDER) -> Figure:
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


def _text(case: dict[str, Any], name: str, digits: int, order: int) -> str:
    """A number of the peak of a case, with the ``MARKS`` that it has."""
    peak = case["peak"]
    if peak is None:
        return NO_PEAK
    is_worst_of_paper = order == ENGINE_ORDER and (case["E"], case["K"]) == tuple(WORST)
    marked = f"{peak[name]:.{digits}f}{RISE * peak['at_end']}{OF_PAPER * is_worst_of_paper}"
    # it cannot be predicted where run and twin differ, or end differently (inf: null)
    sensitive = (
        peak["status"] == "sensitive"
        if peak["departure"] is None
        else peak["departure"] > SENSITIVE_FROM
    )
    return f"({marked})" if sensitive else marked


@style.styled
def through_peak(
    long: Sequence[Response],
    rest: Response,
    run_up: Response,
    run_down: Response,
    on_worn: Response,
) -> Figure:
    """Amplitude over the revolutions, a line for each speed; amplitude and wear over the speed.

    Each of ``long`` goes on from the one before; the others are drawn from the first speed of the
    run-up.
    """
    drawn, panels = style.subplots(
        style.DOUBLE, 2.9, 1, 3, letters=True, width_ratios=(1, 1.25, 1.25)
    )
    rounds = np.cumsum([response.scene.rounds for response in long])
    after = [
        {"rounds": revolutions, "speed": f"{speed:.3f}", "amplitude": amplitude}
        for revolutions, response in zip(rounds, long, strict=True)
        for speed, amplitude in zip(
            response.speeds, along_order(response.sweep, ENGINE_ORDER), strict=True
        )
    ]
    lines.curves(panels[0], after, "rounds", "amplitude", "speed", markerfacecolor="white")
    panels[0].set(xscale="log", xlabel="revolutions", ylabel=LABELS["amplitude"], ylim=(0, None))
    panels[0].set_xticks(rounds, rounds)
    panels[0].minorticks_off()
    drawn.legend(
        handles=panels[0].get_lines(),
        title=r"(a) $\Omega/f_1(0)$",
        loc="outside lower left",
        ncols=3,
        handlelength=2.2,
    )
    through = [
        {"way": way, "speed": speed, "amplitude": amplitude, "wear": wear.max()}
        for way, response in zip(WAYS, (rest, run_up, run_down, on_worn), strict=True)
        for speed, amplitude, wear in zip(
            response.speeds, along_order(response.sweep, ENGINE_ORDER), response.wear, strict=True
        )
        if speed >= run_up.speeds[0]
    ]
    for axes, name in zip(panels[1:], LABELS, strict=True):
        lines.curves(axes, through, "speed", name, "way", looks=[*WAYS.values()])
        axes.set(xlabel=style.SPEED_LABEL, ylabel=LABELS[name], ylim=(0, None))
    drawn.legend(handles=panels[1].get_lines(), loc="outside lower right", ncols=2)
    return drawn


@style.styled
def growth(worst: dict[str, Any]) -> Figure:
    """Amplitude over successive windows of ten revolutions, and that of the bare rigid casing."""
    by_name = {
        f"{case['name']}: $E$ = {case['E']:g}, $K$ = {case['K']:g}": case for case in worst["cases"]
    }
    rigid = worst["rigid"] | {
        "rounds": [0, max(case["rounds"][-1] for case in worst["cases"])],
        "amplitude": [worst["rigid"]["amplitude"]] * 2,
    }
    records = [
        {"rounds": revolutions, "amplitude": amplitude, "case": f"{name},{_end(case)}"}
        for name, case in (by_name | {"bare rigid casing": rigid}).items()
        for revolutions, amplitude in zip(case["rounds"], case["amplitude"], strict=True)
    ]
    drawn = lines.draw(
        records,
        "rounds",
        "amplitude",
        line="case",
        labels={
            "rounds": "revolutions, end of a window of ten",
            "amplitude": rf"$\|Y\|$ at {style.PLACE}, {style.OVER_GAP}",
        },
    )
    (axes,) = drawn.axes
    axes.margins(0.03, 0.15)
    axes.set(xlim=(0, None), ylim=(0, None))
    axes.xaxis.set_major_locator(MultipleLocator(2 * PAPER_ROUNDS))
    axes.axvline(PAPER_ROUNDS, color=style.GREY, linewidth=0.6, zorder=0)
    style.note(
        axes,
        (PAPER_ROUNDS, 0.03),
        "end of the paper's runs",
        (3, 0),
        xycoords=axes.get_xaxis_transform(),
    )
    return drawn


def _end(case: dict[str, Any]) -> str:
    ends = "" if case["status"] == "ok" else f", {case['status']}"
    return rf" $\Omega_c/f_1(0)$ = {case['Omega_c']:.3f}{ends}"
