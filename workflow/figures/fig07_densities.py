"""Fig. 7: worn profiles for two densities of rods, at two speeds."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from simulate.compare import distance
from simulate.observables import on_rods
from workflow.figures import style
from workflow.figures.runs import Run, percent, read_runs

LOOKS = (  # coarse, fine: where both lines coincide both are seen
    {"color": "#B0B0B0", "linewidth": 2.8},
    {"color": style.BLACK, "linewidth": 0.8, "linestyle": (0, (4, 2))},
)
HEADROOM = 1.3  # of the deepest wear: the difference is written above


def load(files: Any) -> tuple[tuple[Run, ...], tuple[Run, ...]]:
    """Read the sweeps of the two densities, ``files.coarse`` and ``files.fine``."""
    return read_runs(files.coarse), read_runs(files.fine)


@style.styled
def draw(coarse: tuple[Run, ...], fine: tuple[Run, ...]) -> Figure:
    """One panel for each speed: depth over casing angle, both densities."""
    drawn = style.figure(style.SINGLE, 0.7 + 1.45 * len(coarse))
    panels = drawn.subplots(len(coarse), 1, sharex=True, squeeze=False)[:, 0]
    for axes, letter, *pair in zip(panels, "abcd", coarse, fine, strict=False):
        _profiles(axes, pair)
        style.panel_letter(axes, letter)
        axes.set_title(rf"$\Omega/f_1(0)$ = {pair[0].speed:.3f}")
        axes.set_ylim(0, HEADROOM * max(run.wear.max() for run in pair))
    panels[-1].set(xlabel=r"casing angle $\theta$ (deg)", xlim=(0, 360), xticks=range(0, 361, 45))
    drawn.supylabel(f"{style.WORN}, {style.OVER_GAP}", fontsize=8)
    handles, labels = panels[0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside upper center", ncols=2, handlelength=2.6)
    return drawn


def _profiles(axes: Axes, pair: list[Run]) -> None:
    for run, look in zip(pair, LOOKS, strict=True):
        worn = run.wear
        theta = np.linspace(0, 360, run.nu + 1)
        axes.plot(theta, [*worn, worn[0]], label=rf"$\nu$ = {run.nu:,} rods", **look)
    axes.text(0.5, 0.96, _said(*pair), transform=axes.transAxes, ha="center", va="top", fontsize=7)


def _said(coarse: Run, fine: Run) -> str:
    """What the two differ by, or how a run ended that has no result."""
    ends = [run.status for run in (coarse, fine) if not run.has_result]
    if ends:
        return f"no result: {', '.join(ends)}"
    apart = distance(on_rods(coarse.wear[None], fine.nu)[0], fine.wear)
    chance = "; sensitive" if "sensitive" in (coarse.status, fine.status) else ""
    return f"relative difference ($L_2$): {percent(apart)}{chance}"
