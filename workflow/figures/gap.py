"""Gap in operation over the speed, of a scene that gives it at rest."""

from matplotlib.figure import Figure

from simulate.errors.signals import gaps_at_ends
from simulate.scene import LEADING, TRAILING
from workflow.figures import style
from workflow.figures.response import Response

LOOKS = {  # of the places on the chord
    "1/16": {"color": style.BLACK, "linestyle": "-"},
    "15/16": {"color": style.VERMILLION, "linestyle": "--"},
}
MICRO = 1e6


@style.styled
def draw(sweep: Response) -> Figure:
    """Gaps at both places of the chord at which a scene gives them; at rest as dotted lines."""
    drawn, axes = style.subplots(style.SINGLE, 2.4)
    at_rest = sweep.scene.clearance.gaps([LEADING, TRAILING], sweep.rom.span)
    for (xi, look), given, gap in zip(
        LOOKS.items(), at_rest, gaps_at_ends(sweep.sweep).T, strict=True
    ):
        axes.plot(sweep.speeds, MICRO * gap, label=rf"$\xi$ = {xi}", **look)
        axes.axhline(MICRO * given, color=look["color"], linestyle=":", linewidth=0.8)
    axes.set(xlabel=style.SPEED_LABEL, ylabel="gap (µm)", ylim=(0, None))
    axes.legend(title="dotted: at rest")
    drawn.suptitle(sweep.title.partition(":")[0], fontsize=8)
    return drawn
