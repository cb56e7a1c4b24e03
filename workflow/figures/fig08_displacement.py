"""Fig. 8: displacement at xi = 1/16 for two densities of rods, and for three time steps."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulate.compare import distance
from workflow.figures import style
from workflow.figures.runs import Run, percent, read_runs

FIRST_ROUNDS = 5
LOOKS = (  # coarse to fine, one within the other: where lines coincide all are seen
    {"color": "#B0B0B0", "linewidth": 2.8},
    {"color": style.VERMILLION, "linewidth": 1.4, "linestyle": (0, (3, 1.5))},
    {"color": style.BLACK, "linewidth": 0.6},
)
HEADROOM, FOOTROOM = 0.25, 0.05  # of the extent: where differences are written, and below


@dataclass(frozen=True)
class Comparison:
    """The same run with ever finer settings."""

    runs: tuple[Run, ...]  # coarse to fine
    labels: tuple[str, ...]

    def over(self, first: int, last: int) -> list[NDArray[np.float64]]:
        """Displacement of each over rounds ``first`` (from 0) to ``last``, not included."""
        return [run.u_r[first * run.samples : last * run.samples] for run in self.runs]


def load(files: Any) -> tuple[Comparison, Comparison]:
    """Read the sweeps of two densities, ``files.coarse`` and ``files.fine``, and ``files.steps``.

    The last speed of each is taken. All record the history at xi = 1/16.
    """
    densities = [read_runs(path)[-1] for path in (files.coarse, files.fine)]
    steps = [read_runs(path)[-1] for path in files.steps]
    return (
        Comparison(tuple(densities), tuple(rf"$\nu$ = {run.nu:,} rods" for run in densities)),
        Comparison(tuple(steps), tuple(_step(run) for run in steps)),
    )


def _step(run: Run) -> str:
    """Time step, as it was marched: that asked for, made to fit the samples of a round."""
    return rf"$h$ = {run.step_share:.2f} $h_\mathrm{{limit}}$"


@style.styled
def draw(densities: Comparison, steps: Comparison) -> Figure:
    """One row for each comparison: the first rounds, and the last round alone."""
    drawn = style.figure(style.DOUBLE, 4.0)
    panels = drawn.subplots(2, 2, width_ratios=(1.6, 1), sharey="row")
    for (start, end), letter, compared in zip(panels, "ab", (densities, steps), strict=True):
        rounds = compared.runs[0].rounds
        _lines(start, compared, 0, min(FIRST_ROUNDS, rounds))
        _lines(end, compared, rounds - 1, rounds)
        start.set_ylim(*_room(compared))
        start.set_ylabel(f"$u_r$ at {style.PLACE}, {style.OVER_GAP}")
        style.panel_letter(start, letter)
        start.set_title(_title(compared))
        end.set_title("last round")
        end.set_xticks(rounds - 1 + np.arange(5) / 4)
        end.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=2.2)
    for axes in panels[-1]:
        axes.set_xlabel("time (rounds of the blade)")
    return drawn


def _room(compared: Comparison) -> tuple[float, float]:
    """Limits that hold all displacements, and what is written above them."""
    low = min(np.nanmin(run.u_r) for run in compared.runs)
    high = max(np.nanmax(run.u_r) for run in compared.runs)
    return low - FOOTROOM * (high - low), high + HEADROOM * (high - low)


def _lines(axes: Axes, compared: Comparison, first: int, last: int) -> None:
    """Draw all runs over these rounds, and say how far each is from the finest."""
    looks = (*LOOKS[: len(compared.runs) - 1], LOOKS[-1])
    shown = compared.over(first, last)
    for run, u_r, label, look in zip(compared.runs, shown, compared.labels, looks, strict=True):
        time = run.time[first * run.samples : last * run.samples]
        axes.plot(time, u_r, label=label, **look)
    apart = ", ".join(percent(distance(u_r, shown[-1])) for u_r in shown[:-1])
    said = f"$L_2$ from the finest: {apart}"
    axes.text(0.5, 0.97, said, transform=axes.transAxes, ha="center", va="top", fontsize=7)
    axes.set_xlim(first, last)


def _title(compared: Comparison) -> str:
    run = compared.runs[0]
    ends = ", ".join(sorted({run.status for run in compared.runs} - {"ok"}))
    doubt = f" ({ends})" if ends else ""
    return rf"$\Omega/f_1(0)$ = {run.speed:.3f}{doubt}, first {FIRST_ROUNDS} rounds"
