"""Fig. 7: worn profiles for two densities of rods, at two speeds."""

from matplotlib.figure import Figure

from simulate.errors.observables import distance
from simulate.errors.signals import on_rods
from workflow.figures import style
from workflow.figures.marks import over_casing
from workflow.figures.response import Response
from workflow.markdown import percent

LOOKS = (  # coarse, fine: visible both where the lines coincide
    {"color": "#B0B0B0", "linewidth": 2.8},
    {"color": style.BLACK, "linewidth": 0.8, "linestyle": (0, (4, 2))},
)
HEADROOM = 1.3  # of the deepest wear: the difference is written above


@style.styled
def draw(coarse: Response, fine: Response) -> Figure:
    """One panel for each speed: depth over casing angle, both densities."""
    densities, speeds = (coarse, fine), coarse.speeds
    height = 0.7 + 1.45 * len(speeds)
    drawn, panels = style.subplots(
        style.SINGLE, height, len(speeds), letters=True, sharex=True, squeeze=False
    )
    for i, axes in enumerate(panels[:, 0]):
        for response, look in zip(densities, LOOKS, strict=True):
            nu = response.wear.shape[1]
            over_casing(axes, response.wear[i], label=rf"$\nu$ = {nu:,} rods", **look)
        deepest = max(response.wear[i].max() for response in densities)
        axes.set(title=rf"$\Omega/f_1(0)$ = {speeds[i]:.3f}", ylim=(0, HEADROOM * deepest))
        at = {"transform": axes.transAxes, "ha": "center", "va": "top"}
        axes.text(0.5, 0.96, _said(*densities, i), fontsize=7, **at)
        axes.label_outer()
    drawn.supylabel(f"{style.WORN}, {style.OVER_GAP}", fontsize=8)
    style.legend(drawn, "upper center", ncols=2, handlelength=2.6)
    return drawn


def _said(coarse: Response, fine: Response, i: int) -> str:
    """Relative difference of both profiles, or the status of runs without a result."""
    ends = [response.status[i] for response in (coarse, fine) if not response.has_result[i]]
    if ends:
        return f"no result: {', '.join(ends)}"
    profile = fine.wear[i]
    apart = distance(on_rods(coarse.wear[[i]], len(profile))[0], profile)
    chance = "; sensitive" if "sensitive" in (coarse.status[i], fine.status[i]) else ""
    return f"relative difference ($L_2$): {percent(apart)}{chance}"
