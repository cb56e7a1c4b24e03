"""Fig. 12: worn profiles of the paper's two coatings, each at its own k = 4 peak."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from workflow.figures import style
from workflow.figures.response import Response, read_response

ENGINE_ORDER = 4
LINES = (("-", style.BLACK), ("--", style.VERMILLION))  # E = 1, E = 10, dashed as in the paper


def load(files: Any) -> tuple[Response, ...]:
    """Read the scenes' sweeps, ``files.sweeps``, and the reduced model, ``files.rom``."""
    return tuple(read_response(sweep, files.rom) for sweep in files.sweeps)


@style.styled
def draw(*responses: Response) -> Figure:
    """Depth over casing angle, one line for each scene."""
    drawn = style.figure(style.SINGLE, 2.8)
    axes = drawn.subplots()
    for response, (dashes, colour) in zip(responses, LINES, strict=True):
        _profile(axes, response, linestyle=dashes, color=colour)
    _nearest(axes, responses[0])
    axes.set(xlabel=r"casing angle $\theta$ (deg)", ylabel=f"{style.WORN},\n{style.OVER_GAP}")
    axes.set(xlim=(0, 360), xticks=range(0, 361, 45))
    axes.set_ylim(bottom=0)
    drawn.legend(loc="outside upper center", ncols=1)
    return drawn


def _profile(axes: Axes, response: Response, **line: Any) -> None:
    """Draw the profile at the peak; a scene without one says so in the legend."""
    peak = response.peak(ENGINE_ORDER)
    if peak is None:
        axes.plot([], [], label=f"{response.label}:\nno speed near the peak", **line)
        return
    worn = response.wear[peak.index]
    theta = np.linspace(0, 360, len(worn) + 1)
    label = f"{response.label},\n" + rf"at $\Omega/f_1(0)$ {_at(response)}"
    axes.plot(theta, [*worn, worn[0]], label=label, **line)


def _at(response: Response) -> str:
    peak = response.peak(ENGINE_ORDER)
    end = ", still rising" if peak.at_end else ""
    chance = ", not predictable" if response.sensitive("wear")[peak.index] else ""
    return f"= {peak.Omega_c:.3f}{end}{chance}"


def _nearest(axes: Axes, response: Response) -> None:
    """Mark the angles at which the casing comes nearest."""
    inward = response.casing[:-1]
    peaks = (inward > np.roll(inward, 1)) & (inward >= np.roll(inward, -1))
    for i, theta in enumerate(np.flatnonzero(peaks)):
        label = "casing nearest" if i == 0 else None
        for at in {theta, 360 if theta == 0 else theta}:
            axes.axvline(at, color=style.GREY, linestyle=":", linewidth=0.8, label=label)
            label = None
