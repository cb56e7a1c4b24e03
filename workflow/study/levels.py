"""Pareto front of error and time of each scene, and the cheapest setting for each level."""

from collections.abc import Iterator, Sequence
from itertools import accumulate
from math import inf

from workflow.study.trade import Row

OBSERVABLES = ("amplitude", "Omega_c", "wear", "lobes", "force", "history")  # of the tables
JUDGED = ("amplitude", "wear", "force", "history")  # over which the largest error is taken
SCENES = ("calm", "resonance", "stiff", "tangential")
PEAK = "peak"  # scene of the sweep whose critical speed belongs to the run at resonance
FINEST, COARSER, OTHER_SCHEME = (
    "finest",
    "one level coarser",
    "central-difference, 0.2 of the limit",
)
LEVELS = {"draft": 0.1, "standard": 0.03, "reference": 0.01}  # largest error over all scenes
# Runs of the target `paper`, with twins, by the most similar scene. calm: coatings of the grid up
# to E = 4.55 and the sweep of E = 1; stiff: coatings above, E = 10 and the rigid liner; tangential:
# both scenes with a tilted tip.
MARCHES = {"calm": 1700, "stiff": 3400, "tangential": 250}

type Errors = dict[str, float | None]  # by observable


def of_group(rows: Sequence[Row], *groups: str) -> list[Row]:
    """Rows of groups on the scenes, with their errors; that of Omega_c is from the sweep."""
    of = {(row["group"], row["row"]): row["numbers"] for row in rows if row["scene"] == PEAK}
    found = []
    for row in rows:
        if row["group"] in groups and row["scene"] in SCENES and "errors" in row["numbers"]:
            peak = of.get((row["group"], row["row"])) if row["scene"] == "resonance" else None
            errors = {"Omega_c": None} | row["numbers"]["errors"] | (peak or {}).get("errors", {})
            found.append(row | {"errors": errors})
    return found


def uncertainty(rows: Sequence[Row], scene: str) -> Errors:
    """Uncertainty of the reference: what one level coarser, or another scheme, changes."""
    changes = [
        row["errors"]
        for row in of_group(rows, "finest", "scheme")
        if row["scene"] == scene and row["row"] in (COARSER, OTHER_SCHEME)
    ]
    known = {name: [of[name] for of in changes if of[name] is not None] for name in OBSERVABLES}
    return {name: max(values, default=None) for name, values in known.items()}


def worst(of: Errors) -> float:
    """Largest error of the observables in ``JUDGED``; inf if one is missing."""
    values = [of[name] for name in JUDGED]
    return inf if None in values else float(max(values))


def front(rows: Sequence[Row], scene: str) -> list[Row]:
    """The Pareto-optimal rows of a scene: no other has less cost and less error."""
    own = [row for row in of_group(rows, "front") if row["scene"] == scene]
    own.sort(key=lambda row: (row["cpu_s"], worst(row["errors"])))
    errors = [worst(row["errors"]) for row in own]
    cheaper = accumulate(errors, min, initial=inf)  # least error of all with less cost
    return [row for row, error, least in zip(own, errors, cheaper, strict=False) if error < least]


def levels(rows: Sequence[Row]) -> list[Row]:
    """For each level the cheapest setting that meets it on all scenes, or the most accurate."""
    settings = [*_settings(of_group(rows, "front"))]
    return [{"level": level} | _cheapest(settings, allowed) for level, allowed in LEVELS.items()]


def _cheapest(settings: Sequence[Row], allowed: float) -> Row:
    meet = [s for s in settings if s["worst"] < allowed]
    best = min(meet or settings, key=lambda s: s["paper_min"] if meet else s["worst"])
    return {"allowed": allowed, "met": bool(meet)} | best


def _settings(tried: Sequence[Row]) -> Iterator[Row]:
    """Each setting with its rows, by scene, its largest error, and its time for all of `paper`."""
    for name in dict.fromkeys(row["row"] for row in tried):
        rows = {row["scene"]: row for row in tried if row["row"] == name}
        yield {
            "row": name,
            "of": rows,
            "worst": max(worst(row["errors"]) for row in rows.values()),
            "paper_min": paper_minutes(rows),
        }


def paper_minutes(rows: dict[str, Row]) -> float:
    """CPU time, min, of all runs of the target `paper`; ``rows`` of one setting by scene."""
    return (
        sum(count * rows[scene]["cpu_s"] for scene, count in MARCHES.items() if scene in rows) / 60
    )
