"""Units in which figures show speeds, frequencies and lengths: those of engines, or norms.

Figures hold speeds and frequencies over f1(0) and lengths over the gap; a unit is a scale of them.
"""

from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.ticker import AutoLocator
from numpy.typing import NDArray

from workflow.figures import style

RPM_PER_HZ = 60.0
MICRO = 1e6


class Unit(NamedTuple):
    """A unit, of which 1 in a figure is ``scale``."""

    scale: float
    label: str  # of an axis; of lengths what follows their name
    number: str = "{:.3f}"  # with its unit

    def text(self, value: float) -> str:
        """A number of a figure in this unit."""
        return self.number.format(self.scale * value)


class Units(NamedTuple):
    """Units of one figure."""

    speed: Unit
    frequency: Unit
    length: Unit


NORMS = Units(
    Unit(1.0, style.SPEED_LABEL, "{:.3f} $f_1(0)$"),
    Unit(1.0, style.FREQUENCY_LABEL),
    Unit(1.0, style.OVER_GAP),
)


def of_engines(f1_Hz: float, gap_m: float = 1.0) -> Units:
    """Revolutions per minute, hertz and micrometres."""
    return Units(
        Unit(RPM_PER_HZ * f1_Hz, style.RPM_LABEL, "{:.0f} rpm"),
        Unit(f1_Hz, style.HZ_LABEL),
        Unit(MICRO * gap_m, "(µm)"),
    )


class _Round(AutoLocator):
    """Ticks at round numbers of a unit."""

    def __init__(self, unit: Unit) -> None:
        super().__init__()
        self.scale = unit.scale

    def tick_values(self, vmin: float, vmax: float) -> NDArray:
        return super().tick_values(self.scale * vmin, self.scale * vmax) / self.scale


def below(axes: Axes, first: Units, second: Units) -> None:
    """Label x with speeds in one unit at the axes, in another below them."""
    _show(axes.xaxis, first.speed)
    style.below(axes, second.speed.scale, second.speed.label)


def beside(axes: Axes, first: Units, second: Units, outward: float) -> None:
    """Label y with frequencies in one unit, and in another at the right, ``outward`` points."""
    _show(axes.yaxis, first.frequency)
    style.beside(axes, second.frequency.scale, second.frequency.label, outward)


def _show(axis: Axis, unit: Unit) -> None:
    """Label an axis of norms in a unit, with ticks at its round numbers."""
    axis.set_label_text(unit.label)
    if unit.scale != 1.0:
        axis.set_major_locator(_Round(unit))
        axis.set_major_formatter(lambda at, _: f"{unit.scale * at:.6g}")
