"""Long times: amplitude over 2000 rounds, and a run-up and run-down through a peak."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import ScalarFormatter

from simulate.sweeps.peak import along_order
from workflow.figures import lines, style
from workflow.figures.response import Response

ORDER = 4
WAYS = {  # of the sweeps, by file
    "rest": "from rest",
    "run_up": "run-up",
    "run_down": "run-down",
    "on_worn": "from rest, worn liner",
}
LOOKS = (("-", style.BLACK), ("--", style.VERMILLION), ("-.", style.BLUE), (":", style.GREEN))
LABELS = {
    "amplitude": f"amplitude, $k$ = {ORDER}, {style.OVER_GAP}",
    "wear": f"deepest wear {style.OVER_GAP}",
}


def load(files: Any) -> tuple[list[Response], dict[str, Response]]:
    """Read the long runs, ``files.long``, and the sweeps of ``WAYS``."""
    long = [Response.read(file, files.rom) for file in files.long]
    return long, {name: Response.read(files[name], files.rom) for name in WAYS}


@style.styled
def draw(long: Sequence[Response], ways: Mapping[str, Response]) -> Figure:
    """Amplitude over the rounds, a line for each speed; amplitude and wear over the speed."""
    drawn, panels = style.subplots(
        style.DOUBLE, 2.9, 1, 3, letters=True, width_ratios=(1, 1.25, 1.25)
    )
    rounds = np.cumsum([of.scene.rounds for of in long])
    after = [
        {"rounds": at, "speed": f"{speed:.3f}", "amplitude": amplitude}
        for at, of in zip(rounds, long, strict=True)
        for speed, amplitude in zip(of.speeds, along_order(of.sweep, ORDER), strict=True)
    ]
    lines.curves(panels[0], after, "rounds", "amplitude", "speed", markerfacecolor="white")
    panels[0].set(xscale="log", xlabel="rounds", ylabel=LABELS["amplitude"], ylim=(0, None))
    panels[0].set_xticks(rounds)
    panels[0].xaxis.set_major_formatter(ScalarFormatter())
    panels[0].minorticks_off()
    panels[0].legend(title=r"$\Omega/f_1(0)$", ncols=2, handlelength=2.2)
    through = [of for name in WAYS for of in _over_speeds(name, ways)]
    for axes, of in zip(panels[1:], LABELS, strict=True):
        lines.curves(axes, through, "speed", of, "way", looks=LOOKS)
        axes.set(xlabel=style.SPEED_LABEL, ylabel=LABELS[of], ylim=(0, None))
    drawn.legend(handles=panels[1].get_lines(), loc="outside lower right", ncols=len(WAYS))
    return drawn


def _over_speeds(name: str, ways: Mapping[str, Response]) -> list[dict[str, Any]]:
    """Amplitude and deepest wear of a sweep, at the speeds of the run-up."""
    of = ways[name]
    numbers = zip(of.speeds, along_order(of.sweep, ORDER), of.wear.max(axis=1), strict=True)
    return [
        {"way": WAYS[name], "speed": speed, "amplitude": amplitude, "wear": wear}
        for speed, amplitude, wear in numbers
        if speed >= ways["run_up"].speeds[0]
    ]
