"""Figs. 7, 8: wear and displacement for two densities of rods, and for three time steps."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulate.errors.observables import distance
from simulate.signals import on_rods
from workflow.figures import style
from workflow.figures.annotations import over_casing
from workflow.figures.response import Response
from workflow.markdown import percent

FIRST_ROUNDS = 5
LOOKS = (  # coarse to fine, ever thinner: all visible where the lines coincide
    {"color": "#B0B0B0", "linewidth": 2.8},
    {"color": style.VERMILLION, "linewidth": 1.4, "linestyle": (0, (3, 1.5))},
    {"color": style.BLACK, "linewidth": 0.6},
)
HEADROOM, FOOTROOM = 0.3, 0.05  # of the extent: where differences are written, and below
SAID = {"x": 0.5, "y": 0.97, "ha": "center", "va": "top", "fontsize": 7}


@style.styled
def wear(coarse: Response, fine: Response) -> Figure:
    """One panel for each speed: worn depth over the casing angle, both densities."""
    number = len(coarse.speeds)
    drawn, panels = style.subplots(
        style.SINGLE, 0.7 + 1.45 * number, number, letters=True, sharex=True, squeeze=False
    )
    for i, axes in enumerate(panels[:, 0]):
        depths = [run.wear[i] for run in (coarse, fine)]
        for run, depth, look in zip((coarse, fine), depths, LOOKS[::2], strict=True):
            over_casing(axes, depth, label=_rods(run), **look)
        on_finest = [on_rods(depth[None], len(depths[-1]))[0] for depth in depths]
        both = all(run.has_result[i] for run in (coarse, fine))
        axes.text(
            s=_distances(on_finest) if both else "no result", transform=axes.transAxes, **SAID
        )
        axes.set(title=_title([coarse, fine], i), ylim=(0, (1 + HEADROOM) * np.max(on_finest)))
        axes.label_outer()
    drawn.supylabel(f"{style.WORN}, {style.OVER_GAP}", fontsize=8)
    style.legend(drawn, "upper center", ncols=2, handlelength=2.6)
    return drawn


@style.styled
def displacement(coarse: Response, fine: Response, steps: Sequence[Response]) -> Figure:
    """One row for densities, one for steps, at the last speed: first revolutions, then the last."""
    compared = ([coarse, fine], _rods), (steps, _step)
    drawn, panels = style.subplots(
        style.DOUBLE, 4.0, len(compared), 2, width_ratios=(1.6, 1), sharey="row"
    )
    for (start, end), (runs, name) in zip(panels, compared, strict=True):
        samples = runs[0].scene.record.samples_per_round
        looks = (*LOOKS[: len(runs) - 1], LOOKS[-1])
        u_r = np.array([run.u_r[-1] for run in runs])
        rounds, (low, high) = u_r.shape[1] // samples, (np.nanmin(u_r), np.nanmax(u_r))
        shown = (start, 0, min(FIRST_ROUNDS, rounds)), (end, rounds - 1, rounds)
        for axes, first, last in shown:
            part = slice(first * samples, last * samples)
            time = np.arange(part.start + 1, part.stop + 1) / samples  # first after one sample
            for run, line, look in zip(runs, u_r[:, part], looks, strict=True):
                axes.plot(time, line, label=name(run), **look)
            axes.text(s=_distances(u_r[:, part]), transform=axes.transAxes, **SAID)
            axes.set_xlim(first, last)
        start.set(
            ylim=(low - FOOTROOM * (high - low), high + HEADROOM * (high - low)),
            ylabel=f"$u_r$ at {style.PLACE}, {style.OVER_GAP}",
            title=f"{_title(runs, -1)}, first {FIRST_ROUNDS} revolutions",
        )
        end.set(title="last revolution", xticks=rounds - 1 + np.arange(5) / 4)
        end.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=2.2)
    style.letter_panels(panels[:, 0])
    for axes in panels[-1]:
        axes.set_xlabel("time (revolutions)")
    return drawn


def _rods(response: Response) -> str:
    return rf"$\nu$ = {response.scene.liner.rods_per_round:,} rods"


def _step(response: Response) -> str:
    """Time step of the run: that of the scene, shortened to fit the samples of a revolution."""
    run = response.sweep.isel(speed_over_f1=-1)
    return rf"$h$ = {float(run['step'] / run['step_limit']):.2f} $h_\mathrm{{limit}}$"


def _title(runs: Sequence[Response], i: int) -> str:
    """Speed of the runs, and how those end that are not ok."""
    ends = ", ".join(sorted({str(run.status[i]) for run in runs} - {"ok"}))
    return rf"$\Omega/f_1(0)$ = {runs[0].speeds[i]:.3f}" + (f" ({ends})" if ends else "")


def _distances(lines: Sequence[NDArray[np.float64]]) -> str:
    """Relative differences of all lines from the last."""
    distances = ", ".join(percent(distance(line, lines[-1])) for line in lines[:-1])
    return f"$L_2$ from the finest: {distances}"
