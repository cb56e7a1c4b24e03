"""The stability matrix: how each of its cases ends.

Each is one of

right    It ended `ok`, and each observable is within its stated error of the reference.
flagged  Its status says that it has no result, or none that can be predicted.
refused  It was refused before the start, in one line for each fault.
wrong    None of these.

The stated error is what three times the halving of the step changes, and FLOOR at least; a run that
states more than ALLOWED is flagged `inaccurate`. The reference is the other scheme at a fine step
beside the same one; what the two span is not held against the run.
"""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from geometry.settings import SettingsError
from rom.model import Rom
from simulate.run import Outcome, SceneError, march
from simulate.twin import beside_twin
from workflow.study.stability_cases import EXACT, EXPLICIT, Case
from workflow.study.stability_runs import (
    Budget,
    Ready,
    Stretch,
    at,
    distance,
    observables,
    ready,
    refinement,
    run,
    stretch,
)

SAFETY = 3  # times the change by half the step: 2 for an order of one, and half as much again
FLOOR = 0.05  # least error that is stated
ALLOWED = 0.1  # most
ONE_LINE = re.compile(r"^(scene\.yaml: )?[\w.]+: .*(allowed|should be|needs|above)")


@dataclass(frozen=True)
class End:
    """How a case ended."""

    kind: str  # right, flagged, refused or wrong
    why: str  # status or key that it was refused for
    message: str = ""  # of the refusal
    steps: int = 0  # marched
    contact: bool = False
    numerical: float = 0.0  # energy over the casing's work
    stated: dict[str, float] = field(default_factory=dict)  # error
    error: dict[str, float] = field(default_factory=dict)  # against the reference
    spread: dict[str, float] = field(default_factory=dict)  # of the reference


def judge_case(case: Case, rom: Rom, budget: Budget) -> End:
    """March a case and its checks."""
    try:
        of = ready(case, rom)
    except (SettingsError, SceneError) as error:
        return _refused(str(error))
    span = stretch(of, budget)
    scene, setup = at(of, span, case.scheme)
    outcome = march(scene, setup)
    if outcome.status == "ok":
        outcome, _ = beside_twin(scene, setup, outcome)
    end = _end(outcome, setup.steps * span.rounds)
    if outcome.status != "ok":
        return End("flagged", outcome.status, **end)
    return _against_reference(of, span, outcome, end)


def _refused(message: str) -> End:
    lines = message.splitlines()
    kind = "refused" if all(map(ONE_LINE.match, lines)) else "wrong"
    key = lines[0].removeprefix("scene.yaml: ").split(":")[0]
    return End(kind, key, message)


def _end(outcome: Outcome, steps: int) -> dict[str, Any]:
    ledger = outcome.ledger
    share = ledger.numerical / ledger.casing if ledger.casing else 0.0
    return {"steps": steps, "contact": outcome.contact_share > 0, "numerical": share}


def _against_reference(of: Ready, span: Stretch, outcome: Outcome, end: dict[str, Any]) -> End:
    found = observables(outcome)
    half = run(of, span, of.case.scheme, 2)
    stated = {
        name: max(SAFETY * change, FLOOR)
        for name, change in distance(found, observables(half)).items()
    }
    references = _references(of, span)
    values = [observables(reference) for reference in references]
    error, spread = distance(found, *values), distance(values[0], values[1])
    numbers = end | {"stated": stated, "error": error, "spread": spread}
    if half.status != "ok" or max(stated.values()) > ALLOWED:
        return End("flagged", "inaccurate by halving", **numbers)
    if any(reference.status != "ok" for reference in references):
        return End("wrong", "reference ended otherwise", **numbers)
    if max(spread.values()) > ALLOWED:
        return End("wrong", "no reference", **numbers)
    right = all(error[name] <= stated[name] for name in error)
    return End("right" if right else "wrong", "ok", **numbers)


def _references(of: Ready, span: Stretch) -> tuple[Outcome, Outcome]:
    """The other scheme at a fine step and the same one; piecewise-exact twice where it is alone."""
    finer = refinement(of)
    exact = run(of, span, EXACT, finer)
    if of.scene.liner.rigid_key:
        return exact, run(of, span, EXACT, 2 * finer)
    return exact, run(of, span, EXPLICIT, finer)


def summarise(ends: Sequence[End]) -> dict[str, Any]:
    """Counts, and every end."""
    return {
        "cases": len(ends),
        "kinds": dict(Counter(end.kind for end in ends)),
        "right in contact": sum(end.kind == "right" and end.contact for end in ends),
        "why": {
            kind: dict(Counter(end.why for end in ends if end.kind == kind).most_common())
            for kind in ("flagged", "refused", "wrong")
        },
        "ends": [asdict(end) for end in ends],
    }


def models(blade: Rom, sixteen: Rom) -> Mapping[int, Rom]:
    """Reduced models by their interface nodes: one meets the liner with its first node alone."""
    from dataclasses import replace

    return {1: replace(blade, points=blade.points[:1]), 8: blade, 16: sixteen}
