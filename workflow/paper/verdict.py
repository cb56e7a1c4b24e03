"""Verdict on a claim, computed from our numbers, their uncertainty and that of the paper."""

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
NO_PEAK = "a peak is missing"
HOLDS = ("reproduced", "reproduced in kind", "calibrated")  # whether numbers agree or not


@dataclass(frozen=True)
class Judged:
    """What a verdict depends on."""

    name: str
    ours: float  # value shown in the table
    # the paper's number or statement is a datum of ours: that it agrees or holds is no result
    calibrated: bool = field(default=False, kw_only=True)
    resolution: float = field(default=0.0, kw_only=True)  # least uncertainty

    @property
    def label(self) -> str:
        """Its name, marked if it was calibrated."""
        return self.name + " (calibrated)" * self.calibrated


@dataclass(frozen=True)
class Value(Judged):
    """Our value, and the range in which it agrees with the paper's."""

    low: float  # low to high: range that agrees with the paper, for its rounding
    high: float

    def agrees(self, uncertainty: float) -> bool:
        """Whether our value lies in the range, extended by our uncertainty."""
        return self.low - uncertainty <= self.ours <= self.high + uncertainty


@dataclass(frozen=True)
class Statement(Judged):
    """A statement of the paper without a number: it holds if ``margin`` is above 0."""

    margin: float

    def holds(self, uncertainty: float) -> bool | None:
        """Whether it holds; None if the margin is below its uncertainty."""
        return None if abs(self.margin) < uncertainty else self.margin > 0


def more(
    name: str, ours: float, than: float, resolution: float = 0.0, calibrated: bool = False
) -> Statement:
    """The statement that ``ours`` is more than ``than``."""
    return Statement(name, ours, ours - than, resolution=resolution, calibrated=calibrated)


def less(
    name: str, ours: float, than: float, resolution: float = 0.0, calibrated: bool = False
) -> Statement:
    """The statement that ``ours`` is less than ``than``."""
    return Statement(name, ours, than - ours, resolution=resolution, calibrated=calibrated)


def equal(name: str, ours: float, to: float, calibrated: bool = False) -> Statement:
    """The statement that the count ``ours`` is ``to``."""
    return Statement(name, ours, 0.5 - abs(ours - to), calibrated=calibrated)


@dataclass(frozen=True)
class Finding:
    """Our results for one claim."""

    values: tuple[Value, ...] = ()
    statements: tuple[Statement, ...] = ()
    shown: Mapping[str, float] = field(default_factory=dict)  # numbers shown, but not judged
    because: str = ""  # explanation of a difference
    by_setting: bool = False  # a setting of the scene decides it, on any blade

    @property
    def judged(self) -> tuple[Judged, ...]:
        """All statements and values that the verdict depends on."""
        return (*self.statements, *self.values)

    @property
    def quantities(self) -> dict[str, float]:
        """Quantities with an uncertainty: each value and each statement's margin, by name."""
        return {v.name: v.ours for v in self.values} | {s.name: s.margin for s in self.statements}


@dataclass(frozen=True)
class Claim:
    """One claim of the paper."""

    id: str
    where: str
    says: str
    paper: str  # its number
    figure: str  # our figure of it; empty without one
    find: Callable[[Numbers], Finding]


def uncertainties(finding: Finding, repeats: Iterable[Finding]) -> dict[str, float]:
    """Largest change of each quantity in the repeats, or its resolution where that is more."""
    others, quantities = [repeat.quantities for repeat in repeats], finding.quantities
    return {
        part.name: max(
            part.resolution,
            *(
                abs(other[part.name] - quantities[part.name])
                for other in others
                if part.name in other
            ),
            0.0,
        )
        for part in finding.judged
    }


def verdict(finding: Finding, uncertainty: Mapping[str, float], fitted: bool = True) -> str:
    """One of ``VERDICTS``.

    `reproduced`: all statements hold and all values agree. `reproduced in kind`: there are
    statements and all hold, but a value does not agree. `undecided`: no statement fails, but one is
    within its uncertainty. `calibrated`: either of the first two, where all was a datum of ours.
    `not comparable`: the paper gives nothing to compare. Else `differs`.

    ``fitted``: whether the numbers were; on another blade the same claim is a prediction.
    """
    if not finding.values and not finding.statements:
        return "not comparable"
    holds = [s.holds(uncertainty[s.name]) for s in finding.statements]
    agree = all(v.agrees(uncertainty[v.name]) for v in finding.values)
    if False in holds:
        return "differs"
    if None in holds:
        return "undecided"
    if not agree and not holds:
        return "differs"
    if (fitted or finding.by_setting) and all(judged.calibrated for judged in finding.judged):
        return "calibrated"
    return "reproduced" if agree else "reproduced in kind"


def judge(
    claim: Claim,
    numbers: Numbers,
    repeats: Mapping[str, Numbers],
    like: Mapping[str, float] | None = None,
    fitted: bool = True,
) -> dict[str, Any]:
    """Row of the claims table; `not judged` if ``numbers`` lack a quantity of the claim.

    ``like``: uncertainties by quantity, for numbers without repeats of their own. ``fitted``: as of
    ``verdict``.
    """
    finding, missing = _finding(claim, numbers)
    again = {name: _finding(claim, n) for name, n in repeats.items()} if not missing else {}
    repeated = {name: repeat for name, (repeat, lacking) in again.items() if not lacking}
    uncertainty = uncertainties(finding, repeated.values()) | (like or {})
    return {
        **{key: getattr(claim, key) for key in ("id", "where", "says", "paper", "figure")},
        "ours": {x.label: x.ours for x in finding.judged} | {**finding.shown},
        "uncertainty": {x.label: uncertainty[x.name] for x in finding.judged} if repeated else {},
        "repeats": sorted(repeated),
        "tolerance": {v.label: [v.low, v.high] for v in finding.values},
        # statements that do not hold or are undecided, values that do not agree
        "failed": [
            *(s.label for s in finding.statements if not s.holds(uncertainty[s.name])),
            *(v.label for v in finding.values if not v.agrees(uncertainty[v.name])),
        ],
        "verdict": "not judged" if missing else verdict(finding, uncertainty, fitted),
        "by_quantity": uncertainty,
        "because": missing or finding.because,
    }


def _finding(claim: Claim, numbers: Numbers) -> tuple[Finding, str]:
    """Our results for a claim, and what is missing, if any: a part that was not run, or a peak."""
    try:
        return claim.find(numbers), ""
    except KeyError as missing:
        return Finding(), f"missing: {missing}"
    except TypeError:
        return Finding(), NO_PEAK
