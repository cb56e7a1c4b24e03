"""Fig. 16: spectrograms of the displacement at xi = 1/16, at the peak of EO 4."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator
from numpy.typing import NDArray
from scipy.signal import ShortTimeFFT
from scipy.signal.windows import hann

from simulate.sweeps.peak import Peak
from workflow.figures import style
from workflow.figures.annotations import speed_text, spread
from workflow.figures.response import Response
from workflow.paper.measure import HIGHEST, SPECTRUM_ROUNDS, disorder, share_of_mode_1
from workflow.paper.published import ENGINE_ORDER

WINDOW = 2  # revolutions, of a spectrum
SLICES = 16  # spectra per revolution


@style.styled
def draw(without: Response, withit: Response) -> Figure:
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
    samples = response.scene.record.samples_per_round
    time, orders, amplitude = spectrogram(response.u_r[peak.index], samples)
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
