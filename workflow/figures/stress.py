"""Stress: alternating, on the blade at its worst speed; with the mean, in a Haigh diagram."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pyvista as pv
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from fem.fatigue import MEGA, allowed
from geometry.blade import Fatigue
from simulate.scene import GROWING
from simulate.sweeps.peak import Peak
from simulate.sweeps.result_types import order_name
from workflow import stress_told
from workflow.figures import rendering, style

LEVELS = 10  # of stress, few enough to read as contours
# Pressure side first: it faces the sense of rotation and downstream. Both from above the tip.
VIEWS = {"pressure side": (0.3, 1.0, 0.55), "suction side": (0.3, -1.0, -0.55)}
LIGHT = (1.0, 0.0)  # no shading: colours as in the colour bar
END = 0.005  # of the height, the part that counts as hub
POINTS = 401  # of the line of the Haigh diagram
NAMED = 4.0  # times the least margin, up to which peaks are named: others lie close together
FIELD = "alternating stress (Pa), "  # and the speed: a name in ``stress.vtu``


@style.styled
def draw(fields: rendering.Fields, stress: Mapping[str, Any]) -> Figure:
    """Both sides on one scale, with the summary's number at its place.

    ``fields`` is the blade of ``stress.vtu``, ``stress`` its names.
    """
    row = next((r for r in stress["speeds"] if r["speed_over_f1"] == stress["worst"]), None)
    heading, sigma, marked = "no motion with a result", np.zeros(fields.n_points), {}
    if row:
        rpm = f"{row['rpm']:.0f} rpm"
        sigma, place = fields[FIELD + rpm] / MEGA, np.array(row["at_m"])
        number = f"{stress_told.shown(row, 'alternating')} MPa"
        heading = f"{rpm}, worst of the speeds: {number}\n(anywhere {sigma.max():.3g} MPa)"
        marked = {number: place}
    levels = MaxNLocator(LEVELS).tick_values(0, max(sigma.max(), 1.0))
    look = style.MAP.resampled(len(levels) - 1), (levels[0], levels[-1]), LIGHT
    return rendering.gallery(
        fields,
        [(side, 0.0, sigma, view) for side, view in VIEWS.items()],  # on the undeformed blade
        look,
        style.SINGLE,
        corners(fields.points, stress["edges"]),
        f"scene {stress['scene']}, blade {stress['blade']}\n{heading}",
        marked={seen_from(fields, *marked.values()): marked} if marked else {},
        shrink=0.9,
        aspect=30,
        ticks=levels[::2],
        label="alternating stress, averaged at nodes (MPa)",
    )


def corners(
    points: NDArray[np.float64], edges: Mapping[str, NDArray[np.float64]]
) -> dict[str, NDArray[np.float64]]:
    """The ``edges`` of the tip, the middle of tip and hub, by name."""
    radius = np.hypot(points[:, 0], points[:, 1])
    hub = points[radius < radius.min() + END * np.ptp(radius)]
    at = {name: np.array(edge) for name, edge in edges.items()}
    return at | {"tip": np.mean([*at.values()], axis=0), "hub": hub.mean(axis=0)}


def seen_from(fields: pv.DataSet, place: NDArray[np.float64]) -> str:
    """The side from which a ``place`` (3,), m, on the surface is seen."""
    skin = fields.extract_surface(algorithm="dataset_surface").compute_normals()
    normal = skin.point_data["Normals"][skin.find_closest_point(place)]
    return max(VIEWS, key=lambda side: normal @ np.array(VIEWS[side]))


@style.styled
def haigh(stress: Mapping[str, Any], answers: Mapping[str, Any]) -> Figure:
    """Haigh diagram: mean and alternating stress at every speed, under the strength of the blade.

    (a) Under the whole line; (b) the stresses alone, peaks of ``answers`` with their order.
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
