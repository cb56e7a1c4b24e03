"""Fig. 3: Campbell diagram, reduced model (lines) and full model (markers)."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator
from numpy.typing import NDArray

from rom.check import RomCheck
from rom.model import Rom
from simulate.peaks import crossing
from workflow.figures import style
from workflow.figures.curve import frequencies_over_speed

MODES = 7  # compared by the paper
ENGINE_ORDERS = (4, 5, 6, 8)
HEADROOM = 0.06  # above f1, where the engine orders get their labels


@dataclass(frozen=True)
class Campbell:
    """Natural frequencies over speed, all over f1(0)."""

    speeds: NDArray[np.float64]  # (points,), of the reduced model
    reduced: NDArray[np.float64]  # (points, modes)
    check_speeds: NDArray[np.float64]  # (checks,), of the full model
    full: NDArray[np.float64]  # (checks, modes)
    error: NDArray[np.float64]  # (checks, all modes checked), reduced over full, less 1
    n: int  # DoFs of the reduced model
    f1: float  # Hz, f1(0)
    crossings: dict[int, float]  # of f1 with ``ENGINE_ORDERS``, over f1(0); nan where none

    @property
    def worst(self) -> tuple[int, int]:
        """Indices (check speed, mode) of the largest error."""
        speed, mode = np.unravel_index(np.abs(self.error).argmax(), self.error.shape)
        return int(speed), int(mode)


def load(files: Any) -> tuple[Campbell]:
    """Read the reduced model, ``files.rom``, and its check, ``files.check``."""
    rom, check = Rom.load(files.rom), RomCheck.load(files.check)
    unit = 2 * np.pi * rom.f1
    speeds, reduced = frequencies_over_speed(rom, MODES)
    campbell = Campbell(
        speeds=speeds,
        reduced=reduced,
        check_speeds=check.speeds / unit,
        full=check.full[:, :MODES] / unit,
        error=check.error,
        n=rom.n,
        f1=rom.f1,
        crossings={k: crossing(rom, k) for k in ENGINE_ORDERS},
    )
    return (campbell,)


@style.styled
def draw(campbell: Campbell) -> Figure:
    """Mode 1 with the engine orders that cross it, and all modes."""
    drawn = style.figure(style.DOUBLE, 2.9)
    first, every = drawn.subplots(1, 2, width_ratios=(1.25, 1))
    _frequencies(first, campbell, 1)
    _frequencies(every, campbell, campbell.reduced.shape[1])
    _zoom_on_mode_1(first, campbell)
    for k in ENGINE_ORDERS:
        _engine_order(first, campbell, k)
    first.legend(loc="lower right", handlelength=1.2, borderaxespad=0.3)
    every.yaxis.set_major_locator(MultipleLocator(5))
    every.set_ylim(0, campbell.full.max() * 1.2)
    _number(every, campbell)
    _state_error(every, campbell)
    style.panel_letter(first, "a")
    style.panel_letter(every, "b")
    return drawn


def _frequencies(axes: Axes, campbell: Campbell, modes: int) -> None:
    for m in range(modes):
        line = f"reduced model, $n$ = {campbell.n}" if m == 0 else None
        marker = "full model" if m == 0 else None
        axes.plot(campbell.speeds, campbell.reduced[:, m], color=style.BLACK, label=line)
        axes.plot(
            campbell.check_speeds,
            campbell.full[:, m],
            "o",
            markerfacecolor="white",
            color=style.BLUE,
            label=marker,
        )
    axes.set(xlabel=style.SPEED_LABEL, ylabel=style.FREQUENCY_LABEL)
    axes.set_xlim(0, campbell.speeds[-1])


def _zoom_on_mode_1(axes: Axes, campbell: Campbell) -> None:
    f1 = campbell.reduced[:, 0]
    margin = HEADROOM * f1.max()
    axes.set_ylim(f1.min() - 2 * margin, f1.max() + margin)


def _engine_order(axes: Axes, campbell: Campbell, k: int) -> None:
    """Draw the line k Omega, labelled where it leaves the top, and its crossing with f1."""
    top = axes.get_ylim()[1]
    end = min(top / k, campbell.speeds[-1])
    beside = end < top / k  # it leaves through the right side
    axes.plot([0, end], [0, k * end], "--", color=style.GREY, linewidth=0.8, zorder=1)
    axes.annotate(
        f"eo({k})",
        (end, k * end),
        (3, 0) if beside else (0, 2),
        textcoords="offset points",
        ha="left" if beside else "center",
        va="center" if beside else "bottom",
        fontsize=7.5,
    )
    at = campbell.crossings[k]
    if np.isfinite(at):
        _mark(axes, at, k, label="crossing and its speed" if k == ENGINE_ORDERS[0] else None)


def _mark(axes: Axes, speed: float, k: int, label: str | None) -> None:
    at = (speed, k * speed)
    axes.plot(*at, "s", color=style.VERMILLION, markersize=4.5, linestyle="none", label=label)
    axes.annotate(
        f"{speed:.3f}",
        at,
        (-5, 4),
        textcoords="offset points",
        ha="right",
        color=style.VERMILLION,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6},
    )


def _number(axes: Axes, campbell: Campbell) -> None:
    """Mode numbers at the right-hand ends of the lines."""
    for m, f in enumerate(campbell.reduced[-1], start=1):
        axes.annotate(
            str(m),
            (campbell.speeds[-1], f),
            (5, 0),
            textcoords="offset points",
            va="center",
            fontsize=7,
            annotation_clip=False,
        )


def _state_error(axes: Axes, campbell: Campbell) -> None:
    """Say the largest error, its sign, mode and speed."""
    speed, mode = campbell.worst
    axes.text(
        0.5,
        0.98,
        f"largest error, {campbell.error.shape[1]} modes, {len(campbell.check_speeds)} speeds:\n"
        f"{100 * campbell.error[speed, mode]:+.2g} % (mode {mode + 1}, "
        rf"$\Omega/f_1(0)$ = {campbell.check_speeds[speed]:.2f})",
        transform=axes.transAxes,
        ha="center",
        va="top",
        fontsize=7,
    )
