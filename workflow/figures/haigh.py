"""Haigh diagram: mean and alternating stress at every speed, under the strength of the blade."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem.fatigue import MEGA, allowed
from geometry.blade import Fatigue
from simulate.scene import GROWING
from simulate.sweeps.peak import Peak
from simulate.sweeps.result_types import order_name
from workflow import stress_told
from workflow.figures import style

POINTS = 401  # of the line
NAMED = 4.0  # times the least margin, up to which peaks are named: others lie close together


@style.styled
def draw(stress: Mapping[str, Any], answers: Mapping[str, Any]) -> Figure:
    """(a) Under the whole line; (b) the stresses alone, peaks of ``answers`` with their order.

    ``stress``: as of ``stress.json``, whose worst node of each speed is a point.
    """
    fatigue = Fatigue.model_validate(stress["fatigue"])
    mean = np.union1d(  # with the corners of the line
        np.linspace(-fatigue.yield_MPa, fatigue.ultimate_MPa, POINTS),
        [fatigue.endurance_MPa - fatigue.yield_MPa, 0.0],
    )
    rows = {row["speed_over_f1"]: row for row in stress["speeds"] if "margin" in row}
    places = {
        speed: (row["mean_stress"] / MEGA, row["alternating"] / MEGA) for speed, row in rows.items()
    }
    drawn, (whole, near) = style.subplots(style.DOUBLE, 2.8, 1, 2, letters=True)
    stresses = np.array([*places.values()]).reshape(-1, 2).T
    grow = np.array([row["trend"] == GROWING for row in rows.values()], bool)
    whole.plot(
        mean,
        allowed(MEGA * mean, fatigue) / MEGA,
        color=style.BLACK,
        label=f"{fatigue.line.capitalize()} line, and yield",
    )
    for axes in (near, whole):
        axes.plot(*stresses[:, ~grow], "o", color=style.GREY, markersize=2.5, label="each speed")
        if grow.any():
            look = {"color": style.GREY, "markersize": 3.5, "label": "still grows: at least"}
            axes.plot(*stresses[:, grow], "^", **look)
        axes.margins(0.12)  # for the names of peaks
        axes.set(xlabel="mean stress (MPa)", ylabel="alternating stress (MPa)", ylim=(0, None))
    least = min((row["margin"] for row in rows.values()), default=np.inf)
    peaks = (Peak.of(peak) for peak in answers["peaks"])
    for peak in (peak for peak in peaks if peak.k and peak.Omega_c in rows):
        place = places[peak.Omega_c]
        near.plot(*place, "o", color=style.VERMILLION, markersize=3.5, label="peak")
        if rows[peak.Omega_c]["margin"] < NAMED * least:
            style.note(near, place, order_name(peak.k), (4, 3))
    style.legend(drawn, "lower center", ncols=3)
    at_most = " at most" * bool(grow.any())
    drawn.suptitle(
        f"scene {stress['scene']}, blade {stress['blade']}: least margin of {len(rows)} of "
        f"{len(stress['speeds'])} speeds {least:.3g}{at_most}\n{stress_told.where(stress)}",
        fontsize=8,
    )
    return drawn
