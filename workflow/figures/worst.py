"""Amplitude of the worst cases over 200 rounds: whether it still grows."""

from typing import Any

from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from workflow.figures import lines, style

LABELS = {
    "rounds": "rounds, end of a window of ten",
    "amplitude": rf"$\|Y\|$ at {style.PLACE}, {style.OVER_GAP}",
}
PAPER_ROUNDS = 20


@style.styled
def draw(worst: dict[str, Any]) -> Figure:
    """Amplitude over successive windows of ten rounds, and that of the bare rigid casing."""
    of = {
        f"{case['name']}: $E$ = {case['E']:g}, $K$ = {case['K']:g}": case for case in worst["cases"]
    }
    rounds = [0, max(case["rounds"][-1] for case in worst["cases"])]
    rigid = worst["rigid"] | {"rounds": rounds, "amplitude": [worst["rigid"]["amplitude"]] * 2}
    records = [
        {"rounds": at, "amplitude": amplitude, "case": f"{name},{_at(case)}"}
        for name, case in (of | {"bare rigid casing": rigid}).items()
        for at, amplitude in zip(case["rounds"], case["amplitude"], strict=True)
    ]
    drawn = lines.draw(records, "rounds", "amplitude", line="case", labels=LABELS)
    (axes,) = drawn.axes
    axes.margins(0.03, 0.15)
    axes.set(xlim=(0, None), ylim=(0, None))
    axes.xaxis.set_major_locator(MultipleLocator(2 * PAPER_ROUNDS))
    axes.axvline(PAPER_ROUNDS, color=style.GREY, linewidth=0.6, zorder=0)
    at = axes.get_xaxis_transform()
    style.note(axes, (PAPER_ROUNDS, 0.03), "end of the paper's runs", (3, 0), xycoords=at)
    return drawn


def _at(case: dict[str, Any]) -> str:
    ends = "" if case["status"] == "ok" else f", {case['status']}"
    return rf" $\Omega_c/f_1(0)$ = {case['Omega_c']:.3f}{ends}"
