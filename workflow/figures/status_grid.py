"""Predictability over E and K: share of runs that end ok, and twin runs at the peaks."""

from collections import Counter
from typing import Any

from matplotlib.figure import Figure

from workflow.figures import cells, style
from workflow.figures.fig13_grid import COATINGS, Case, is_sensitive

STATES = {  # of a peak: its mark
    "predictable": "\N{BLACK CIRCLE}",
    "sensitive": "\N{WHITE DIAMOND}",
    "no twin was marched": "\N{WHITE CIRCLE}",
    "no run near it has a result": "x",
}


@style.styled
def draw(grid: Case) -> Figure:
    """Share of the runs that are ok, and below it the state of the peak of each engine order."""
    cases = sorted(grid["cases"], key=lambda case: (-case["K"], case["E"]))
    states = ", ".join(f"{mark} {state}" for state, mark in STATES.items())
    orders = " and ".join(map(str, grid["orders"]))
    said = f"share of runs that are not ok (%)\npeaks $k$ = {orders}: {states}"
    look = {"text": "text", "labels": COATINGS | {"not ok": said}, "limits": (0, 100)}
    drawn = cells.draw([case | _cell(case) for case in cases], "E", "K", "not ok", **look)
    drawn.axes[0].set_title(_totals(grid))
    return drawn


def state_of(peak: Case | None) -> str:
    """State of a peak, a key of ``STATES``."""
    if peak is None:
        return "no run near it has a result"
    states = {None: "no twin was marched", True: "sensitive", False: "predictable"}
    return states[is_sensitive(peak)]


def _cell(case: Case) -> dict[str, Any]:
    """Share of the runs in percent, and the peaks of a case."""
    ok = 100 * case["statuses"].get("ok", 0) / case["runs"]
    marks = (f"{order} {STATES[state_of(peak)]}" for order, peak in case["peaks"].items())
    return {"not ok": 100 - ok, "text": f"{ok:.0f} % ok\n{'   '.join(marks)}"}


def _totals(grid: Case) -> str:
    """Number of runs by status, and which of them have twins."""
    ends = sum((Counter(case["statuses"]) for case in grid["cases"]), Counter())
    listed = ", ".join(f"{count:,} {word}" for word, count in ends.most_common())
    return f"{ends.total():,} runs: {listed}; twins at the peaks alone"
