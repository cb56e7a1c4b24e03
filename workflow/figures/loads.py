"""Over the speed, in units of engines: force, torque, worn volume and stress; the gap."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rom.model import Rom
from simulate.contact.gaps import given_gaps
from simulate.errors.schema import of_peaks
from simulate.loads import mean_force, mean_opening, torque, worn_volume
from simulate.scene import LEADING, TRAILING
from simulate.signals import gaps_at_ends
from simulate.sweeps.peak import Peak
from workflow.figures import style, units
from workflow.figures.annotations import NO_LINES, operating_lines
from workflow.figures.response import Response

LOOKS = (  # of scenes, or of places on the chord, distinct without colour
    {"color": style.BLACK, "linestyle": "-"},
    {"color": style.VERMILLION, "linestyle": "--"},
    {"color": style.BLUE, "linestyle": ":"},
    {"color": style.GREEN, "linestyle": "-."},
)
MARKERS = "osD^"


class Loads(NamedTuple):
    """Loads of one scene, in SI; nan at speeds without a result."""

    name: str
    speeds: NDArray[np.float64]  # (speeds,), over f1(0)
    lines: dict[str, NDArray[np.float64]]  # (speeds,), by name of the number; those that are known
    peaks: Sequence[Peak]  # its answers
    opening_per_volume: float  # 1/m2
    no_torque: str | None = None  # why the model has none


def draw(
    sweeps: Sequence[Response],
    answers: Sequence[Mapping[str, Any]],
    rom: Rom,
    stress: Sequence[Mapping[str, Any]] = (),
    operating: Mapping[str, Any] = NO_LINES,
) -> Figure:
    """Loads of scenes of one blade; ``answers`` of each, ``stress`` where it is known."""
    by_scene = {stressed["scene"]: stressed for stressed in stress}
    loads = [
        loads_of(sweep, results, by_scene.get(results["scene"]))
        for sweep, results in zip(sweeps, answers, strict=True)
    ]
    return panels(loads, rom.f1, rom.provenance.blade, operating)


def loads_of(
    response: Response, results: Mapping[str, Any], stress: Mapping[str, Any] | None
) -> Loads:
    """Loads of a sweep; ``results``: its answers; ``stress``: as of ``stress.json``."""
    sweep, scene, rom = response.sweep, response.scene, response.rom
    width, radius = sweep["width"].values, rom.line(sweep["xi"].values)[:, 0]
    lines = {}
    if "force_mean" in sweep:
        lines["force"] = mean_force(sweep["force_mean"].values)
    if "torque" in sweep:
        lines["torque"] = np.nanmean(sweep["torque"].values, axis=1)
    elif scene.no_torque is None and not scene.contact.tangential:
        # work of the shaft: of the casing on the rods, and against friction
        parts = [name for name in ("casing", "friction", "heat") if name in sweep["energy"]]
        work = sweep["ledger"].sel(energy=parts).sum("energy", skipna=False)
        lines["torque"] = torque(work.values, sweep["rounds"].values)
    if "wear" in sweep:
        lines["worn_volume"] = worn_volume(sweep["wear"].values, width, radius)
    if stress:
        lines["alternating"] = np.array(
            [row.get("alternating", np.nan) for row in stress["speeds"]]
        )
    alike = np.ones((len(width), 1)), width, radius
    return Loads(
        name=results["scene"],
        speeds=response.speeds,
        lines={name: np.where(response.has_result, y, np.nan) for name, y in lines.items()},
        peaks=[Peak.of(peak) for peak in results["peaks"]],
        opening_per_volume=float(mean_opening(*alike) / worn_volume(*alike)),
        no_torque=scene.no_torque,
    )


PANELS = {  # number, label
    "force": "normal\nforce",
    "torque": "torque\n",
    "worn_volume": "worn\nvolume",
    "alternating": "alternating\nstress",
}


@style.styled
def panels(
    loads: Sequence[Loads], f1: float, blade: str, operating: Mapping[str, Any] = NO_LINES
) -> Figure:
    """A panel for each number that is known, lines over the speed, and the peaks with their ±."""
    numbers = [of for scene in loads for of in (scene.lines, *(p.numbers for p in scene.peaks))]
    shown = [name for name in PANELS if any(name in of for of in numbers)]
    drawn, grid = style.subplots(
        style.DOUBLE, 1.2 + 1.25 * len(shown), len(shown), letters=True, sharex=True, squeeze=False
    )
    used = grid[:, 0]
    for axes, name in zip(used, shown, strict=True):
        unit, scale = of_peaks()[name].shown
        unit = unit.replace("mm3", "mm³")
        for number, scene in enumerate(loads):
            _draw(axes, scene, name, scale, number)
        axes.set(ylabel=f"{PANELS[name]} ({unit})".replace("\n ", "\n"), ylim=(0, None))
        if name == "worn_volume":
            per_mm3 = units.MICRO / scale * loads[0].opening_per_volume
            style.beside(axes, per_mm3, "mean worn depth (µm)")
        if name == "torque":
            unknown = [f"not known of {of.name}: {of.no_torque}" for of in loads if of.no_torque]
            axes.set_title("; ".join(unknown), loc="right", fontsize=7)
        operating_lines(drawn if axes is used[0] else None, axes, f1, operating["lines"])
    units.show(used[-1].xaxis, style.below, *units.both(False, f1)["speed"])
    style.legend(drawn, "lower left", ncols=2)
    drawn.suptitle(f"blade {blade}", fontsize=8)
    return drawn


def _draw(axes: Axes, loads: Loads, name: str, scale: float, number: int) -> None:
    """The line of a number over the speed where it is known, and its peaks with their ±."""
    look = LOOKS[number % len(LOOKS)]
    if name in loads.lines:
        axes.plot(loads.speeds, scale * loads.lines[name], label=f"scene {loads.name}", **look)
    peaks = [peak for peak in loads.peaks if name in peak.numbers]
    if peaks:
        values = scale * np.array([peak.numbers[name] for peak in peaks])
        errors = scale * np.array([peak.errors[name] or np.nan for peak in peaks])
        axes.errorbar(
            [peak.Omega_c for peak in peaks],
            values,
            np.where(np.isfinite(errors), errors, 0.0),
            fmt=MARKERS[number % len(MARKERS)],
            color=look["color"],
            markerfacecolor="white",
            markersize=3.5,
            elinewidth=0.8,
            capsize=2,
            label=f"peaks of scene {loads.name}",
        )


@style.styled
def gap(sweep: Response) -> Figure:
    """Gaps at both places of the chord at which a scene gives them; at rest as dotted lines."""
    drawn, axes = style.subplots(style.SINGLE, 2.4)
    gaps_at_rest = given_gaps(sweep.scene.gaps, sweep.rom, [LEADING, TRAILING])
    places = zip(("1/16", "15/16"), gaps_at_rest, gaps_at_ends(sweep.sweep).T, strict=True)
    for look, (xi, given, running) in zip(LOOKS, places, strict=False):
        axes.plot(sweep.speeds, units.MICRO * running, label=rf"$\xi$ = {xi}", **look)
        axes.axhline(units.MICRO * given, color=look["color"], linestyle=":", linewidth=0.8)
    axes.set(ylabel="gap (µm)", ylim=(0, None))
    units.show(axes.xaxis, style.below, *sweep.units["speed"])
    axes.legend(title="dotted: as given")
    drawn.suptitle(sweep.names, fontsize=8)
    return drawn
