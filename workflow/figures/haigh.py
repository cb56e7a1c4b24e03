"""Haigh diagram: mean and alternating stress at every speed, under the strength of the blade."""

from collections.abc import Mapping
from itertools import cycle
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem.fatigue import MEGA, allowed
from geometry.blade import Fatigue
from workflow.figures import style

POINTS = 401  # of the line
OFFSETS = ((-24, 0), (4, -7), (4, 3))  # of labels in turn, points of type: near peaks stay legible


@style.styled
def draw(stress: Mapping[str, Any], answers: Mapping[str, Any]) -> Figure:
    """(a) Under the whole line; (b) the stresses alone, peaks of ``answers`` with their order.

    ``stress``: as of ``stress.json``, whose worst node of each speed is a point.
    """
    fatigue = Fatigue.model_validate(stress["fatigue"])
    mean = np.linspace(-fatigue.yield_MPa, fatigue.ultimate_MPa, POINTS)
    mean = np.union1d(mean, [fatigue.endurance_MPa - fatigue.yield_MPa, 0.0])  # its corners
    known = {row["speed_over_f1"]: row for row in stress["speeds"] if "margin" in row}
    places = {
        at: (row["mean_stress"] / MEGA, row["alternating"] / MEGA) for at, row in known.items()
    }
    drawn, (whole, near) = style.subplots(style.DOUBLE, 2.8, 1, 2, letters=True)
    of_all = np.array([*places.values()]).reshape(-1, 2).T
    line = f"{fatigue.line.capitalize()} line, and yield"
    whole.plot(mean, allowed(MEGA * mean, fatigue) / MEGA, color=style.BLACK, label=line)
    for axes in (near, whole):
        axes.plot(*of_all, "o", color=style.GREY, markersize=2.5, label="each speed")
        axes.set(xlabel="mean stress (MPa)", ylabel="alternating stress (MPa)", ylim=(0, None))
    peaks = [peak for peak in answers["peaks"] if peak["k"] and peak["Omega_c"] in places]
    for peak, offset in zip(peaks, cycle(OFFSETS), strict=False):
        at = places[peak["Omega_c"]]
        near.plot(*at, "o", color=style.VERMILLION, markersize=3.5, label="peak")
        style.note(near, at, f"EO {peak['k']}", offset)
    style.legend(drawn, "lower center", ncols=3)
    least = min((row["margin"] for row in known.values()), default=np.inf)
    of = f"scene {stress['scene']}, blade {stress['blade']}"
    drawn.suptitle(f"{of}: least margin {least:.3g}", fontsize=8)
    return drawn
