"""Spectra of the displacement at xi = 1/16 over the speed.

And of the strain along a gauge over the speed, as a rig shows it; all gauges as a table.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from geometry.base import RPM
from geometry.blade import MODES
from simulate.signals import spectrum
from simulate.sweeps.dataset import SPEED, Sweep
from simulate.sweeps.peak import Peak, along_order
from simulate.sweeps.result_types import order_name
from workflow.figures import style, units
from workflow.figures.annotations import (
    LINE,
    NO_LINES,
    NO_MARKS,
    Marks,
    engine_order,
    frequencies_over_speed,
    hatch,
    operating_lines,
    speed_text,
    spread,
)
from workflow.figures.response import Response

SHOWN = 2.5  # f / f1(0), highest in the map over the speed, if no peak is above
DECADES = 3  # of the scale of amplitudes
LOOKS = (  # of the engine orders drawn as amplitudes over all speeds
    ("-", style.BLACK),
    ("--", style.VERMILLION),
    ("-.", style.GREEN),
    ((0, (1, 1)), style.BLUE),
    (":", style.GREY),
)
ROOM = 0.09  # of the width of the map, for the name of an engine order above it
NEAR = 0.07  # of the critical speed, to both sides: where these are drawn
SHADE = 0.25  # opacity of marks
STRAIN = 1e-5  # in place of the gap, over which amplitudes of strain are drawn
SHOWN_STRAIN = 5.0  # f / f1(0), highest in its map


@style.styled
def over_speeds(
    sweep: Response,
    marks: Marks = NO_MARKS,
    operating: Mapping[str, Any] = NO_LINES,
    label: str = "",
    highest: float | None = None,
) -> Figure:
    """Map of amplitude over frequency and speed; below, amplitude along the engine orders.

    ``marks``: critical speeds of another source;
    ``operating``: as of ``simulate.sweeps.crossings.critical``; ``label``: of the amplitude, if it
    is not that of u_r; ``highest``: frequency over f1(0) in the map, by default above all peaks.
    """
    drawn, (top, bottom) = style.subplots(
        style.DOUBLE, 5.5, 2, letters=True, sharex=True, height_ratios=(1.8, 1)
    )
    largest = sweep.units["length"][0].scale * np.nanmax(sweep.spectrum[:, 1:], initial=0)
    limits = style.decades(largest, DECADES)
    peaks = [1.1 * peak.k * peak.Omega_c for peak in sweep.peaks]
    highest = highest or max([SHOWN, *peaks])
    _map(top, sweep, limits, label or f"amplitude of $u_r$ at {sweep.place}", highest)
    _overlay(top, sweep)
    _amplitudes(bottom, sweep, marks)
    bottom.set_ylim(limits)
    hatch(drawn, (top, bottom), sweep, "spectrum")
    operating_lines(drawn, bottom, sweep.rom.f1, operating["lines"])
    # beyond the names of engine orders
    units.show(top.yaxis, style.beside, *sweep.units["frequency"], outward=30)
    units.show(bottom.xaxis, style.below, *sweep.units["speed"])
    drawn.suptitle(sweep.title, fontsize=8)
    return drawn


def _map(
    axes: Axes, response: Response, scale: tuple[float, float], label: str, highest: float
) -> None:
    """Draw cells bounded by engine orders: the response along an order lies on its line."""
    orders = np.arange(response.spectrum.shape[1]) / response.scene.record.spectrum_rounds
    bins = int(np.searchsorted(orders, highest / response.speeds[0])) + 1
    speeds, amplitudes = style.over_speeds(response.speeds, response.spectrum[:, :bins])
    orders = style.edges(orders[:bins])
    across = np.broadcast_to(speeds[:, None], (len(speeds), len(orders)))
    unit, _ = response.units["length"]
    style.log_map(
        axes,
        across,
        np.outer(speeds, orders),
        unit.scale * amplitudes,
        scale,
        label=f"{label} {unit.label}",
        extend="both",
        pad=0.0,
        aspect=30,
    )
    axes.set(ylim=(0, highest), xlim=style.limits(response.speeds))


def _overlay(axes: Axes, response: Response) -> None:
    """Draw natural frequencies, engine orders with peaks or of the casing, rings at the peaks."""
    speeds, modes = frequencies_over_speed(response.rom, MODES)
    first, *_ = axes.plot(speeds, modes, color=style.BLUE, linewidth=1.2)
    first.set_label(r"$f(\Omega)$")
    orders = {peak.k for peak in response.peaks if peak.k % 1 == 0} | response.scene.casing.orders
    (low, high), last = axes.get_xlim(), np.inf
    for k in sorted(orders):  # their lines end at the right, then nearer and nearer at the top
        label = engine_order(axes, k, ":")
        label.set_in_layout(False)  # there is room outside the axes
        end = label.xy[0]
        label.set_visible(end == high or low <= end <= last - ROOM * (high - low))
        last = end if label.get_visible() else last
    peaks = [(peak.Omega_c, peak.k * peak.Omega_c) for peak in response.peaks]
    if peaks:
        axes.plot(
            *zip(*peaks, strict=True),
            "o",
            clip_on=False,
            label="peaks of (b)",
            color=style.BLACK,
            markerfacecolor="none",
            markersize=7,
        )
    axes.legend(loc="upper left")


def _amplitudes(axes: Axes, response: Response, marks: Marks) -> None:
    """Draw the amplitude along engine orders over the speed, and label the peaks."""
    unit, second = response.units["length"]
    curves = _looks(response, marks)
    for k, (dashes, colour) in curves.items():
        along = unit.scale * along_order(response.sweep, k)
        axes.plot(response.speeds, along, linestyle=dashes, color=colour, label=f"EO {k}")
    _others(axes, response, curves)
    handles, _ = axes.get_legend_handles_labels()
    for low, high, k in marks.spans:  # in the colours of their orders
        axes.axvspan(low, high, color=curves[k][1], alpha=SHADE, linewidth=0, zorder=0)
        across = axes.get_xaxis_transform()
        style.note(axes, ((low + high) / 2, 0), str(k), (0, 2), xycoords=across, ha="center")
    if marks.spans:
        handles.append(Patch(color=style.GREY, alpha=SHADE, linewidth=0, label=marks.label))
    axes.legend(
        handles=handles,
        loc="center left",
        bbox_to_anchor=(1.12, 0.5),
        handlelength=1.6,
    )
    axes.set(yscale="log", ylabel=f"amplitude\n{unit.label}")
    style.beside(axes, second.scale / unit.scale, f"amplitude {second.label}")
    names = spread(
        np.array([peak.Omega_c for peak in response.peaks]), LINE * np.ptp(axes.get_xlim())
    )
    for peak, across in zip(response.peaks, names, strict=True):
        _name(axes, response, peak, across)


def _looks(response: Response, marks: Marks) -> dict[int, tuple[Any, str]]:
    """Dashes and colour of the engine orders drawn over all speeds.

    Those of the marks, then those of the highest peaks, then those of the casing.
    """
    peaks = sorted(response.peaks, key=lambda peak: -peak.amplitude)
    of_peaks = [peak.k for peak in peaks if peak.k % 1 == 0]
    of_casing = [k for k in response.orders if k in response.scene.casing.orders]
    orders = dict.fromkeys([*(k for *_, k in marks.spans), *of_peaks, *of_casing])
    return dict(sorted(zip(orders, LOOKS, strict=False)))


def _others(axes: Axes, response: Response, curves: Mapping[int, Any]) -> None:
    """Draw the amplitude along the order of each further peak, about its critical speed."""
    label = "other peaks"
    for peak in (peak for peak in response.peaks if peak.k not in curves):
        near = abs(response.speeds - peak.Omega_c) <= NEAR * peak.Omega_c
        along = response.units["length"][0].scale * response.along(peak)
        axes.plot(response.speeds[near], along[near], color=style.GREY, linewidth=0.8, label=label)
        label = None


def _name(axes: Axes, response: Response, peak: Peak, across: float) -> None:
    """Write k and the critical speed above the axes, at x, with a line down to the peak."""
    place = peak.Omega_c, response.units["length"][0].scale * peak.amplitude
    axes.plot(*place, ".", color=style.BLACK, markersize=4)
    axes.annotate(
        f"{order_name(peak.k)}:  {speed_text(response, peak)}",
        place,
        (across, 1.03),
        textcoords=axes.get_xaxis_transform(),
        rotation=90,
        ha="center",
        va="bottom",
        fontsize=7,
        arrowprops={"arrowstyle": "-", "linewidth": 0.4, "color": style.GREY, "shrinkA": 0},
    )


class Strain(Response):
    """A sweep whose spectra are of the strain along a gauge, over ``STRAIN``."""

    @property
    def units(self) -> dict[str, tuple[units.Unit, units.Unit]]:
        """As of ``Response``, for lengths strains."""
        shown = units.Unit(units.MICRO * STRAIN, "(µε)"), units.Unit(100 * STRAIN, "(%)")
        return super().units | {"length": shown}


def of_gauge(sweep: Response, operating: Mapping[str, Any] = NO_LINES) -> Figure:
    """As ``over_speeds``, of the strain along the first grid by the vibration."""
    first = sweep.sweep["gauge_strain"].isel(gauge=0)
    amplitudes = (SPEED, "bin"), [spectrum(motion) for motion in first.values]
    of_strain = sweep.sweep.drop_vars(
        ["along", "beside", "beside_order", "place"],  # of displacements
        errors="ignore",
    )
    strains = of_strain.assign(spectrum=amplitudes).assign_attrs(gap_m=STRAIN)
    return over_speeds(
        Strain(strains, sweep.rom),
        operating=operating,
        label=f"strain, gauge {first['gauge'].item()}",
        highest=SHOWN_STRAIN,
    )


def gauges_csv(sweep: Sweep) -> str:
    """A line for each speed and grid: of rotation, largest and least in all, half of the range."""
    columns = {"speed (rpm)": RPM * sweep["speed"], "status": sweep["status"]}
    for name, unit, scale in (("strain", "µε", units.MICRO), ("stress", "MPa", 1 / units.MICRO)):
        static, moving = (scale * sweep[f"gauge_{name}{part}"] for part in ("_static", ""))
        highest, least = moving.max("gauge_time"), moving.min("gauge_time")
        columns |= {
            f"static {name} ({unit})": static,
            f"largest {name} ({unit})": static + highest,
            f"least {name} ({unit})": static + least,
            f"vibratory {name} ({unit})": (highest - least) / 2,
        }
    table = xr.Dataset(columns).reset_coords(drop=True)
    return table.to_dataframe([SPEED, "gauge"]).to_csv(float_format="%.6g")
