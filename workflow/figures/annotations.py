"""Marks shared by figures: engine orders, natural frequencies, casing angles, peaks, status."""

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import product
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.text import Annotation
from numpy.typing import NDArray

from geometry.blade import RPM_PER_HZ
from rom.model import Rom
from simulate.errors.neighbours import GAP_CHANGE
from simulate.marching import SENSITIVE_FROM
from simulate.scene import DYING_OUT, GROWING
from simulate.sweeps.peak import Peak
from workflow.figures import style
from workflow.figures.response import Response

CASING_ANGLE = r"casing angle $\theta$ (deg)"
NO_LINES: Mapping[str, Any] = MappingProxyType({"lines": {}})  # no operating speeds
FOR_LINE = 0.175  # in, height of a line of text in their legend
OPERATING = ((0, (7, 2, 1.5, 2)), (0, (1.5, 1.5)))  # dashes of design and idle speed
CROSSINGS_AT, PEAKS_AT = 1.035, 1.15  # of the axes' height
NO_RESULT, NOT_PREDICTABLE, NO_CONTACT = "/////", "\\\\\\\\\\", "...."  # hatches
LINE = 0.026  # of the width of axes over speeds, a line of small type
POINTS = 161  # speeds of a curve of natural frequencies


class Marks(NamedTuple):
    """Values of another source, which a figure shows beside its own."""

    label: str  # in the legend
    # (lowest speed, highest speed, number) each, speeds over f1(0): the number is the engine order,
    # or that of worn lobes
    spans: Sequence[tuple[float, float, int]]


NO_MARKS = Marks("", ())


def speed_text(response: Response, peak: Peak) -> str:
    """Critical speed with its unit; where the sweep ends on the rise, its bound.

    With a word where the motion there still grows or dies out at the end of the run.
    """
    last = peak.index == len(response.speeds) - 1
    beyond = "" if not peak.at_end else r"$\geq$ " if last else r"$\leq$ "
    trend, (unit, _) = response.trend[peak.index], response.units["speed"]
    goes_on = f", {trend}" if trend in (GROWING, DYING_OUT) else ""
    return beyond + unit.number.format(unit.scale * peak.Omega_c) + goes_on


def engine_order(axes: Axes, k: float, dashes: str, distance: float = 4) -> Annotation:
    """Draw the line k Omega within the axes' limits; return its label, at the end of the line.

    ``distance``: points of type from the right-hand side of the axes to a label there.
    """
    right, top = axes.get_xlim()[1], axes.get_ylim()[1]
    end = min(right, top / k)
    axes.plot([0, end], [0, k * end], dashes, color=style.GREY, linewidth=0.8, zorder=1)
    outside = {"offset": (distance, 0), "ha": "left", "va": "center"}
    above = {"offset": (0, 2), "ha": "center", "va": "bottom"}
    return style.note(axes, (end, k * end), f"EO {k}", **(outside if end == right else above))


def operating_lines(
    drawn: Figure | None,
    axes: Axes,
    f1_Hz: float,
    lines: Mapping[str, float],
    texts: Mapping[str, str] = MappingProxyType({}),
) -> None:
    """Draw operating speeds (rpm, by name), with a legend below.

    ``drawn``: figure of that legend; None without it. ``texts``: its texts, by name.
    """
    handles, labels = [], []
    for (name, rpm), dashes in zip(lines.items(), OPERATING, strict=False):
        speed = rpm / (RPM_PER_HZ * f1_Hz)
        handles.append(
            axes.axvline(speed, color=style.GREEN, linestyle=dashes, linewidth=1.2, zorder=1.5)
        )
        labels.append(texts.get(name, f"{name} {rpm:.0f} rpm"))
    if handles and drawn:
        drawn.legend(handles, labels, loc="outside lower right", handlelength=2.5)
        text = "\n".join(labels)
        drawn.set_figheight(drawn.get_figheight() + FOR_LINE * (1 + text.count("\n")))


def over_casing(axes: Axes, values: NDArray[np.float64], **line: Any) -> None:
    """Draw ``values`` (n,), at the angles 2 pi j / n, over the casing angle."""
    axes.plot(np.linspace(0, 360, len(values) + 1), [*values, values[0]], **line)
    axes.set(xlabel=CASING_ANGLE, xlim=(0, 360), xticks=range(0, 361, 45))


def mark_speeds(axes: Axes, response: Response) -> None:
    """Mark in two rows above the axes the peaks, and the linear crossings from which they rise.

    Crossings left of the axes are left out.
    """
    peaks, start = response.peaks, axes.get_xlim()[0]
    if not peaks:
        return
    crossings = [(p.k, p.crossing) for p in peaks if p.crossing and p.crossing >= start]
    if crossings:  # a line of no points has no place: the layout would find no room for the axes
        _row(axes, CROSSINGS_AT, "white", "crossing", crossings)
    _row(axes, PEAKS_AT, style.BLACK, "peak", [(peak.k, peak.Omega_c) for peak in peaks])


def _row(
    axes: Axes, height: float, face: str, title: str, marked: Sequence[tuple[float, float]]
) -> None:
    """Draw a triangle and k at the speed of each engine order, with the row's title at the left."""
    across, speeds = axes.get_xaxis_transform(), [speed for _, speed in marked]
    axes.text(0.005, height, f"{title}, EO", transform=axes.transAxes, fontsize=7, va="center")
    axes.plot(
        speeds,
        [height] * len(speeds),
        "v",
        transform=across,
        label=title,
        color=style.BLACK,
        markerfacecolor=face,
        markersize=4,
        clip_on=False,
    )
    places = spread(np.array(speeds), LINE * np.ptp(axes.get_xlim()))
    for (k, _), place in zip(marked, places, strict=True):
        style.note(axes, (place, height), f"{k:.3g}", (0, 3.5), xycoords=across, ha="center")


def hatch(drawn: Figure, panels: Sequence[Axes], response: Response, observable: str) -> None:
    """Hatch speeds without a result, without contact, or with ``observable`` not predictable.

    A legend below the figure explains the hatches that occur, and the colour where nothing was run.
    """
    ends = Counter(response.status[~response.has_result].tolist())
    listed = "not ok: " + ", ".join(f"{status} ({n})" for status, n in ends.items())
    digits, share = -np.log10(GAP_CHANGE), 100 * SENSITIVE_FROM
    sensitive = (
        f"not predictable: changing all gaps by one part in $10^{{{digits:.0f}}}$ changes the "
        f"{observable} by over {share:g} %"
    )
    no_contact = response.status == "no-contact"
    white = {"facecolor": "white"}
    looks = (
        (~response.has_result, white | {"hatch": NO_RESULT}, listed),
        (no_contact, white | {"hatch": NO_CONTACT}, f"no contact ({no_contact.sum()})"),
        (response.sensitive(observable), {"fill": False, "hatch": NOT_PREDICTABLE}, sensitive),
    )
    handles = [Patch(facecolor=style.NO_RUN, label="no run")]
    for which, hatched, label in (look for look in looks if look[0].any()):
        look = {"edgecolor": style.GREY, "linewidth": 0} | hatched
        handles.append(Patch(label=label, **look))
        low, high = (ends[which] for ends in style.spans(response.speeds))
        separate = low[1:] != high[:-1]  # adjoining cells are in one band
        bands = zip(low[np.r_[True, separate]], high[np.r_[separate, True]], strict=True)
        for band, axes in product(bands, panels):
            axes.axvspan(*band, **look)
    drawn.legend(handles=handles, loc="outside lower left", handlelength=2.6, handleheight=1.3)


def frequencies_over_speed(rom: Rom, modes: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Speeds (POINTS,) up to Omega_m and the frequencies (POINTS, modes) there, over f1(0)."""
    unit = rom.omega1  # rad/s for 1 Hz of f1(0)
    speeds = np.linspace(0, rom.Omega_m, POINTS)
    frequencies = np.array([rom.modes(speed)[0][:modes] for speed in speeds])
    return speeds / unit, frequencies / unit


def spread(places: NDArray[np.float64], distance: float) -> NDArray[np.float64]:
    """``places`` (n,) in any order, moved to a distance of ``distance`` at least.

    The mean of the places moved upwards as little as needed and those moved downwards.

    >>> spread(np.array([3.0, 1.0, 1.5]), 1.0).tolist()
    [3.0, 0.75, 1.75]
    """
    steps = distance * places.argsort().argsort()
    above = places[:, None] >= places
    up = np.where(above, places - steps, -np.inf).max(axis=1, initial=-np.inf)
    down = np.where(above.T, places - steps, np.inf).min(axis=1, initial=np.inf)
    return (up + down) / 2 + steps
