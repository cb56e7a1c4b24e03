"""Fig. 16: spectrograms of u_r (xi = 1/16) at the k = 4 peak, without and with tangential force."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator
from numpy.typing import NDArray
from scipy.signal import ShortTimeFFT
from scipy.signal.windows import hann

from rom.model import Rom
from simulate.dataset import load as load_sweep
from simulate.dataset import scene_of
from simulate.observables import mode_share
from workflow.figures import style
from workflow.figures.marks import speed_text
from workflow.figures.response import response
from workflow.figures.runs import Run, run_of
from workflow.paper.measure import HIGHEST, disorder
from workflow.paper.measure import SPECTRUM_ROUNDS as LAST

ENGINE_ORDER = 4
MODES = 7  # natural frequencies marked
WINDOW = 2  # rounds
SLICES = 16  # a round
AMPLITUDES = 1e-4, 1.0  # gaps
TITLES = ("without tangential force", "with tangential force")
APART = 0.055  # of the axes' height, between the labels of two modes at least


@dataclass(frozen=True)
class Peak:
    """The run at the peak, and the natural frequencies at its speed."""

    run: Run
    modes: NDArray[np.float64]  # (modes,), f_m(Omega_c) over f1(0), ascending
    Omega_c: str  # over f1(0), or the bound that is known of it

    @classmethod
    def read(cls, path: str | Path, rom: Rom) -> Self | None:
        """The speed of the sweep's peak; None where no speed near it has a result."""
        sweep = load_sweep(path)
        seen = response(sweep, rom)
        peak = seen.peak(ENGINE_ORDER)
        if peak is None:
            return None
        at_speed = sweep.isel(speed=peak.index)
        omega = rom.modes(float(at_speed["speed"]))[0][:MODES]
        return cls(
            run=run_of(at_speed, scene_of(sweep)),
            modes=omega / (2 * np.pi * rom.f1),
            Omega_c=speed_text(seen, peak),
        )

    def spectrogram(
        self,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Rounds at the middle of each window, f / f1(0), amplitude (frequencies, windows).

        Only windows that lie within the run; a steady tone has its own amplitude. Hann window.
        """
        samples, u_r = self.run.samples, self.run.u_r
        window = hann(WINDOW * samples, sym=False)
        transform = ShortTimeFFT(
            window,
            hop=samples // SLICES,
            fs=samples,
            fft_mode="onesided2X",
            scale_to="magnitude",
            phase_shift=None,
        )
        first = transform.lower_border_end[1]
        last = transform.upper_border_begin(len(u_r))[1]
        amplitude = np.abs(transform.stft(u_r, p0=first, p1=last))
        frequency = transform.f * self.run.speed
        shown = frequency <= HIGHEST
        time = transform.delta_t * np.arange(first, last)
        return time, frequency[shown], amplitude[shown]

    def in_numbers(self) -> tuple[float, float]:
        """Share of mode 1 in the energy of the last rounds, and entropy of their amplitudes."""
        u_r = self.run.u_r[-LAST * self.run.samples :]
        share = mode_share(u_r, self.run.samples, self.run.speed, self.modes[0])
        return share, disorder(u_r, self.run.speed)


def load(files: Any) -> tuple[Peak | None, Peak | None]:
    """Read the sweeps ``files.without`` and ``files.withit``, and the reduced model ``files.rom``.

    Both record the spectrum, and the history at xi = 1/16.
    """
    rom = Rom.load(files.rom)
    return Peak.read(files.without, rom), Peak.read(files.withit, rom)


@style.styled
def draw(without: Peak | None, withit: Peak | None) -> Figure:
    """One panel for each: amplitude over time and frequency, natural frequencies at the right."""
    drawn = style.figure(style.DOUBLE, 5.4)
    panels = drawn.subplots(2, 1, sharex=True, sharey=True)
    for axes, letter, peak, title in zip(panels, "ab", (without, withit), TITLES, strict=True):
        style.panel_letter(axes, letter)
        axes.set(ylabel=style.FREQUENCY_LABEL, ylim=(0, HIGHEST))
        if peak is None:
            axes.set_title(f"{title}: no speed near the peak has a result")
            continue
        axes.set_title(_title(title, peak))
        mesh = _map(axes, peak)
        _mark_modes(axes, peak)
        drawn.colorbar(mesh, ax=axes, label=f"amplitude {style.OVER_GAP}", extend="both", pad=0.01)
    panels[0].yaxis.set_major_locator(MultipleLocator(5))
    panels[0].xaxis.set_major_locator(MultipleLocator(2))
    panels[-1].set_xlabel(f"time (rounds of the blade), middle of a window of {WINDOW} rounds")
    return drawn


def _title(title: str, peak: Peak) -> str:
    share, entropy = peak.in_numbers()
    chance = ", sensitive" if peak.run.status == "sensitive" else ""
    equal = "" if peak.Omega_c.startswith("$") else "= "
    return (
        rf"{title}, $\Omega_c/f_1(0)$ {equal}{peak.Omega_c}{chance}"
        f"\nlast {LAST} rounds: mode 1 has {100 * share:.1f} % of the energy; "
        f"entropy of the amplitudes {entropy:.2f}"
    )


def _map(axes: Axes, peak: Peak) -> QuadMesh:
    time, frequency, amplitude = peak.spectrogram()
    return axes.pcolormesh(
        style.edges(time),
        style.edges(frequency),
        amplitude,
        norm=LogNorm(*AMPLITUDES),
        cmap=style.MAP,
        rasterized=True,
    )


def _mark_modes(axes: Axes, peak: Peak) -> None:
    """Number the natural frequencies at the right edge, labels side by side clear of each other."""
    at = spread(peak.modes / HIGHEST, APART)
    for m, (frequency, label) in enumerate(zip(peak.modes, at, strict=True), start=1):
        axes.annotate(
            rf"$f_{m}$",
            (1.0, frequency / HIGHEST),
            (1.02, label),
            xycoords="axes fraction",
            textcoords="axes fraction",
            va="center",
            fontsize=7.5,
            arrowprops={"arrowstyle": "-", "linewidth": 0.6, "shrinkA": 0, "shrinkB": 0},
            annotation_clip=False,
        )


def spread(places: NDArray[np.float64], apart: float) -> NDArray[np.float64]:
    """Ascending ``places`` moved until all are ``apart``: halfway between pushed up and down."""
    steps = apart * np.arange(len(places))
    up = np.maximum.accumulate(places - steps) + steps
    down = np.minimum.accumulate((places - steps)[::-1])[::-1] + steps
    return (up + down) / 2
