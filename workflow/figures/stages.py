"""Error over CPU time of each stage, before and after."""

from collections.abc import Sequence

from matplotlib.figure import Figure

from workflow.figures import style
from workflow.figures.records import split
from workflow.study.levels import LEVELS
from workflow.study.stages import AFTER, BEFORE, FLAT, MODEL, TILTED, Row

# Looks of the versions, and markers of what takes the time, by name
VERSIONS = {
    BEFORE: {"color": style.VERMILLION, "linestyle": "--", "markerfacecolor": "none"},
    AFTER: {"color": style.BLUE, "linestyle": "-"},
}
MARKERS = {MODEL: "s", FLAT: "o", TILTED: "^"}


@style.styled
def draw(study: Sequence[Row]) -> Figure:
    """A panel for each stage: error of its settings over CPU time, before and after.

    ``study``: records of ``study.stages``. All other choices are fine ones.
    """
    by_stage = split([row | {"percent": 100 * row["error"]} for row in study], "stage")
    drawn = style.panels(len(by_stage), style.DOUBLE, 6.0, columns=3)
    for axes, (name, settings) in zip(drawn.axes, by_stage.items(), strict=True):
        for version, look in VERSIONS.items():
            of_version = settings[settings["version"] == version].sort_values("cpu_s")
            for of, runs in split(of_version, "of").items():
                axes.plot(
                    runs["cpu_s"], runs["percent"], MARKERS[of], label=f"{of}, {version}", **look
                )
        for allowed in LEVELS.values():
            axes.axhline(100 * allowed, color="0.85", linewidth=0.6, zorder=0)
        axes.set(xscale="log", yscale="log", xlabel="CPU time (s)", ylabel="largest error (%)")
        axes.set_title(name, loc="right")
        axes.label_outer()
    style.legend(drawn, "lower center", ncols=3)
    return drawn
