"""What the figures of a sweep mark the same way: engine orders, peaks, runs not to be trusted."""

from collections import Counter
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from simulate.peaks import Peak
from simulate.twin import GAP_CHANGE, SENSITIVE_FROM
from workflow.figures import style
from workflow.figures.response import Response

CROSSINGS_AT, PEAKS_AT = 1.035, 1.15  # of the axes' height
NO_RESULT, NOT_PREDICTABLE = "/////", "\\\\\\\\\\"  # hatches


def speed_text(response: Response, peak: Peak) -> str:
    """Critical speed; where the sweep ends on the rise, the bound that is known of it."""
    last = peak.index == len(response.speeds) - 1
    beyond = "" if not peak.at_end else r"$\geq$ " if last else r"$\leq$ "
    return f"{beyond}{peak.Omega_c:.3f}"


def mark_speeds(axes: Axes, response: Response) -> None:
    """Mark in two rows above the axes where f1 meets engine orders, and the peaks seen."""
    peaks = response.peaks
    if not peaks:
        return
    crossings = {peak.k: peak.crossing for peak in peaks}
    _row(axes, CROSSINGS_AT, "white", "crossing of $f_1$", crossings)
    _row(axes, PEAKS_AT, style.BLACK, "peak", {peak.k: peak.Omega_c for peak in peaks})


def hatch(drawn: Figure, panels: Sequence[Axes], response: Response, observable: str) -> None:
    """Hatch speeds without a result, and those where ``observable`` cannot be predicted.

    Below the figure a legend says what is hatched, if anything is.
    """
    looks = (
        (~response.has_result, {"facecolor": "white", "hatch": NO_RESULT}, _ends(response)),
        (
            response.sensitive(observable),
            {"facecolor": "none", "hatch": NOT_PREDICTABLE},
            _not_predictable(observable),
        ),
    )
    for which, look, label in looks:
        for axes in panels:
            style.hatch(axes, response.speeds, which, label=label, **look)
    hatched = [patch for patch in panels[0].patches if not patch.get_label().startswith("_")]
    if hatched:
        sizes = {"handlelength": 3.0, "handleheight": 1.4}
        drawn.legend(handles=hatched, loc="outside lower left", **sizes)


def _ends(response: Response) -> str:
    """How the runs without a result ended."""
    ends = Counter(response.status[~response.has_result].tolist())
    return "not ok: " + ", ".join(f"{word} ({n})" for word, n in ends.items())


def _not_predictable(observable: str) -> str:
    digits, share = -np.log10(GAP_CHANGE), 100 * SENSITIVE_FROM
    return (
        f"not predictable: all gaps changed by one part in $10^{{{digits:.0f}}}$ move the "
        f"{observable} by over {share:g} %"
    )


def _row(axes: Axes, height: float, face: str, title: str, speeds: dict[int, float]) -> None:
    """Draw a triangle and k at the speed of each engine order, the row's title at the left."""
    across = axes.get_xaxis_transform()
    axes.text(0.005, height, f"{title}, $k$ =", transform=axes.transAxes, fontsize=7, va="center")
    shown = {k: speed for k, speed in speeds.items() if np.isfinite(speed)}
    axes.plot(
        list(shown.values()),
        [height] * len(shown),
        "v",
        transform=across,
        clip_on=False,
        color=style.BLACK,
        markerfacecolor=face,
        markersize=4,
        label=title,
    )
    for k, speed in shown.items():
        axes.annotate(
            str(k),
            (speed, height),
            (0, 3.5),
            xycoords=across,
            textcoords="offset points",
            ha="center",
            fontsize=7,
            annotation_clip=False,
        )
