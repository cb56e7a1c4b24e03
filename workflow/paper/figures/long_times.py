"""Long times: 2000 revolutions, a run-up and run-down through a peak, growth of the worst."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from simulate.sweeps.peak import along_order
from workflow.figures import lines, style
from workflow.figures.response import Response
from workflow.paper.published import ENGINE_ORDER

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
