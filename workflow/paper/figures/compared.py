"""Sweeps beside one another: Figs. 6, 7, 8, 12 and 16.

Shapes of the casing; wear and displacement for two densities of rods and for three time steps; worn
depth at the peaks of EO 4; spectrograms of the displacement at xi = 1/16, at the peak of EO 4.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator
from numpy.typing import NDArray
from scipy.signal import ShortTimeFFT
from scipy.signal.windows import hann

from simulate.errors.observables import distance
from simulate.signals import leading_gap, maxima, on_rods
from simulate.sweeps.peak import Peak
from workflow.figures import style
from workflow.figures.annotations import CASING_ANGLE, over_casing, speed_text, spread
from workflow.figures.response import Response
from workflow.figures.wear import LABEL
from workflow.markdown import percent
from workflow.paper.measure import HIGHEST, SPECTRUM_ROUNDS, disorder, share_of_mode_1
from workflow.paper.published import ENGINE_ORDER

SHAPES = (  # of the casing, of the undistorted casing, of the tip: dashes, label, look
    ("-", "casing, distorted", {"color": style.BLACK, "linewidth": 1.4}),
    ("--", "casing, undistorted", {"color": style.GREY, "linewidth": 0.8}),
    (
        "-.",
        f"tip of undeformed blade, {style.PLACE}",
        {"color": style.BLUE, "linewidth": 0.9},
    ),
)
LINES = (("-", style.BLACK), ("--", style.VERMILLION))  # E = 1, E = 10, dashed as in the paper
FIRST_ROUNDS = 5  # of which the displacement is shown
LOOKS = (  # of densities, steps, coarse to fine: ever thinner, visible where lines coincide
    {"color": "#B0B0B0", "linewidth": 2.8},
    {"color": style.VERMILLION, "linewidth": 1.4, "linestyle": (0, (3, 1.5))},
    {"color": style.BLACK, "linewidth": 0.6},
)
WINDOW = 2  # revolutions, of a spectrum of the spectrograms
SLICES = 16  # spectra per revolution


def inward(response: Response, degrees: NDArray[Any]) -> NDArray[np.float64]:
    """Distortion d (n,) at angles (n,), deg, over gap g, at the end of the ramp."""
    gap = leading_gap(response.sweep)
    return response.scene.casing.inward(np.radians(degrees), gap) / gap


@style.styled
def shapes(two: Response, two_five: Response) -> Figure:
    """Above, the shapes around the blade, equally exaggerated; below, to scale over the angle.

    ``two`` and ``two_five``: sweeps, of which the scenes are drawn.
    """
    drawn = style.figure(style.SINGLE, 3.4)
    panels = drawn.subplot_mosaic(
        "ab;cd", height_ratios=(1.6, 1), per_subplot_kw={"ab": {"projection": "polar"}}
    )
    theta = np.linspace(0, 360, 721)
    distortions = [inward(response, theta) for response in (two, two_five)]
    # the largest distortion, or the gap, is 0.3 of the radius
    scale = 0.3 / max(1.0, np.abs(distortions).max())
    for response, d, above, below in zip((two, two_five), distortions, "ab", "cd", strict=True):
        around, over = panels[above], panels[below]
        heights = np.array([d, 0 * d, 0 * d + 1])
        _shape(around, np.radians(theta), 1 - scale * heights, d > 1)
        around.set(
            ylim=(0, 1.02 * (1 + scale * max(0.0, -np.min(distortions)))),
            yticks=[],
            xticks=[0],
            xticklabels=["$\\theta$ = 0"],
        )
        around.tick_params(pad=0, labelsize=7)
        around.spines[:].set_visible(False)
        around.annotate(
            "",
            (1.0, 0.5),
            (0.1, 0.5),
            arrowprops=style.ARROW | {"connectionstyle": "arc3,rad=0.3"},
        )
        around.text(0.7, 0.3, "$\\Omega$", ha="center", va="center")
        around.text(-np.pi / 2, 0.2, "exaggerated", fontsize=6.5, ha="center", va="center")
        orders = sorted({harmonic.order for harmonic in response.scene.casing.harmonics})
        over.set_title(f"harmonics {', '.join(map(str, orders))}", fontsize=7)
        _shape(over, theta, heights, d > 1)
        over.set(xlabel=CASING_ANGLE, xlim=(0, 360), xticks=range(0, 361, 90))
    panels["d"].sharey(panels["c"])
    panels["d"].tick_params(labelleft=False)
    panels["c"].set_ylabel(f"distortion $d$ inward,\n{style.OVER_GAP}")
    style.letter_panels([panels["a"], panels["b"]])
    style.legend(drawn, "lower center", ncols=2)
    return drawn


def _shape(
    axes: Axes,
    theta: NDArray[np.float64],
    heights: NDArray[np.float64],
    closed: NDArray[np.bool_],
) -> None:
    """Draw heights (3, n) of casing, undistorted casing and tip, and where the gap is closed."""
    for line, (dashes, label, look) in zip(heights, SHAPES, strict=True):
        axes.plot(theta, line, dashes, label=label, **look)
    axes.fill_between(
        theta,
        heights[2],
        heights[0],
        closed,
        label="gap closed by the casing alone",
        facecolor="#F0C8AA",
        edgecolor=style.VERMILLION,
        hatch="////",
        linewidth=0,
    )


@style.styled
def profiles(sweeps: Sequence[Response]) -> Figure:
    """Depth over the casing angle at the EO 4 peak, one line for each scene.

    Without a peak, the legend says so. Dotted: the angles at which the first scene's casing is
    closest to the blade.
    """
    drawn, axes = style.subplots(style.SINGLE, 2.6)
    for response, (dashes, colour) in zip(sweeps, LINES, strict=True):
        peak = response.of_f1(ENGINE_ORDER)
        depth, said = np.array([np.nan]), "no speed near the peak"
        if peak is not None:
            chance = ", not predictable" if response.sensitive("wear")[peak.index] else ""
            depth, said = response.wear[peak.index], f"{speed_text(response, peak)}{chance}"
        over_casing(
            axes,
            response.units["length"][0].scale * depth,
            label=f"{response.names}: {said}",
            linestyle=dashes,
            color=colour,
        )
    degrees = np.arange(-1, 362)  # one beyond 0 and 360: maxima may lie there
    axes.vlines(
        degrees[maxima(inward(sweeps[0], degrees))[0]],
        0,
        1,
        transform=axes.get_xaxis_transform(),
        color=style.GREY,
        linestyle=":",
        linewidth=0.8,
        label="casing nearest",
    )
    first, second = sweeps[0].units["length"]
    axes.set(ylabel=LABEL + first.label, ylim=(0, None))
    style.beside(axes, second.scale / first.scale, f"worn depth {second.label}")
    drawn.legend(loc="outside upper center", ncols=1)
    return drawn


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
        until, name_of_first = min(FIRST_ROUNDS, rounds), f"first {FIRST_ROUNDS} revolutions"
        for axes, first, last, title in (
            (start, 0, until, f"{_title(runs, -1)}, {name_of_first}"),
            (end, rounds - 1, rounds, "last revolution"),
        ):
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
    return "$L_2$ from the finest: " + ", ".join(
        percent(distance(line, lines[-1])) for line in lines[:-1]
    )


@style.styled
def spectrograms(without: Response, withit: Response) -> Figure:
    """One panel for each: amplitude over time and frequency, natural frequencies at the right.

    Both sweeps record the spectrum, and the history at xi = 1/16.
    """
    drawn, panels = style.subplots(style.DOUBLE, 5.4, 2, letters=True, sharex=True, sharey=True)
    forces = {"without": without, "with": withit}.items()
    for axes, (force, response) in zip(panels, forces, strict=True):
        axes.set(ylabel=style.FREQUENCY_LABEL, ylim=(0, HIGHEST))
        peak, title = response.of_f1(ENGINE_ORDER), f"{force} tangential force"
        if peak is None:
            axes.set_title(f"{title}: no speed near the peak has a result")
            continue
        axes.set_title(f"{title}, {_at_peak(response, peak)}")
        _map(axes, response, peak)
        omega, _ = response.rom.modes(float(response.sweep["speed"][peak.index]))
        _mark_modes(axes, omega[:7] / response.rom.omega1)
    panels[0].yaxis.set_major_locator(MultipleLocator(5))
    panels[0].xaxis.set_major_locator(MultipleLocator(2))
    panels[-1].set_xlabel(f"time (revolutions), middle of a window of {WINDOW} revolutions")
    return drawn


def _at_peak(response: Response, peak: Peak) -> str:
    """Critical speed; energy share of mode 1 and entropy of the last revolutions' spectrum."""
    samples = response.scene.record.samples_per_round
    last = response.u_r[peak.index, -SPECTRUM_ROUNDS * samples :]
    chance = ", sensitive" if response.status[peak.index] == "sensitive" else ""
    return (
        rf"$\Omega_c$ = {speed_text(response, peak)}{chance}"
        f"\nlast {SPECTRUM_ROUNDS} revolutions: mode 1 has "
        f"{100 * share_of_mode_1(last, samples):.1f} % of the energy; "
        f"entropy of the amplitudes {disorder(last, peak.Omega_c):.2f}"
    )


def _map(axes: Axes, response: Response, peak: Peak) -> None:
    """Colour the amplitudes over time and frequency."""
    time, orders, amplitude = spectrogram(
        response.u_r[peak.index], response.scene.record.samples_per_round
    )
    frequency = orders * peak.Omega_c
    shown = frequency <= HIGHEST
    style.log_map(
        axes,
        style.edges(time),
        style.edges(frequency[shown]),
        amplitude[shown],
        (1e-4, 1.0),
        label=f"amplitude {style.OVER_GAP}",
        extend="both",
        pad=0.01,
    )


def spectrogram(
    u_r: NDArray[np.float64], samples_per_round: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Amplitudes over time by a short-time Fourier transform with a Hann window.

    Scaled so that a harmonic has its own amplitude. Only windows that lie within the run are
    computed.

    Returns
    -------
    rounds, orders, amplitude
        Middle of each window (windows,), engine orders (orders,), and amplitudes (orders, windows)
        in the unit of ``u_r``.
    """
    transform = ShortTimeFFT(
        hann(WINDOW * samples_per_round, sym=False),
        hop=samples_per_round // SLICES,
        fs=samples_per_round,
        fft_mode="onesided2X",
        scale_to="magnitude",
        phase_shift=None,
    )
    first, last = transform.lower_border_end[1], transform.upper_border_begin(len(u_r))[1]
    amplitude = np.abs(transform.stft(u_r, p0=first, p1=last))
    return transform.delta_t * np.arange(first, last), transform.f, amplitude


def _mark_modes(axes: Axes, modes: NDArray[np.float64]) -> None:
    """Label the natural frequencies at the right edge, without overlap."""
    heights = modes / HIGHEST
    for m, (height, label) in enumerate(zip(heights, spread(heights, 0.055), strict=True), start=1):
        axes.annotate(
            rf"$f_{m}$",
            (1.0, height),
            (1.02, label),
            xycoords="axes fraction",
            textcoords="axes fraction",
            arrowprops={"arrowstyle": "-", "linewidth": 0.6, "shrinkA": 0, "shrinkB": 0},
            fontsize=7.5,
            va="center",
        )
