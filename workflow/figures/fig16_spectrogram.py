"""Fig. 16: spectrograms of u_r (xi = 1/16) at the k = 4 peak, without and with tangential force."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator
from numpy.typing import NDArray

from simulate.errors.signals import mode_share, spectrogram
from simulate.sweeps.peak import Peak
from workflow.figures import style
from workflow.figures.marks import speed_text
from workflow.figures.response import Response
from workflow.paper.measure import HIGHEST, SPECTRUM_ROUNDS, disorder

ENGINE_ORDER = 4
MODES = 7  # natural frequencies marked
WINDOW = 2  # rounds
SLICES = 16  # a round
AMPLITUDES = 1e-4, 1.0  # gaps
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
        peak = response.by_order.get(ENGINE_ORDER)
        if peak is None:
            axes.set_title(f"{title}: no speed near the peak has a result")
            continue
        omega, _ = response.rom.modes(float(response.sweep["speed"][peak.index]))
        modes = omega[:MODES] / response.rom.omega1
        axes.set_title(f"{title}, {_title(response, peak, modes[0])}")
        _map(axes, response, peak)
        _mark_modes(axes, modes)
    panels[0].yaxis.set_major_locator(MultipleLocator(5))
    panels[0].xaxis.set_major_locator(MultipleLocator(2))
    panels[-1].set_xlabel(f"time (rounds of the blade), middle of a window of {WINDOW} rounds")
    return drawn


def _title(response: Response, peak: Peak, f1: float) -> str:
    """Critical speed; energy share of mode 1 and entropy of the spectrum of the last rounds."""
    samples = response.scene.record.samples_per_round
    last = response.u_r[peak.index, -SPECTRUM_ROUNDS * samples :]
    share = mode_share(last, samples, peak.Omega_c, f1)
    chance = ", sensitive" if response.status[peak.index] == "sensitive" else ""
    return (
        rf"$\Omega_c/f_1(0)$: {speed_text(response, peak)}{chance}"
        f"\nlast {SPECTRUM_ROUNDS} rounds: mode 1 has {100 * share:.1f} % of the energy; "
        f"entropy of the amplitudes {disorder(last, peak.Omega_c):.2f}"
    )


def _map(axes: Axes, response: Response, peak: Peak) -> None:
    samples = response.scene.record.samples_per_round
    time, orders, amplitude = spectrogram(response.u_r[peak.index], samples, WINDOW, SLICES)
    frequency = orders * peak.Omega_c
    shown = frequency <= HIGHEST
    edges = style.edges(time), style.edges(frequency[shown])
    bar = {"label": f"amplitude {style.OVER_GAP}", "extend": "both", "pad": 0.01}
    style.log_map(axes, *edges, amplitude[shown], AMPLITUDES, **bar)


def _mark_modes(axes: Axes, modes: NDArray[np.float64]) -> None:
    """Label the natural frequencies at the right edge, without overlap."""
    line = {"arrowstyle": "-", "linewidth": 0.6, "shrinkA": 0, "shrinkB": 0}
    look = {"xycoords": "axes fraction", "textcoords": "axes fraction", "va": "center"}
    labels = spread(modes / HIGHEST, APART)
    for m, (frequency, label) in enumerate(zip(modes, labels, strict=True), start=1):
        at = (1.0, frequency / HIGHEST)
        axes.annotate(rf"$f_{m}$", at, (1.02, label), arrowprops=line, fontsize=7.5, **look)


def spread(places: NDArray[np.float64], apart: float) -> NDArray[np.float64]:
    """Ascending ``places`` moved to a distance of ``apart`` at least.

    The mean of the places moved upwards as little as needed and those moved downwards.
    """
    steps = apart * np.arange(len(places))
    up = np.maximum.accumulate(places - steps) + steps
    down = np.minimum.accumulate((places - steps)[::-1])[::-1] + steps
    return (up + down) / 2
