"""Campbell diagram, reduced model (lines) and full model (markers)."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from geometry.blade import MODES, ORDERS
from rom.check import RomCheck
from rom.model import Rom
from simulate.sweeps.crossings import BEYOND, critical
from simulate.sweeps.result_types import CriticalSpeed
from workflow import margins
from workflow.figures import style, units
from workflow.figures.annotations import (
    NO_MARKS,
    Marks,
    engine_order,
    frequencies_over_speed,
    operating_lines,
)

SHOWN = 7  # modes, compared by the paper
PLAIN: Mapping[str, Any] = {"lines": {}, "modes": MODES, "orders": ORDERS, "excited": {}}
FASTEST = 4  # crossings marked where no casing and no operating speed is known
HEADROOM = 0.06  # above f1, for the labels of the engine orders
NAMED_AT = np.array([0.5, 0.4, 0.6, 0.3, 0.7])  # of the speeds, where a casing's line is named
BEHIND = {"facecolor": "white", "edgecolor": "none", "pad": 0.6}


@style.styled
def draw(
    rom: Rom, check: RomCheck, marks: Marks = NO_MARKS, operating: Mapping[str, Any] = PLAIN
) -> Figure:
    """Mode 1 with engine orders that cross it, and all modes with those that cross others.

    Marked are the crossings that tables show: near operating speeds, or of orders that the casings
    excite; where there is neither those of mode 1 at the highest speeds.

    ``marks``: crossings of another source; speeds are then shown over f1(0) first. ``operating``:
    as of ``simulate.sweeps.crossings.critical``. With operating speeds the diagram goes on above
    the top speed of the model, and says below which crossings are next to them.
    """
    drawn, (first, every) = style.subplots(
        style.DOUBLE, 3.2, 1, 2, letters=True, width_ratios=(1.25, 1)
    )
    campbell, lines = critical(rom, operating), operating["lines"]
    f1 = _frequencies(first, rom, check, 1, beyond=bool(lines))
    margin = HEADROOM * f1.max()
    first.set_ylim(f1.min() - 2 * margin, f1.max() + margin)
    modes = _frequencies(every, rom, check, SHOWN, beyond=bool(lines))
    for mode, last in enumerate(modes[-1], start=1):
        style.note(every, (every.get_xlim()[1], last), str(mode), (5, 0), va="center")
    every.set_ylim(0, 1.2 * modes.max())
    for axes in (first, every):
        _casing(axes, operating.get("casing", ()), rom.f1)
    # the error of the mesh is not known
    rows = [{**row, "rpm_error": None} for row in margins.rows(campbell)]
    shown = margins.near(rows) or [row for row in rows if row["modes"] == [1]][-FASTEST:]
    both = units.both(bool(marks.spans), rom.f1)
    for axes, first_mode in ((first, True), (every, False)):
        marked = [crossing for crossing in shown if (crossing["modes"] == [1]) == first_mode]
        _crossings(axes, marked, rom.f1, both["speed"][0])
        units.show(axes.xaxis, style.below, *both["speed"])
    if marks.spans:  # from their lowest to their highest speed
        low, high, orders = np.array(marks.spans).T
        speeds = (low + high) / 2
        first.errorbar(
            speeds,
            orders * speeds,
            xerr=(high - low) / 2,
            fmt="none",
            ecolor=style.BLUE,
            elinewidth=2.0,
            label=marks.label,
        )
    texts = {name: "\n".join(margins.nearest(campbell, rows, name)) for name in lines}
    operating_lines(drawn, first, rom.f1, lines, texts)
    operating_lines(None, every, rom.f1, lines)
    first.legend(
        loc="lower right",
        handlelength=1.2,
        borderaxespad=0.3,
        frameon=True,
        framealpha=1.0,
        edgecolor="none",
    )
    _state_error(every, rom, check)
    units.show(first.yaxis, style.beside, *both["frequency"])
    units.show(every.yaxis, lambda *_: None, *both["frequency"])  # modes are named at the right
    drawn.suptitle(f"blade {rom.provenance.blade}", fontsize=8)
    return drawn


def _frequencies(
    axes: Axes, rom: Rom, check: RomCheck, modes: int, beyond: bool
) -> NDArray[np.float64]:
    """Draw natural frequencies over the speed; return those of the reduced model, (n, modes).

    ``beyond``: also those above the top speed, extrapolated.
    """
    speeds, reduced = frequencies_over_speed(rom, modes)
    unit = rom.omega1
    axes.plot(speeds, reduced, color=style.BLACK, label=f"reduced model, $n$ = {rom.n}")
    axes.plot(
        check.speeds / unit,
        check.full[:, :modes] / unit,
        "o",
        color=style.BLUE,
        markerfacecolor="white",
        label="full model, clamped" if rom.measured.size else "full model",
    )
    if beyond:
        further = np.linspace(1, BEYOND) * speeds[-1]
        ahead = np.array([rom.beyond(1)(speed * unit)[:modes] / unit for speed in further])
        axes.plot(further, ahead, color=style.BLACK, linestyle=(0, (2, 1)), label="extrapolated")
        speeds, reduced = further, np.vstack([reduced, ahead])
    axes.set_xlim(0, speeds[-1])
    return reduced


def _casing(axes: Axes, casing: Sequence[tuple[int, float]], f1_Hz: float) -> None:
    """Frequencies that the blade sees of a casing's modes, (n, Hz) each: f_n +- n Omega."""
    end, label = axes.get_xlim()[1], "casing, $|f_n \\pm n\\Omega|$"
    for order, Hz in casing:
        f = Hz / f1_Hz
        speeds = np.sort([0.0, min(f / max(order, 1), end), end])
        lines = np.column_stack([f + order * speeds, np.abs(f - order * speeds)])
        axes.plot(speeds, lines, ":", color=style.GREEN, label=[label, None])
        label = None
        low, high = axes.get_ylim()
        both = ((x, y) for x in NAMED_AT * end for y in (f + order * x, abs(f - order * x)))
        for place in [(x, y) for x, y in both if 0 < low < y < high][:1]:  # not among all modes
            style.note(axes, place, f"$n$ = {order}", (2, 2), color=style.GREEN)


def _crossings(
    axes: Axes,
    marked: Sequence[CriticalSpeed],
    f1_Hz: float,
    unit: units.Unit,
) -> None:
    """Draw the engine orders of crossings, and mark these with their speed in a unit."""
    for k in sorted({crossing["k"] for crossing in marked}):
        engine_order(axes, k, "--", distance=14)  # beyond the numbers of the modes
    over_f1 = {(crossing["rpm"] / (units.RPM_PER_HZ * f1_Hz), crossing["k"]) for crossing in marked}
    places = [
        (speed, k * speed)
        for speed, k in sorted(over_f1, reverse=True)
        if speed <= axes.get_xlim()[1]
    ]
    axes.plot(
        *np.reshape(places, (-1, 2)).T,
        "s",
        color=style.VERMILLION,
        markersize=4.5,
        label="crossing and its speed",
    )
    for place in places:
        speed, *_ = unit.number.format(unit.scale * place[0]).split()
        style.note(
            axes,
            place,
            speed,
            (0, 2),
            color=style.VERMILLION,
            ha="right",
            va="bottom",
            rotation=-40,
            bbox=BEHIND,
        )


def _state_error(axes: Axes, rom: Rom, check: RomCheck) -> None:
    """Write the largest error with its sign, mode and speed above the frequencies."""
    speed, mode = check.worst
    axes.text(
        0.5,
        0.98,
        f"largest error, {check.error.shape[1]} modes, {len(check.speeds)} speeds:\n"
        f"{100 * check.error[speed, mode]:+.2g} % (mode {mode + 1}, "
        rf"$\Omega/f_1(0)$ = {check.speeds[speed] / rom.omega1:.2f})",
        transform=axes.transAxes,
        ha="center",
        va="top",
        fontsize=7,
        bbox=BEHIND,
    )
