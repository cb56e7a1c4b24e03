"""Work-precision diagrams of step and scheme: error of each observable in each scene."""

from typing import Any

from matplotlib.figure import Figure

from workflow.figures import style
from workflow.figures.trade import TITLES, band, by_step, lowest, marks, title, uncertainty
from workflow.study.trade_levels import scheme_of

SCHEMES = {  # line, colour, colour inside the marks, label
    "piecewise-exact": ("o-", style.BLUE, style.BLUE, "piecewise-exact, by step"),
    "central": ("s--", style.VERMILLION, style.VERMILLION, "central differences, by step"),
    "mass-scaled": ("^:", style.GREEN, "white", "central differences, mass-scaled, by step"),
}


@style.styled
def draw(study: dict[str, Any]) -> Figure:
    """One row for each observable, one column for each scene; all on one reduced model."""
    scenes = study["scenes"]
    drawn, grid = style.subplots(
        style.DOUBLE, 7.0, len(TITLES), len(scenes), sharex=True, sharey="row", squeeze=False
    )
    for row, observable in zip(grid, TITLES, strict=True):
        _row(row, study, observable)
        row[0].set_ylabel(f"error of\n{TITLES[observable]}")
    for top, bottom, name in zip(grid[0], grid[-1], scenes, strict=True):
        top.set_title(title(study, name))
        bottom.set_xlabel("CPU time of a run (s)")
    style.legend(drawn, "lower center", ncols=2)
    return drawn


def _row(row: Any, trade: dict[str, Any], observable: str) -> None:
    of_scene = {
        name: [run for run in trade["runs"] if run["scene"] == name and run["study"] == "scheme"]
        for name in trade["scenes"]
    }
    bands = [
        max((uncertainty(scene, run)[observable] or 0 for run in of_scene[name]), default=None)
        for name, scene in trade["scenes"].items()
    ]
    floor = lowest(bands)
    for axes, runs, height in zip(row, of_scene.values(), bands, strict=True):
        band(axes, height, floor)
        for same in by_step(runs, scheme_of):
            line, color, inside, label = SCHEMES[scheme_of(same[0])]
            look = {"fmt": line, "color": color, "markerfacecolor": inside, "label": label}
            marks(axes, same, [run["errors"][observable] for run in same], floor, **look)
    row[0].set_ylim(bottom=floor)
