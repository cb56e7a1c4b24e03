"""Margins of operating speeds: how far critical speeds are, linear crossings and rub peaks alike.

Summary, Campbell diagram and page show these rows, of the peaks by ``simulate.sweeps.peak``.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import isfinite
from typing import Any

from workflow import markdown

WITHIN = 0.25  # of the operating speed: tables have the speeds within it
HEADS = [
    *("operating speed rpm", "critical speed", "mode", "EO", "rpm"),
    *("speed margin", "frequency margin"),
]


def rows(
    found: Mapping[str, Any],
    peaks: Iterable[Mapping[str, Any]] = (),
    relative: float = 0.0,
    least: bool = False,
) -> list[dict[str, Any]]:
    """Each critical speed with its margins from each operating speed, nearest first.

    Parameters
    ----------
    found : as of ``simulate.sweeps.peak.critical``; empty without operating speeds
    peaks : of a sweep, each with ``what`` it is, k, rpm, rpm_error, and whether it is at an end of
        the sweep (``bound``)
    relative : error of the frequencies; with ``least`` a part of it is not known

    Returns
    -------
    Name and rpm of the operating line; kind of the critical speed, its mode (None of a rub peak),
    k, rpm, that of the quadratic, rpm_error (None, nan: not known) and ``bound``; the margins of
    speed, critical over operating speed less 1, and of frequency, (f - k Omega) / (k Omega) at the
    operating speed (None of a rub peak).
    """
    critical = [
        of
        | {
            "rpm_error": relative * of["rpm"] + abs(of["quadratic_rpm"] - of["rpm"]),
            "least": least,
        }
        for of in found.get("crossings", ())
    ]
    critical += [
        {
            "what": of["what"],
            "mode": None,
            "k": of["k"],
            "rpm": of["rpm"],
            "quadratic_rpm": None,
            "bound": of["bound"],
            "rpm_error": of["rpm_error"],
            "least": of["least"],
        }
        for of in peaks
    ]
    return [
        {
            "line": name,
            "line_rpm": at,
            **of,
            "speed_margin": of["rpm"] / at - 1,
            "frequency_margin": of["mode"]
            and found["Hz"][name][of["mode"] - 1] / (of["k"] * at / 60) - 1,
        }
        for name, at in found.get("lines", {}).items()
        for of in sorted(critical, key=lambda of, at=at: abs(of["rpm"] / at - 1))
    ]


def near(margins: Iterable[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Rows within ``WITHIN``."""
    return [row for row in margins if abs(row["speed_margin"]) <= WITHIN]


def table(margins: Iterable[Mapping[str, Any]]) -> list[list[str]]:
    """Cells, under ``HEADS``, of the rows that are near."""
    return [
        [
            f"{row['line']} {row['line_rpm']:.0f}",
            row["what"],
            markdown.cell(row["mode"]),
            str(row["k"]),
            speed(row),
            *(share(row[f"{of}_margin"]) for of in ("speed", "frequency")),
        ]
        for row in near(margins)
    ]


def speed(row: Mapping[str, Any]) -> str:
    """A critical speed, rpm, with its uncertainty; one at an end of a sweep has none."""
    error = row["rpm_error"]
    if row["bound"] or not error:
        return f"{row['rpm']:.0f}{' (end)' * row['bound']}"
    known = ("≥" if row["least"] else "±") + markdown.two_digits(error)
    return f"{row['rpm']:.0f} {known if isfinite(error) else markdown.NOT_KNOWN}"


def share(margin: float | None) -> str:
    """A margin in per cent, with its sign."""
    return "-" if margin is None else f"{100 * margin:+.1f} %"


def nearest(
    found: Mapping[str, Any],
    margins: Sequence[Mapping[str, Any]],
    name: str,
    of: str = "critical speed",
) -> Iterator[str]:
    """The critical speed next above and next below an operating speed, a line each.

    ``of``: name of the subject of the ``margins``.
    """
    for side, sign in (("above", 1), ("below", -1)):
        near = [row for row in margins if row["line"] == name and sign * row["speed_margin"] > 0]
        told = _told(near[0]) if near else "none" + f" up to {found['up_to']:.0f} rpm" * (sign > 0)
        yield f"{name.capitalize()} speed {found['lines'][name]:.0f} rpm, next {of} {side}: {told}."


def _told(row: Mapping[str, Any]) -> str:
    """A critical speed with its margins."""
    mode, frequency = f" with mode {row['mode']}", f", frequency {share(row['frequency_margin'])}"
    return (
        f"{speed(row)} rpm, {row['what']} of EO {row['k']}{mode * bool(row['mode'])}: "
        f"speed {share(row['speed_margin'])}{frequency * bool(row['mode'])}"
    )


def covered(found: Mapping[str, Any], swept: Sequence[float]) -> str:
    """Subject of the margins; ``swept``: slowest and fastest run with a result, rpm, if any."""
    orders, of_f1 = (", ".join(map(str, found[of])) for of in ("orders", "peaks"))
    before, top = found["through"]
    further = f", of mode 1 with EO {of_f1}" if of_f1 else ""
    rub = f", and of rub peaks from {swept[0]:.0f} to {swept[-1]:.0f} rpm" if swept else ""
    return (
        f"Margins are of crossings of modes 1 to {found['modes']} with EO {orders}{further}{rub}. "
        f"Above {top:.0f} rpm, the highest speed of the model, f² is extrapolated linearly in Ω² "
        f"from {before:.0f} and {top:.0f} rpm, up to {found['up_to']:.0f} rpm; ± includes the "
        "difference from the quadratic. Gyroscopic terms are not in the model."
    )
