"""Critical speeds of a blade, and how far they are from its operating speeds.

Linear crossings and rub peaks alike. Summary, Campbell diagram and page show these rows.
"""

from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby
from math import inf, isfinite
from operator import itemgetter
from typing import Any

from simulate.sweeps.result_types import mode_name, numbers_of, order_name
from workflow import markdown

WITHIN = 0.25  # of the operating speed: tables have the speeds within it
FURTHER = 3  # nearest of orders that nothing excites, in tables
SEEN = "seen"  # an engine order that is in the sweep's spectra
HEADS = [
    *("operating speed rpm", "critical speed", "mode", "EO", "excited by", "rpm"),
    *("speed margin", "frequency margin"),
]


# A critical speed with its uncertainty: keys of ``result_types.CriticalSpeed``, `rpm_error` (None,
# nan: not known), and `least`: whether a part of the error is not known.
type Critical = Mapping[str, Any]
type Margin = Mapping[str, Any]  # with its margins from an operating speed, as of ``rows``


def rows(
    campbell: Mapping[str, Any],
    peaks: Iterable[Critical] = (),
    relative: float = 0.0,
    least: bool = False,
    seen: Iterable[int] = (),
) -> list[Margin]:
    """Each critical speed with its margins from each operating speed, nearest first.

    Without operating speeds each once, without margins, slowest first.

    Parameters
    ----------
    campbell : as of ``simulate.sweeps.crossings.critical``
    peaks : rub peaks of a sweep, and ranges (``of_casing``)
    relative : error of the frequencies; with ``least`` a part of it is not known
    seen : engine orders in the spectra of that sweep
    """
    excited = dict.fromkeys(seen, SEEN) | dict(campbell["excited"])
    crossings = [
        {
            **crossing,
            "rpm_error": relative * crossing["rpm"]
            + abs(crossing["quadratic_rpm"] - crossing["rpm"]),
            "least": least,
        }
        for crossing in campbell["crossings"]
    ]
    # ``rpm_to``: end of a range
    critical = [{"rpm_to": None, **row} for row in (*crossings, *peaks)]
    return [
        {
            "line": name,  # of the operating speed; None without
            "line_rpm": rpm,
            **row,
            # by what its engine order is: a harmonic of the casing, a side band, or ``SEEN``
            "excited": excited.get(row["k"], "" if row["quadratic_rpm"] or row["rpm_to"] else SEEN),
            "speed_margin": rpm and _nearest(row, rpm) / rpm - 1,
            # (f - k Omega) / (k Omega) at the operating speed; None of a rub peak
            "frequency_margin": rpm
            and row["quadratic_rpm"]
            and campbell["Hz"][name][row["modes"][0] - 1] / (row["k"] * rpm / 60) - 1,
        }
        for name, rpm in (campbell["lines"] or {None: None}).items()
        for row in sorted(
            critical,
            key=lambda row, rpm=rpm: abs(_nearest(row, rpm) / rpm - 1) if rpm else row["rpm"],
        )
    ]


def _nearest(row: Critical, rpm: float) -> float:
    """The critical speed, or that of a range, which is nearest to ``rpm``."""
    end = row["rpm_to"]
    high = inf if end and row["bound"] else end or row["rpm"]
    return min(max(rpm, row["rpm"]), high)


def near(margins: Iterable[Margin]) -> list[Margin]:
    """Rub peaks and crossings within ``WITHIN`` of an operating speed, of excited orders first.

    Those of orders that the casing excites and the nearest others. Without operating speeds the
    former alone. A sweep's spectra change their order, and not which they are.
    """
    chosen = []
    for name, of_line in groupby(margins, key=itemgetter("line")):
        within = [row for row in of_line if abs(row["speed_margin"] or 0.0) <= WITHIN]
        others = [row for row in within if row["quadratic_rpm"] and row["excited"] in ("", SEEN)]
        left_out = others[FURTHER if name else 0 :]
        kept = [row for row in within if row not in left_out]
        chosen += sorted(kept, key=lambda row: not row["excited"])
    return chosen


def table(margins: Iterable[Margin]) -> list[list[str]]:
    """Cells, under ``HEADS``, of the rows that are near an operating speed."""
    return [
        [
            f"{row['line']} {row['line_rpm']:.0f}",
            row["what"],
            numbers_of(row["modes"]) or "-",
            f"{row['k']:g}",
            row["excited"] or "-",
            range_of(row) if row["rpm_to"] else speed(row),
            share(row["speed_margin"]),
            share(row["frequency_margin"]),
        ]
        for row in near(margins)
        if row["line"]
    ]


def speed(row: Critical) -> str:
    """A critical speed, rpm, with its uncertainty; one at an end of a sweep has none."""
    error = row["rpm_error"]
    if row["bound"] or not error:
        return f"{row['rpm']:.0f}{' (end: rises further)' * row['bound']}"
    bound = ("≥" if row["least"] else "±") + markdown.two_digits(error)
    return f"{row['rpm']:.0f} {bound if isfinite(error) else markdown.NOT_KNOWN}"


def range_of(met: Mapping[str, Any]) -> str:
    """Speeds, rpm, at which a casing meets the blade: from the free one to one in contact."""
    return f"{met['rpm']:.0f} to {met['rpm_to']:.0f}{' and above' * met['bound']}"


def of_casing(whirls: Iterable[Mapping[str, Any]]) -> list[Critical]:
    """The ``whirls`` of a scene as critical speeds."""
    return [
        {
            "what": f"fed by rotation, with order {mode['order']} of the casing",
            "modes": [met["mode"]],
            "k": met["f_over_Omega"],
            "rpm": met["rpm"],
            "rpm_to": met["rpm_to"],
            "quadratic_rpm": None,
            "bound": met["bound"],
            "rpm_error": None,
            "least": True,
        }
        for mode in whirls
        for met in mode["met"]
    ]


def fed(whirls: Iterable[Mapping[str, Any]]) -> Iterator[str]:
    """Where rotation feeds blade and casing in a lasting rub, for each pair of the casing."""
    for mode in whirls:
        ranges = ", ".join(f"mode {met['mode']} at {range_of(met)} rpm" for met in mode["met"])
        none = f"none of modes 1 to {mode['modes']} up to {mode['up_to']:.0f} rpm"
        yield (
            f"Fed by rotation with order {mode['order']} of the casing, {mode['Hz']:.6g} Hz (n Ω = "
            f"f + f_n, from the free blade to one in contact): {ranges or none}."
        )


def share(margin: float | None) -> str:
    """A margin in per cent, with its sign."""
    return "-" if margin is None else f"{100 * margin:+.1f} %"


def nearest(campbell: Mapping[str, Any], margins: Iterable[Margin], name: str) -> Iterator[str]:
    """The crossing next above and next below an operating speed, and the nearest rub peak, if any.

    A line each.
    """
    line_rpm = campbell["lines"][name]
    of_line = [row for row in margins if row["line"] == name]
    crossings = [row for row in of_line if row["quadratic_rpm"]]
    for side, sign, end in (("above", 1, campbell["up_to"]), ("below", -1, 0.0)):
        texts = [_text(row) for row in crossings if sign * (row["speed_margin"] or 0.0) > 0]
        found = [*texts, none_of(campbell, *sorted((line_rpm, end)))][0]
        yield f"{name.capitalize()} speed {line_rpm:.0f} rpm, next crossing {side}: {found}."
    for row in [row for row in of_line if not (row["quadratic_rpm"] or row["rpm_to"])][:1]:
        kind, *_ = row["what"].partition(" (")
        yield f"{name.capitalize()} speed {line_rpm:.0f} rpm, nearest {kind}: {_text(row)}."


def none_of(campbell: Mapping[str, Any], low: float, high: float) -> str:
    """That there is no critical speed, and where was looked: from ``low`` to ``high``, rpm."""
    return f"none of {looked_at(campbell)} from {low:.0f} to {high:.0f} rpm"


def looked_at(campbell: Mapping[str, Any]) -> str:
    """Modes and engine orders whose crossings are told.

    >>> looked_at({"modes": 4, "orders": [1, 2, 3, 4, 8, 20, 21]})
    'modes 1 to 4 with EO 1 to 4, 8, 20, 21'
    """
    rows = groupby(enumerate(campbell["orders"]), key=lambda numbered: numbered[1] - numbered[0])
    each = ([order for _, order in row] for _, row in rows)
    orders = (
        f"{row[0]} to {row[-1]}" if len(row) > 2 else ", ".join(map(str, row)) for row in each
    )
    modes = f"modes 1 to {campbell['modes']}" if campbell["modes"] > 1 else "mode 1"
    return f"{modes} with EO {', '.join(orders)}"


def _text(row: Margin) -> str:
    """A critical speed with its margins."""
    with_mode = " with ".join(filter(None, [order_name(row["k"]), mode_name(row["modes"])]))
    frequency = f", frequency {share(row['frequency_margin'])}"
    return (
        f"{speed(row)} rpm, {row['what']} of {with_mode}: speed {share(row['speed_margin'])}"
        f"{frequency * (row['frequency_margin'] is not None)}"
    )


def met(campbell: Mapping[str, Any]) -> Iterator[str]:
    """All linear crossings, a line for each mode; or that there is none."""
    if not campbell["crossings"]:
        yield f"Linear crossings: {none_of(campbell, 0.0, campbell['up_to'])}."
    by_mode = sorted(campbell["crossings"], key=lambda row: (row["modes"][0], row["rpm"]))
    for mode, of_mode in groupby(by_mode, key=lambda row: row["modes"][0]):
        speeds = ", ".join(f"EO {row['k']} {row['rpm']:.0f}" for row in of_mode)
        yield f"Linear crossings of mode {mode}, rpm: {speeds}."


def covered(campbell: Mapping[str, Any]) -> str:
    """Subject of the crossings, and how they are known."""
    ahead = ""
    if campbell["through"]:
        before, top = campbell["through"]
        ahead = (
            f" Above {top:.0f} rpm, the highest speed of the model, f² is extrapolated linearly in "
            f"Ω² from {before:.0f} and {top:.0f} rpm, up to {campbell['up_to']:.0f} rpm; ± "
            "includes the difference from the quadratic."
        )
    return (
        f"Crossings are those of {looked_at(campbell)} up to {campbell['up_to']:.0f} rpm."
        f"{ahead} Gyroscopic terms are not in the model."
    )
