"""How a claim is judged: from numbers, their own uncertainty and the paper's, never by hand."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

type Numbers = Mapping[str, Any]
VERDICTS = (
    "reproduced",
    "reproduced in kind",
    "undecided",
    "differs",
    "calibrated",
    "not comparable",
    "not judged",
)


@dataclass(frozen=True)
class Value:
    """A number of the paper's, and ours."""

    name: str
    ours: float
    low: float  # what agrees with the paper: its own rounding, and what it leaves open
    high: float
    calibrated: bool = False  # on the paper's number: agreement is no finding
    resolution: float = 0.0  # what it is known to at best

    def agrees(self, uncertainty: float) -> bool:
        """Whether ours lies in the paper's range; a difference within our uncertainty is none."""
        return self.low - uncertainty <= self.ours <= self.high + uncertainty


@dataclass(frozen=True)
class Statement:
    """Something the paper says without a number: it holds where ``margin`` is above 0."""

    name: str
    ours: float  # what is shown
    margin: float
    resolution: float = 0.0  # what it is known to at best

    def holds(self, uncertainty: float) -> bool | None:
        """None where the margin is less than its own uncertainty."""
        return None if abs(self.margin) < uncertainty else self.margin > 0


def more(name: str, ours: float, than: float, resolution: float = 0.0) -> Statement:
    """``ours`` is more than ``than``."""
    return Statement(name, ours, ours - than, resolution)


def less(name: str, ours: float, than: float, resolution: float = 0.0) -> Statement:
    """``ours`` is less than ``than``."""
    return Statement(name, ours, than - ours, resolution)


def equal(name: str, ours: float, to: float) -> Statement:
    """A count is what it should be."""
    return Statement(name, ours, 0.5 - abs(ours - to))


@dataclass(frozen=True)
class Finding:
    """What our results say to one claim."""

    values: tuple[Value, ...] = ()
    statements: tuple[Statement, ...] = ()
    shown: Mapping[str, float] = field(default_factory=dict)  # what is told, and not judged
    because: str = ""  # what is known of why it is so

    @property
    def judged(self) -> tuple[Value | Statement, ...]:
        """All that a verdict is made of."""
        return (*self.statements, *self.values)

    @property
    def quantities(self) -> dict[str, float]:
        """What the uncertainty is of: each value and each statement's margin, by name."""
        return {v.name: v.ours for v in self.values} | {s.name: s.margin for s in self.statements}


@dataclass(frozen=True)
class Claim:
    """One claim of the paper."""

    id: str
    where: str
    says: str
    paper: str  # its number
    figure: str  # of ours; empty where none shows it
    find: Callable[[Numbers], Finding]


def uncertainties(finding: Finding, repeats: Iterable[Finding]) -> dict[str, float]:
    """Largest change of each quantity in the repeats, or its resolution where that is more."""
    others, here = [repeat.quantities for repeat in repeats], finding.quantities
    return {
        one.name: max(
            one.resolution,
            *(abs(other[one.name] - here[one.name]) for other in others if one.name in other),
            0.0,
        )
        for one in finding.judged
    }


def verdict(finding: Finding, uncertainty: Mapping[str, float]) -> str:
    """One of ``VERDICTS``.

    `reproduced`: all statements hold and all values agree. `reproduced in kind`: all statements
    hold, at least one, but a value does not agree. `undecided`: no statement fails, but one is
    within its own uncertainty. `calibrated`: agrees, and was made to. `not comparable`: the paper
    gives nothing to compare. Else `differs`.
    """
    if not finding.values and not finding.statements:
        return "not comparable"
    holds = [s.holds(uncertainty[s.name]) for s in finding.statements]
    agree = all(v.agrees(uncertainty[v.name]) for v in finding.values)
    if False in holds:
        return "differs"
    if None in holds:
        return "undecided"
    if agree:
        made_to = finding.values and all(value.calibrated for value in finding.values)
        return "calibrated" if made_to and not holds else "reproduced"
    return "reproduced in kind" if holds else "differs"


def judge(
    claim: Claim,
    numbers: Numbers,
    repeats: Mapping[str, Numbers],
    like: Mapping[str, float] | None = None,
) -> dict[str, Any]:
    """Row of the claims table; `not judged` where ``numbers`` lack what the claim needs.

    ``like``: uncertainties by quantity, of numbers without repeats of their own.
    """
    row = {key: getattr(claim, key) for key in ("id", "where", "says", "paper", "figure")}
    try:
        finding = claim.find(numbers)
    except (KeyError, TypeError) as missing:
        return row | NOTHING | {"verdict": "not judged", "because": f"missing: {missing}"}
    repeated = {name: again for name, n in repeats.items() if (again := _found(claim, n))}
    uncertainty = uncertainties(finding, repeated.values()) | (like or {})
    return row | {
        "ours": {_told(x): x.ours for x in finding.judged} | {**finding.shown},
        "uncertainty": {_told(x): uncertainty[x.name] for x in finding.judged} if repeated else {},
        "repeats": sorted(repeated),
        "tolerance": {_told(v): [v.low, v.high] for v in finding.values},
        "failed": _failed(finding, uncertainty),
        "verdict": verdict(finding, uncertainty),
        "by_quantity": uncertainty,
        "because": finding.because,
    }


NOTHING = {
    "ours": {},
    "uncertainty": {},
    "repeats": [],
    "tolerance": {},
    "failed": [],
    "by_quantity": {},
}


def _told(judged: Value | Statement) -> str:
    """Name as it is told: with a mark where the number was calibrated."""
    return judged.name + " (calibrated)" * getattr(judged, "calibrated", False)


def _found(claim: Claim, numbers: Numbers) -> Finding | None:
    try:
        return claim.find(numbers)
    except (KeyError, TypeError):  # a part that was not run, a peak that is not there
        return None


def _failed(finding: Finding, uncertainty: Mapping[str, float]) -> list[str]:
    """Names of what does not agree, or is not decided."""
    statements = [_told(s) for s in finding.statements if not s.holds(uncertainty[s.name])]
    return statements + [_told(v) for v in finding.values if not v.agrees(uncertainty[v.name])]
