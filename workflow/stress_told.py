"""What is told of the stress of a rub: bounds where a motion grows, and what is left out.

Light: Snakemake imports the summary, which has these lines. ``stress``: as of
``workflow.stress.write``.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from simulate.errors.schema import of_peaks
from simulate.scene import GROWING
from workflow.markdown import Number, percent

STRESS = ("mean_stress", "alternating", "margin")  # numbers of ``stress.json``, there too
ALL = "all"  # of what is not known: of all numbers
RISES = "↑"
STANDS_OUT = 1.25  # alternating stress of a node over the largest around it: no smooth field
EARLIER = 1.005  # largest change between any two instants over that of one revolution: it is told
NEARLY = 0.05  # of the swing, which a growing motion gains in as many revolutions again


def bound(name: str, trend: str | None) -> str:
    """What stands before a number of stress: of a motion that still grows it is a bound.

    >>> bound("alternating", "growing"), bound("margin", "growing"), bound("margin", "steady")
    ('> ', 'at most ', '')
    """
    grows = {"alternating": "> ", "damage": "> ", "margin": "at most "}
    return grows.get(name, "") if trend == GROWING else ""


def growing(course: Mapping[str, Any]) -> str:
    """The trend of a run; of one that grows by how much more in as many revolutions again.

    >>> growing({"trend": "growing", "grows": 0.02, "grows_in": 80})
    'growing, nearly over (2 % in 80 rev.)'
    """
    trend, grows = course.get("trend", "-"), course.get("grows")
    if grows is None:
        return trend
    nearly = ", nearly over" if grows < NEARLY else ""
    return f"{trend}{nearly} ({percent(grows)} in {course['grows_in']:.0f} rev.)"


def where(stress: Mapping[str, Any]) -> str:
    """The part of the blade whose stress is read."""
    away = f"{1e3 * stress['away_m']:.3g} mm from the clamp and farther"
    if stress["root"] == "fillet":
        return f"local, with the fillet, {away if stress['away_m'] else 'but for its edge'}"
    return f"nominal, of the airfoil {away}; the concentration factor of the root is not included"


def worst(stress: Mapping[str, Any], answer: Mapping[str, Any] | None) -> list[str]:
    """Lines on the worst speed, with its node, and what its numbers are worth.

    ``answer``: of that speed, as of ``workflow.summary.PeakRow``, where there is one.
    """
    rows = stress["speeds"]
    known = [row for row in rows if "alternating" in row]
    if stress["worst"] is None:
        return []
    row = next(row for row in known if row["speed_over_f1"] == stress["worst"])
    of, ends = _numbers(row, answer), (rows[0], rows[-1])
    at = ", ".join(f"{x:.4g}" for x in row["at"])
    rises = f"; it rises further towards {row['rises']}" if row["rises"] else ""
    beyond = "; it may rise further beyond the sweep" * (len(rows) > 1 and row in ends)
    grows = sum(row["trend"] == GROWING for row in known)
    bounds = f"; at {grows} the motion still grows, and its stress is a lower bound" * bool(grows)
    margin = f", {'margin' if stress['root'] == 'fillet' else 'margin of the airfoil'} "
    return [
        f"Worst stress ({where(stress)}): {row['rpm']:.0f} rpm, "
        f"revolution {row['revolution']}, x, y, z = {at} {row['unit']}: mean {of['mean_stress']}, "
        f"alternating {of['alternating']}{margin + of['margin'] if 'margin' in of else ''}"
        f"{rises}{beyond}. It is the worst of {len(known)} of {len(rows)} speeds{bounds}.",
        *_doubts(row, stress),
    ]


def shown(row: Mapping[str, Any], name: str) -> str:
    """A number of a told speed, to the digits that its error by the mesh allows."""
    return _number(row, name, None)[0]


def _number(row: Mapping[str, Any], name: str, answer: Any) -> tuple[str, str]:
    """The number and its ±; without an ``answer`` that by the mesh is known alone."""
    _, scale = of_peaks()[name].shown
    errors, unknown = (answer["errors"], answer["unknown"]) if answer else ({}, {ALL: ["runs"]})
    error = errors.get(name, abs(row[name]) * row["mesh"][name])
    least = name not in errors or bool(unknown[ALL])
    number = Number(scale * row[name], error and scale * error, least=least)
    return bound(name, row["trend"]) + number.shown, number.share


def _numbers(row: Mapping[str, Any], answer: Any) -> dict[str, str]:
    """The numbers of a speed by name."""
    units = dict.fromkeys(STRESS, " MPa") | {"margin": ""}
    texts = {name: _number(row, name, answer) for name in STRESS if name in row}
    return {name: f"{shown}{units[name]} {share}" for name, (shown, share) in texts.items()}


def _doubts(row: Mapping[str, Any], stress: Mapping[str, Any]) -> Iterator[str]:
    """Cycles of the run beside those of the endurance; why the number may be another one."""
    if "cycles" in row:
        yield (
            f"The margin is to the endurance at 1e7 cycles: this run has {row['cycles']}, and 1e7 "
            f"take {row['endurance_s']:.3g} s at that speed."
        )
    if row["between"] > EARLIER * row["alternating"]:
        shown_there = shown(row | {"alternating": row["between"]}, "alternating")
        yield (
            f"Between any two instants of the revolutions kept the alternating stress there is "
            f"{shown_there} MPa."
        )
    if row["stands_out"] > STANDS_OUT:
        yield (
            f"The node of the worst stress stands out of those around it by "
            f"{percent(row['stands_out'] - 1)}: that is the mesh's."
        )
    if nearer := row.get("nearer"):
        of = _numbers(nearer | {"trend": row["trend"]}, None)
        margin = f", margin {of['margin']}" if "margin" in of else ""
        yield (
            f"Down to {500 * stress['away_m']:.3g} mm from the clamp: alternating "
            f"{of['alternating']}{margin}."
        )
    if stress["too_near"]:
        yield (
            f"Warning: at a sharp clamp the stress has no limit, and depends on the mesh nearer "
            f"than {1e3 * stress['too_near']:.3g} mm, half the thickness: raise stress.away_mm."
        )
