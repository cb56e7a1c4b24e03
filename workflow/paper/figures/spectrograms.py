"""Fig. 16: spectrograms of the displacement at xi = 1/16, at the peak of EO 4."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator
from numpy.typing import NDArray

from simulate.sweeps.peak import Peak
from workflow.figures import style
from workflow.figures.annotations import speed_text, spread
from workflow.figures.response import Response
from workflow.paper.measure import HIGHEST, SPECTRUM_ROUNDS, disorder, share_of_mode_1
from workflow.paper.published import ENGINE_ORDER
from workflow.paper.signals import spectrogram

MARKED = 7  # natural frequencies marked
WINDOW = 2  # revolutions, of a spectrum
SLICES = 16  # spectra per revolution
AMPLITUDES = 1e-4, 1.0  # gaps, ends of their scale
TITLES = ("without tangential force", "with tangential force")
APART = 0.055  # least distance of two labels, over the axes' height


@style.styled
def draw(without: Response, withit: Response) -> Figure:
    """One panel for each: amplitude over time and frequency, natural frequencies at the right.

    Both sweeps record the spectrum, and the history at xi = 1/16.
    """
    drawn, panels = style.subplots(style.DOUBLE, 5.4, 2, letters=True, sharex=True, sharey=True)
    for axes, response, title in zip(panels, (without, withit), TITLES, strict=True):
        axes.set(ylabel=style.FREQUENCY_LABEL, ylim=(0, HIGHEST))
        peak = response.of_f1(ENGINE_ORDER)
        if peak is None:
            axes.set_title(f"{title}: no speed near the peak has a result")
            continue
        omega, _ = response.rom.modes(float(response.sweep["speed"][peak.index]))
        modes = omega[:MARKED] / response.rom.omega1
        axes.set_title(f"{title}, {_at_peak(response, peak)}")
        _spectrogram(axes, response, peak)
        _mark_modes(axes, modes)
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
        f"{100 * share_of_mode_1(last, samples, peak):.1f} % of the energy; "
        f"entropy of the amplitudes {disorder(last, peak.Omega_c):.2f}"
    )


def _spectrogram(axes: Axes, response: Response, peak: Peak) -> None:
    samples = response.scene.record.samples_per_round
    time, orders, amplitude = spectrogram(response.u_r[peak.index], samples, WINDOW, SLICES)
    frequency = orders * peak.Omega_c
    shown = frequency <= HIGHEST
    style.log_map(
        axes,
        style.edges(time),
        style.edges(frequency[shown]),
        amplitude[shown],
        AMPLITUDES,
        label=f"amplitude {style.OVER_GAP}",
        extend="both",
        pad=0.01,
    )


def _mark_modes(axes: Axes, modes: NDArray[np.float64]) -> None:
    """Label the natural frequencies at the right edge, without overlap."""
    labels = spread(modes / HIGHEST, APART)
    for m, (frequency, label) in enumerate(zip(modes, labels, strict=True), start=1):
        axes.annotate(
            rf"$f_{m}$",
            (1.0, frequency / HIGHEST),
            (1.02, label),
            xycoords="axes fraction",
            textcoords="axes fraction",
            arrowprops={"arrowstyle": "-", "linewidth": 0.6, "shrinkA": 0, "shrinkB": 0},
            fontsize=7.5,
            va="center",
        )
