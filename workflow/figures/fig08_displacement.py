"""Fig. 8: displacement at xi = 1/16 for two densities of rods, and for three time steps."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from simulate.errors.observables import distance
from workflow.figures import style
from workflow.figures.response import Response
from workflow.markdown import percent

FIRST_ROUNDS = 5
LOOKS = (  # coarse to fine, ever thinner: all visible where the lines coincide
    {"color": "#B0B0B0", "linewidth": 2.8},
    {"color": style.VERMILLION, "linewidth": 1.4, "linestyle": (0, (3, 1.5))},
    {"color": style.BLACK, "linewidth": 0.6},
)
HEADROOM, FOOTROOM = 0.25, 0.05  # of the extent: where differences are written, and below

type Lines = list[tuple[str, Response]]  # label of a density or step, and its run; finest last


def load(files: Any) -> tuple[Lines, Lines]:
    """Read the sweeps of two densities, ``files.coarse`` and ``files.fine``, and ``files.steps``.

    The last speed of each is drawn. All record the history at xi = 1/16.
    """
    densities = [Response.read(path) for path in (files.coarse, files.fine)]
    steps = [Response.read(path) for path in files.steps]
    return [(_rods(one), one) for one in densities], [(_step(one), one) for one in steps]


def _rods(response: Response) -> str:
    return rf"$\nu$ = {response.scene.liner.rods_per_round:,} rods"


def _step(response: Response) -> str:
    """Time step of the run: that of the scene, shortened to fit the samples of a round."""
    run = response.sweep.isel(speed_over_f1=-1)
    return rf"$h$ = {float(run['step'] / run['step_limit']):.2f} $h_\mathrm{{limit}}$"


@style.styled
def draw(*compared: Lines) -> Figure:
    """One row for each comparison: the first rounds, and the last round alone."""
    drawn, panels = style.subplots(
        style.DOUBLE, 4.0, len(compared), 2, width_ratios=(1.6, 1), sharey="row"
    )
    for (start, end), lines in zip(panels, compared, strict=True):
        runs = [response for _, response in lines]
        samples = runs[0].scene.record.samples_per_round
        rounds = runs[0].u_r.shape[1] // samples
        _lines(start, lines, samples, 0, min(FIRST_ROUNDS, rounds))
        _lines(end, lines, samples, rounds - 1, rounds)
        all_u_r = [response.u_r[-1] for response in runs]
        low, high = np.nanmin(all_u_r), np.nanmax(all_u_r)
        start.set(
            ylim=(low - FOOTROOM * (high - low), high + HEADROOM * (high - low)),
            ylabel=f"$u_r$ at {style.PLACE}, {style.OVER_GAP}",
            title=_title(runs),
        )
        end.set(title="last round", xticks=rounds - 1 + np.arange(5) / 4)
        end.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=2.2)
    style.letter_panels(panels[:, 0])
    for axes in panels[-1]:
        axes.set_xlabel("time (rounds of the blade)")
    return drawn


def _lines(axes: Axes, lines: Lines, samples: int, first: int, last: int) -> None:
    """Draw rounds ``first`` (from 0) to ``last``, with each run's difference from the finest."""
    shown = slice(first * samples, last * samples)
    drawn = [response.u_r[-1, shown] for _, response in lines]
    looks = (*LOOKS[: len(drawn) - 1], LOOKS[-1])
    time = np.arange(shown.start + 1, shown.stop + 1) / samples  # the first is after one sample
    for u_r, (label, _), look in zip(drawn, lines, looks, strict=True):
        axes.plot(time, u_r, label=label, **look)
    apart = ", ".join(percent(distance(u_r, drawn[-1])) for u_r in drawn[:-1])
    said = f"$L_2$ from the finest: {apart}"
    axes.text(0.5, 0.97, said, transform=axes.transAxes, ha="center", va="top", fontsize=7)
    axes.set_xlim(first, last)


def _title(runs: Sequence[Response]) -> str:
    ends = ", ".join(sorted({str(response.status[-1]) for response in runs} - {"ok"}))
    doubt = f" ({ends})" if ends else ""
    return rf"$\Omega/f_1(0)$ = {runs[0].speeds[-1]:.3f}{doubt}, first {FIRST_ROUNDS} rounds"
