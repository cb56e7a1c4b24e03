"""Engine orders in the figures of a sweep: crossings with f1 and peaks, marked the same way."""

import numpy as np
from matplotlib.axes import Axes

from simulate.observables import Peak
from workflow.figures import style
from workflow.figures.response import Response

CROSSINGS_AT, PEAKS_AT = 1.035, 1.15  # of the axes' height


def speed_text(response: Response, peak: Peak) -> str:
    """Critical speed; where the sweep ends on the rise, the bound that is known of it."""
    last = peak.index == len(response.speeds) - 1
    beyond = "" if not response.at_end(peak) else r"$\geq$ " if last else r"$\leq$ "
    return f"{beyond}{peak.Omega_c:.3f}"


def mark_speeds(axes: Axes, response: Response) -> None:
    """Mark in two rows above the axes where f1 meets engine orders, and the peaks seen."""
    peaks = response.peaks()
    if not peaks:
        return
    crossings = {peak.k: response.curve.crossing(peak.k) for peak in peaks}
    _row(axes, CROSSINGS_AT, "white", "crossing of $f_1$", crossings)
    _row(axes, PEAKS_AT, style.BLACK, "peak", {peak.k: peak.Omega_c for peak in peaks})


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
