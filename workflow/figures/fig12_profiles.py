"""Fig. 12: worn profiles of the paper's two coatings, each at its own k = 4 peak."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.signal import find_peaks

from simulate.errors.signals import leading_gap
from workflow.figures import style
from workflow.figures.marks import over_casing, speed_text
from workflow.figures.response import Response

ENGINE_ORDER = 4
LINES = (("-", style.BLACK), ("--", style.VERMILLION))  # E = 1, E = 10, dashed as in the paper
DEGREES = np.arange(-1, 362)  # one degree beyond 0 and 360: maxima may lie there


def load(files: Any) -> tuple[Response, ...]:
    """Read the scenes' sweeps, ``files.sweeps``, and the reduced model, ``files.rom``."""
    return tuple(Response.read(sweep, files.rom) for sweep in files.sweeps)


@style.styled
def draw(*responses: Response) -> Figure:
    """Depth over casing angle, one line for each scene."""
    drawn, axes = style.subplots(style.SINGLE, 2.6)
    names = apart([response.label for response in responses])
    for response, name, (dashes, colour) in zip(responses, names, LINES, strict=True):
        _profile(axes, response, name, linestyle=dashes, color=colour)
    _nearest(axes, responses[0])
    axes.set(ylabel=f"{style.WORN},\n{style.OVER_GAP}", ylim=(0, None))
    drawn.legend(loc="outside upper center", ncols=1)
    return drawn


def apart(labels: Sequence[str]) -> list[str]:
    """Labels without the parts, between commas, that all have; equal ones whole."""
    parts = [label.split(", ") for label in labels]
    common = set.intersection(*map(set, parts))
    alone = [", ".join(part for part in of if part not in common) for of in parts]
    return alone if any(alone) else list(labels)


def _profile(axes: Axes, response: Response, name: str, **line: Any) -> None:
    """Draw the profile at the peak; without a peak, the legend says so."""
    peak = response.by_order.get(ENGINE_ORDER)
    if peak is None:
        axes.plot([], [], label=f"{name}: no speed near the peak", **line)
        return
    chance = ", not predictable" if response.sensitive("wear")[peak.index] else ""
    at = rf"at $\Omega/f_1(0)$: {speed_text(response, peak)}{chance}"
    over_casing(axes, response.wear[peak.index], label=f"{name}, {at}", **line)


def _nearest(axes: Axes, response: Response) -> None:
    """Mark the angles at which the casing is closest to the blade."""
    inward = response.scene.casing.inward(np.radians(DEGREES), leading_gap(response.sweep))
    nearest = DEGREES[find_peaks(inward)[0]]
    look = {"color": style.GREY, "linestyle": ":", "linewidth": 0.8, "label": "casing nearest"}
    axes.vlines(nearest, 0, 1, transform=axes.get_xaxis_transform(), **look)
