"""Long times: amplitude over 2000 rounds, and a run-up and run-down through a peak."""

from collections.abc import Mapping, Sequence
from itertools import cycle
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import ScalarFormatter

from simulate.sweeps.peak import along_order
from workflow.figures import style
from workflow.figures.response import Response

ORDER = 4
WAYS = {  # of the sweeps, by file: label, look
    "rest": ("from rest", {"color": style.BLACK}),
    "run_up": ("run-up", {"color": style.VERMILLION, "linestyle": "--"}),
    "run_down": ("run-down", {"color": style.BLUE, "linestyle": "-."}),
    "on_worn": ("from rest, worn liner", {"color": style.GREEN, "linestyle": ":"}),
}
LOOKS = ("o-", "s--", "^-.", "v:", "D-", "x--")  # of the speeds


def load(files: Any) -> tuple[list[Response], dict[str, Response]]:
    """Read the long runs, ``files.long``, and the sweeps of ``WAYS``."""
    long = [Response.read(file, files.rom) for file in files.long]
    return long, {name: Response.read(files[name], files.rom) for name in WAYS}


@style.styled
def draw(long: Sequence[Response], ways: Mapping[str, Response]) -> Figure:
    """Amplitude over the rounds; amplitude and deepest wear over the speed."""
    drawn, panels = style.subplots(
        style.DOUBLE, 2.9, 1, 3, letters=True, width_ratios=(1, 1.25, 1.25)
    )
    _over_rounds(panels[0], long)
    for name, (label, look) in WAYS.items():
        of, shown = ways[name], ways[name].speeds >= ways["run_up"].speeds[0]
        panels[1].plot(of.speeds[shown], along_order(of.sweep, ORDER)[shown], label=label, **look)
        panels[2].plot(of.speeds[shown], of.wear.max(axis=1)[shown], **look)
    panels[1].set(ylabel=f"amplitude, $k$ = {ORDER}, {style.OVER_GAP}")
    panels[2].set(ylabel=f"deepest wear {style.OVER_GAP}")
    for axes in panels[1:]:
        axes.set(xlabel=style.SPEED_LABEL, ylim=(0, None))
    drawn.legend(handles=panels[1].get_lines(), loc="outside lower right", ncols=len(WAYS))
    return drawn


def _over_rounds(axes: Axes, long: Sequence[Response]) -> None:
    """Draw the amplitude after so many rounds, a line for each speed."""
    rounds = np.cumsum([of.scene.rounds for of in long])
    along = np.array([along_order(of.sweep, ORDER) for of in long])
    for look, speed, values in zip(cycle(LOOKS), long[0].speeds, along.T, strict=False):
        axes.plot(rounds, values, look, label=f"{speed:.3f}", markerfacecolor="white")
    axes.set(
        xscale="log",
        xlabel="rounds",
        ylabel=f"amplitude, $k$ = {ORDER}, {style.OVER_GAP}",
        ylim=(0, None),
    )
    axes.set_xticks(rounds)
    axes.xaxis.set_major_formatter(ScalarFormatter())
    axes.minorticks_off()
    axes.legend(title=r"$\Omega/f_1(0)$", ncols=2, handlelength=2.2)
