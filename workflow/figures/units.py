"""Units in which figures show speeds, frequencies and lengths: norms, and those of engines.

Figures hold speeds and frequencies over f1(0) and lengths over the gap; a unit is a scale of them.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axis import Axis
from matplotlib.ticker import AutoLocator

from geometry.blade import RPM_PER_HZ
from workflow.figures import style

MICRO = 1e6


class Unit(NamedTuple):
    """A unit, of which 1 in a figure is ``scale``."""

    scale: float
    label: str  # of an axis; of lengths the text after their name
    number: str = "{:g}"  # format of a number with its unit


def both(norms: bool, f1_Hz: float, gap_m: float = 1.0) -> dict[str, tuple[Unit, Unit]]:
    """By quantity the unit shown first and the other one; ``norms``: whether these are first."""
    pairs = {
        "speed": (
            Unit(1.0, style.SPEED_LABEL, "{:.3f} $f_1(0)$"),
            Unit(RPM_PER_HZ * f1_Hz, "speed (rpm)", "{:.0f} rpm"),
        ),
        "frequency": (Unit(1.0, style.FREQUENCY_LABEL), Unit(f1_Hz, "frequency (Hz)")),
        "length": (Unit(1.0, style.OVER_GAP), Unit(MICRO * gap_m, "(µm)")),
    }
    return pairs if norms else {name: pair[::-1] for name, pair in pairs.items()}


def show(
    axis: Axis, second_axis: Callable[..., Any], first: Unit, second: Unit, **place: float
) -> None:
    """Label an axis of norms, whose limits are set, in one unit, and in another beside it.

    ``second_axis``: ``style.below`` or ``style.beside``; ``place``: its further arguments.
    """
    axis.set_label_text(first.label)
    if first.scale != 1.0:
        low, high = first.scale * axis.get_view_interval()
        within = [tick for tick in AutoLocator().tick_values(low, high) if low <= tick <= high]
        axis.set_ticks(np.divide(within, first.scale), [f"{tick:.6g}" for tick in within])
    second_axis(axis.axes, second.scale, second.label, **place)
