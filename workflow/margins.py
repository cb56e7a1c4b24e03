"""Margins of operating speeds: how far critical speeds are, linear crossings and rub peaks alike.

Summary, Campbell diagram and page show these rows, of the peaks by ``simulate.sweeps.peak``.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import isfinite
from typing import Any, TypedDict

from simulate.sweeps.plain import CriticalSpeed
from workflow import markdown

WITHIN = 0.25  # of the operating speed: tables have the speeds within it
HEADS = [
    *("operating speed rpm", "critical speed", "mode", "EO", "rpm"),
    *("speed margin", "frequency margin"),
]


class Speed(TypedDict):
    """A speed with its uncertainty."""

    rpm: float
    rpm_error: float | None  # None, nan: not known
    least: bool  # a part of the error is not known
    bound: bool  # at an end of a sweep


class Critical(CriticalSpeed, Speed):
    """A critical speed with its uncertainty."""


class Margin(Critical):
    """A critical speed with its margins from an operating speed."""

    line: str  # name of the operating speed
    line_rpm: float
    speed_margin: float  # critical over operating speed less 1
    frequency_margin: float | None  # (f - k Omega) / (k Omega) there; None of a rub peak


def rows(
    campbell: Mapping[str, Any],
    peaks: Iterable[Critical] = (),
    relative: float = 0.0,
    least: bool = False,
) -> list[Margin]:
    """Each critical speed with its margins from each operating speed, nearest first.

    Parameters
    ----------
    campbell : as of ``simulate.sweeps.peak.critical``; empty without operating speeds
    peaks : rub peaks of a sweep
    relative : error of the frequencies; with ``least`` a part of it is not known
    """
    crossings = [
        Critical(
            **crossing,
            rpm_error=relative * crossing["rpm"] + abs(crossing["quadratic_rpm"] - crossing["rpm"]),
            least=least,
        )
        for crossing in campbell.get("crossings", ())
    ]
    return [
        Margin(
            line=name,
            line_rpm=line_rpm,
            **row,
            speed_margin=row["rpm"] / line_rpm - 1,
            frequency_margin=row["mode"]
            and campbell["Hz"][name][row["mode"] - 1] / (row["k"] * line_rpm / 60) - 1,
        )
        for name, line_rpm in campbell.get("lines", {}).items()
        for row in sorted(
            [*crossings, *peaks], key=lambda row, rpm=line_rpm: abs(row["rpm"] / rpm - 1)
        )
    ]


def near(margins: Iterable[Margin]) -> list[Margin]:
    """Rows within ``WITHIN``."""
    return [row for row in margins if abs(row["speed_margin"]) <= WITHIN]


def table(margins: Iterable[Margin]) -> list[list[str]]:
    """Cells, under ``HEADS``, of the rows that are near."""
    return [
        [
            f"{row['line']} {row['line_rpm']:.0f}",
            row["what"],
            markdown.cell(row["mode"]),
            str(row["k"]),
            speed(row),
            share(row["speed_margin"]),
            share(row["frequency_margin"]),
        ]
        for row in near(margins)
    ]


def speed(row: Speed) -> str:
    """A critical speed, rpm, with its uncertainty; one at an end of a sweep has none."""
    error = row["rpm_error"]
    if row["bound"] or not error:
        return f"{row['rpm']:.0f}{' (end)' * row['bound']}"
    bound = ("≥" if row["least"] else "±") + markdown.two_digits(error)
    return f"{row['rpm']:.0f} {bound if isfinite(error) else markdown.NOT_KNOWN}"


def share(margin: float | None) -> str:
    """A margin in per cent, with its sign."""
    return "-" if margin is None else f"{100 * margin:+.1f} %"


def nearest(
    campbell: Mapping[str, Any],
    margins: Sequence[Margin],
    name: str,
    subject: str = "critical speed",
) -> Iterator[str]:
    """The critical speed next above and next below an operating speed, a line each.

    ``subject``: name of the subject of the ``margins``.
    """
    for side, sign in (("above", 1), ("below", -1)):
        near = [row for row in margins if row["line"] == name and sign * row["speed_margin"] > 0]
        text = (
            _with_margins(near[0])
            if near
            else "none" + f" up to {campbell['up_to']:.0f} rpm" * (sign > 0)
        )
        yield (
            f"{name.capitalize()} speed {campbell['lines'][name]:.0f} rpm, "
            f"next {subject} {side}: {text}."
        )


def _with_margins(row: Margin) -> str:
    """A critical speed with its margins."""
    mode, frequency = f" with mode {row['mode']}", f", frequency {share(row['frequency_margin'])}"
    return (
        f"{speed(row)} rpm, {row['what']} of EO {row['k']}{mode * bool(row['mode'])}: "
        f"speed {share(row['speed_margin'])}{frequency * bool(row['mode'])}"
    )


def covered(campbell: Mapping[str, Any], swept: Sequence[float]) -> str:
    """Subject of the margins; ``swept``: slowest and fastest run with a result, rpm, if any."""
    orders, orders_of_f1 = (", ".join(map(str, campbell[key])) for key in ("orders", "peaks"))
    before, top = campbell["through"]
    further = f", of mode 1 with EO {orders_of_f1}" if orders_of_f1 else ""
    rub = f", and of rub peaks from {swept[0]:.0f} to {swept[-1]:.0f} rpm" if swept else ""
    return (
        f"Margins are of crossings of modes 1 to {campbell['modes']} with EO {orders}{further}"
        f"{rub}. Above {top:.0f} rpm, the highest speed of the model, f² is extrapolated linearly "
        f"in Ω² from {before:.0f} and {top:.0f} rpm, up to {campbell['up_to']:.0f} rpm; ± includes "
        "the difference from the quadratic. Gyroscopic terms are not in the model."
    )
