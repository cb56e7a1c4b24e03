"""Fig. 3: Campbell diagram, reduced model (lines) and full model (markers)."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator
from numpy.typing import NDArray

from rom.check import RomCheck
from rom.model import Rom
from simulate.sweeps.peak import crossing
from workflow.figures import style
from workflow.figures.marks import (
    NO_LINES,
    RPM_PER_HZ,
    engine_order,
    frequencies_over_speed,
    operating_lines,
)
from workflow.paper.printed import CROSSING, HALF_DIGIT

MODES = 7  # compared by the paper
ENGINE_ORDERS = (4, 5, 6, 8)
OVER_ALL = (4, 8, 16, 32)  # with all modes
HEADROOM = 0.06  # above f1, for the labels of the engine orders
OURS = {"marker": "s", "color": style.VERMILLION, "markersize": 4.5, "linestyle": "none"}
BEHIND = {"facecolor": "white", "edgecolor": "none", "pad": 0.6}


@style.styled
def draw(
    rom: Rom, check: RomCheck, printed: bool = False, operating: Mapping[str, float] = NO_LINES
) -> Figure:
    """Mode 1 with the engine orders that cross it, and all modes.

    ``printed``: whether the crossings that the paper prints are marked; ``operating``: speeds of
    the operating lines, rpm, by name.
    """
    drawn, (first, every) = style.subplots(
        style.DOUBLE, 3.2, 1, 2, letters=True, width_ratios=(1.25, 1)
    )
    f1 = _frequencies(first, rom, check, 1)
    margin = HEADROOM * f1.max()
    first.set_ylim(f1.min() - 2 * margin, f1.max() + margin)
    for k in ENGINE_ORDERS:
        engine_order(first, k, "--")
    found = {k: speed for k in ENGINE_ORDERS if np.isfinite(speed := crossing(rom, k))}
    _crossings(first, found)
    if printed:
        _printed(first)
    operating_lines(drawn, first, rom.f1, operating, found, "crossing")
    first.legend(loc="lower right", handlelength=1.2, borderaxespad=0.3)
    modes = _frequencies(every, rom, check, MODES)
    for mode, last in enumerate(modes[-1], start=1):
        style.note(every, (every.get_xlim()[1], last), str(mode), (5, 0), va="center")
    every.set_ylim(0, 1.2 * modes.max())
    every.yaxis.set_major_locator(MultipleLocator(5))
    for k in OVER_ALL:
        engine_order(every, k, "--", beside=14)  # beyond the numbers of the modes
    _state_error(every, rom, check)
    style.beside(first, rom.f1, style.HZ_LABEL)
    for axes in (first, every):
        style.below(axes, RPM_PER_HZ * rom.f1, style.RPM_LABEL)
    drawn.suptitle(f"blade {rom.provenance.blade}", fontsize=8)
    return drawn


def _frequencies(axes: Axes, rom: Rom, check: RomCheck, modes: int) -> NDArray[np.float64]:
    """Draw natural frequencies over the speed; return those of the reduced model, (n, modes)."""
    speeds, reduced = frequencies_over_speed(rom, modes)
    unit = rom.omega1
    axes.plot(speeds, reduced, color=style.BLACK, label=f"reduced model, $n$ = {rom.n}")
    look = {"color": style.BLUE, "markerfacecolor": "white", "label": "full model"}
    axes.plot(check.speeds / unit, check.full[:, :modes] / unit, "o", **look)
    axes.set(xlabel=style.SPEED_LABEL, ylabel=style.FREQUENCY_LABEL, xlim=(0, speeds[-1]))
    return reduced


def _crossings(axes: Axes, speeds: Mapping[int, float]) -> None:
    """Mark the crossings of f1 with engine orders, and their speeds."""
    at = [(speed, k * speed) for k, speed in speeds.items()]
    axes.plot(*np.reshape(at, (-1, 2)).T, label="crossing and its speed", **OURS)
    look = {"color": style.VERMILLION, "fontsize": 8, "ha": "right", "bbox": BEHIND}
    for place in at:
        style.note(axes, place, f"{place[0]:.3f}", (-5, 4), **look)


def _printed(axes: Axes) -> None:
    """Mark the crossings that the paper prints, with half a digit to both sides."""
    speeds = np.array([*CROSSING.values()])
    orders = np.array([*CROSSING])
    look = {
        "fmt": "none",
        "ecolor": style.BLUE,
        "elinewidth": 2.0,
        "label": "crossings in the paper",
    }
    axes.errorbar(speeds, orders * speeds, xerr=HALF_DIGIT, **look)


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
    )
