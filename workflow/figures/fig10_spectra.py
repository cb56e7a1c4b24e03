"""Figs. 10a, 10b: response spectra of u_r at xi = 1/16 over the speed."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from simulate.errors.signals import leading_gap
from simulate.sweeps.peak import Peak, along_order, crossing
from workflow.figures import style
from workflow.figures.marks import (
    NO_LINES,
    RPM_PER_HZ,
    engine_order,
    frequencies_over_speed,
    hatch,
    operating_lines,
    speed_text,
)
from workflow.figures.response import Response
from workflow.paper.printed import CRITICAL, expected

HIGHEST = 2.5  # f / f1(0) shown
DECADES = 3  # of the scale of amplitudes
LINES = (2, 4, 6, 8, 10, 12, 14)  # engine orders drawn in the map
NAMED = (2, 4, 6, 8, 10, 14)  # and named: more have no room
CURVES = {  # engine orders drawn as amplitudes
    2: (":", style.GREY),
    4: ("-", style.BLACK),
    5: ("-.", style.GREEN),
    6: ("--", style.VERMILLION),
    8: ((0, (1, 1)), style.BLUE),
}
OTHERS = {"color": style.GREY, "linewidth": 0.8}  # engine orders with a peak, beside CURVES
NEAR = 0.07  # of the critical speed, to both sides: where these are drawn
SHADE = 0.25  # opacity of the paper's critical speeds
LABEL = f"amplitude of $u_r$ at {style.PLACE}, {style.OVER_GAP}"


@style.styled
def draw(
    sweep: Response, printed: str | None = None, operating: Mapping[str, float] = NO_LINES
) -> Figure:
    """Map of amplitude over frequency and speed; below, amplitude along the engine orders.

    ``printed``: part of the paper whose critical speeds are marked, as of ``CRITICAL``;
    ``operating``: speeds of the operating lines, rpm, by name.
    """
    drawn, (top, bottom) = style.subplots(
        style.DOUBLE, 5.5, 2, letters=True, sharex=True, height_ratios=(1.8, 1)
    )
    scale = style.decades(np.nanmax(sweep.spectrum[:, 1:], initial=0), DECADES)
    _map(top, sweep, scale)
    _overlay(top, sweep)
    _amplitudes(bottom, sweep, printed)
    bottom.set_ylim(scale)
    hatch(drawn, (top, bottom), sweep, "spectrum")
    at_peaks = {peak.k: peak.Omega_c for peak in sweep.peaks}
    operating_lines(drawn, bottom, sweep.rom.f1, operating, at_peaks, "peak")
    _units(top, bottom, sweep)
    drawn.suptitle(sweep.title, fontsize=8)
    return drawn


def _units(top: Axes, bottom: Axes, response: Response) -> None:
    """Second axes in Hz, micrometres and rpm."""
    f1 = response.rom.f1
    style.beside(top, f1, style.HZ_LABEL, outward=30)  # beyond the names of engine orders
    style.beside(bottom, 1e6 * leading_gap(response.sweep), "amplitude (µm)")
    style.below(bottom, RPM_PER_HZ * f1, style.RPM_LABEL)


def _map(axes: Axes, response: Response, scale: tuple[float, float]) -> None:
    """Draw cells bounded by engine orders: the response along an order lies on its line."""
    orders = np.arange(response.spectrum.shape[1]) / response.scene.record.spectrum_rounds
    bins = int(np.searchsorted(orders, HIGHEST / response.speeds[0])) + 1
    speeds, amplitudes = style.over_speeds(response.speeds, response.spectrum[:, :bins])
    orders = style.edges(orders[:bins])
    across = np.broadcast_to(speeds[:, None], (len(speeds), len(orders)))
    bar = {"label": LABEL, "extend": "both", "pad": 0.0, "aspect": 30}
    style.log_map(axes, across, np.outer(speeds, orders), amplitudes, scale, **bar)
    limits = style.limits(response.speeds)
    axes.set(ylabel=style.FREQUENCY_LABEL, ylim=(0, HIGHEST), xlim=limits)


def _overlay(axes: Axes, response: Response) -> None:
    """Draw f1(Omega), the engine orders, and rings at the peaks."""
    speeds, f1 = frequencies_over_speed(response.rom, 1)
    axes.plot(speeds, f1, color=style.BLUE, linewidth=1.2, label=r"$f_1(\Omega)$")
    for k in sorted({*LINES, *(peak.k for peak in response.peaks)}):
        label = engine_order(axes, k, ":")
        label.set_in_layout(False)  # there is room outside the axes
        label.set_visible(k in NAMED and label.xy[0] >= axes.get_xlim()[0])
    peaks = [(peak.Omega_c, peak.k * peak.Omega_c) for peak in response.peaks]
    if peaks:
        ring = {"color": style.BLACK, "markerfacecolor": "none", "markersize": 7}
        axes.plot(*zip(*peaks, strict=True), "o", clip_on=False, label="peaks of (b)", **ring)
    axes.legend(loc="upper left")


def _amplitudes(axes: Axes, response: Response, printed: str | None) -> None:
    """Draw the amplitude along engine orders over the speed, and label the peaks."""
    for k, (dashes, colour) in CURVES.items():
        along = along_order(response.sweep, k)
        axes.plot(response.speeds, along, linestyle=dashes, color=colour, label=f"eo({k})")
    _others(axes, response)
    paper = _printed(axes, response, printed) if printed else []
    handles = [*axes.get_legend_handles_labels()[0], *paper]
    axes.legend(handles=handles, loc="center left", bbox_to_anchor=(1.12, 0.5), handlelength=1.6)
    axes.set(yscale="log", xlabel=style.SPEED_LABEL, ylabel=f"amplitude\n{style.OVER_GAP}")
    for peak in response.peaks:
        _name(axes, response, peak)


def _others(axes: Axes, response: Response) -> None:
    """Draw the amplitude along each further engine order with a peak, about its critical speed."""
    label = "other peaks"
    for peak in response.peaks:
        if peak.k not in CURVES:
            near = abs(response.speeds - peak.Omega_c) <= NEAR * peak.Omega_c
            along = along_order(response.sweep, peak.k)[near]
            axes.plot(response.speeds[near], along, label=label, **OTHERS)
            label = None


def _printed(axes: Axes, response: Response, part: str) -> list[Patch]:
    """Shade the paper's critical speeds in the colours of their orders; return their key."""
    across = axes.get_xaxis_transform()
    for k in CRITICAL[part]:
        low, high = expected(part, k, crossing(response.rom, k))
        axes.axvspan(low, high, color=CURVES[k][1], alpha=SHADE, linewidth=0, zorder=0)
        style.note(axes, ((low + high) / 2, 0), str(k), (0, 2), xycoords=across, ha="center")
    return [Patch(color=style.GREY, alpha=SHADE, linewidth=0, label=r"$\Omega_c$, paper")]


def _name(axes: Axes, response: Response, peak: Peak) -> None:
    """Write k and the critical speed above the axes, with a line down to the peak."""
    axes.plot(peak.Omega_c, peak.amplitude, ".", color=style.BLACK, markersize=4)
    axes.annotate(
        f"$k$ = {peak.k}:  {speed_text(response, peak)}",
        (peak.Omega_c, peak.amplitude),
        (peak.Omega_c, 1.03),
        textcoords=axes.get_xaxis_transform(),
        rotation=90,
        ha="center",
        va="bottom",
        fontsize=7,
        arrowprops={"arrowstyle": "-", "linewidth": 0.4, "color": style.GREY, "shrinkA": 0},
    )
