"""Work-precision diagrams of step and scheme: error of each observable in each scene."""

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure

from workflow.figures import style
from workflow.figures.trade import TITLES, Run, band, by_step, heights, lowest, title
from workflow.study.levels import OTHER_SCHEME, SCENES, of_group
from workflow.study.trade_table import scheme_of

SCHEMES = {  # line, colour, colour inside the marks, label
    "piecewise-exact": ("o-", style.BLUE, style.BLUE, "piecewise-exact, by step"),
    "central": ("s--", style.VERMILLION, style.VERMILLION, "central differences, by step"),
    "mass-scaled": ("^:", style.GREEN, "white", "central differences, mass-scaled, by step"),
}


@style.styled
def draw(study: Sequence[Run]) -> Figure:
    """One row for each observable, one column for each scene; all on one reduced model.

    ``study``: rows of the experiment.
    """
    drawn, grid = style.subplots(
        style.DOUBLE, 7.0, len(TITLES), len(SCENES), sharex=True, sharey="row", squeeze=False
    )
    for row, observable in zip(grid, TITLES, strict=True):
        _row(row, study, observable)
        row[0].set_ylabel(f"error of\n{TITLES[observable]}")
    for top, bottom, name in zip(grid[0], grid[-1], SCENES, strict=True):
        top.set_title(title(study, name))
        bottom.set_xlabel("CPU time of a run (s)")
    style.legend(drawn, "lower center", ncols=2)
    return drawn


def _row(row: Any, study: Sequence[Run], observable: str) -> None:
    tried = of_group(study, "scheme")
    of_scene = [[run for run in tried if run["scene"] == name] for name in SCENES]
    bands = [
        next((run["errors"][observable] for run in runs if run["row"] == OTHER_SCHEME), None)
        for runs in of_scene
    ]
    floor = lowest(bands)
    for axes, runs, height in zip(row, of_scene, bands, strict=True):
        band(axes, height, floor)
        for same in by_step(runs, scheme_of):
            line, color, inside, label = SCHEMES[scheme_of(same[0])]
            look = {"color": color, "markerfacecolor": inside, "label": label}
            errors = [run["errors"][observable] for run in same]
            axes.plot([run["cpu_s"] for run in same], heights(errors, floor), line, **look)
    row[0].set_ylim(bottom=floor)
