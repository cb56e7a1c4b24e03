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


@style.styled
def wear(coarse: Response, fine: Response) -> Figure:
    """One panel for each speed: worn depth over the casing angle, both densities."""
    number, runs = len(coarse.speeds), (coarse, fine)
    drawn, panels = style.subplots(
        style.SINGLE, 0.7 + 1.55 * number, number, letters=True, sharex=True, squeeze=False
    )
    for i, axes in enumerate(panels[:, 0]):
        depths = [run.wear[i] for run in runs]
        for run, depth, look in zip(runs, depths, LOOKS[::2], strict=True):
            over_casing(axes, depth, label=_rods(run), **look)
        on_finest = [on_rods(depth[None], len(depths[-1]))[0] for depth in depths]
        said = _distances(on_finest) if all(run.has_result[i] for run in runs) else "no result"
        axes.set(title=f"{_title(runs, i)}\n{said}", ylim=(0, None))
        axes.label_outer()
    drawn.supylabel(f"{style.WORN}, {style.OVER_GAP}", fontsize=8)
    style.legend(drawn, "upper center", ncols=2, handlelength=2.6)
    return drawn


@style.styled
def displacement(coarse: Response, fine: Response, steps: Sequence[Response]) -> Figure:
    """One row for densities, one for steps, at the last speed: first revolutions, then the last."""
    compared = ([coarse, fine], _rods, LOOKS[::2]), (steps, _step, LOOKS)
    drawn, panels = style.subplots(
        style.DOUBLE, 4.2, len(compared), 2, width_ratios=(1.6, 1), sharey="row"
    )
    for (start, end), (runs, name, looks) in zip(panels, compared, strict=True):
        samples = runs[0].scene.record.samples_per_round
        u_r = np.array([run.u_r[-1] for run in runs])
        rounds = u_r.shape[1] // samples
        first_rounds = f"{_title(runs, -1)}, first {FIRST_ROUNDS} revolutions"
        shown = (
            (start, 0, min(FIRST_ROUNDS, rounds), first_rounds),
            (end, rounds - 1, rounds, "last revolution"),
        )
        for axes, first, last, title in shown:
            part = slice(first * samples, last * samples)
            time = np.arange(part.start + 1, part.stop + 1) / samples  # first after one sample
            for run, line, look in zip(runs, u_r[:, part], looks, strict=True):
                axes.plot(time, line, label=name(run), **look)
            axes.set(xlim=(first, last), title=f"{title}\n{_distances(u_r[:, part])}")
        end.set_xticks(rounds - 1 + np.arange(5) / 4)
        end.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=2.2)
    style.letter_panels(panels[:, 0])
    drawn.supxlabel("time (revolutions)", fontsize=8)
    drawn.supylabel(f"$u_r$ at {style.PLACE}, {style.OVER_GAP}", fontsize=8)
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
