"""The gap in operation over the speed."""

from matplotlib.figure import Figure

from simulate.contact.gaps import given_gaps
from simulate.scene import LEADING, TRAILING
from simulate.signals import gaps_at_ends
from workflow.figures import style, units
from workflow.figures.response import Response

LOOKS = {  # of the places on the chord
    "1/16": {"color": style.BLACK, "linestyle": "-"},
    "15/16": {"color": style.VERMILLION, "linestyle": "--"},
}


@style.styled
def gap(sweep: Response) -> Figure:
    """Gaps at both places of the chord at which a scene gives them; at rest as dotted lines."""
    drawn, axes = style.subplots(style.SINGLE, 2.4)
    gaps_at_rest = given_gaps(sweep.scene.gaps, sweep.rom, [LEADING, TRAILING])
    running = gaps_at_ends(sweep.sweep).T
    for (xi, look), given, gaps in zip(LOOKS.items(), gaps_at_rest, running, strict=True):
        axes.plot(sweep.speeds, units.MICRO * gaps, label=rf"$\xi$ = {xi}", **look)
        axes.axhline(units.MICRO * given, color=look["color"], linestyle=":", linewidth=0.8)
    axes.set(ylabel="gap (µm)", ylim=(0, None))
    units.show(axes.xaxis, style.below, *sweep.units["speed"])
    axes.legend(title="dotted: as given")
    drawn.suptitle(sweep.names, fontsize=8)
    return drawn
