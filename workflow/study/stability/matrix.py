"""The stability matrix: outcome of each of its cases.

right    Its status is `ok`, and every observable is within the stated error of the reference.
flagged  Its status says that it has no result, or none that can be predicted.
refused  Before the start, with one line for each fault.
wrong    None of these.
unjudged `ok`, but the two references differ, or did not end `ok`: there is no reference.

The status is that of the run with its twin, as in a sweep, and then that of halving the step: `ok`
states an error of at most 0.1 (``simulate.halving``). The reference is marched by both schemes with
a fine step; the difference of the two does not count as an error of the run.
"""

import re
from collections import Counter
from dataclasses import asdict, dataclass, field, replace
from time import process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.settings import SettingsError
from rom.model import Rom
from simulate.halving import STATED, Observables, beside_halved, changes, observables
from simulate.run import Outcome, march
from simulate.setup import SceneError
from simulate.twin import beside_twin
from workflow.study.stability.cases import Case, draw
from workflow.study.stability.runs import Ready, ready, references

CASES = 500
A_REFUSAL = re.compile(r"(scene\.yaml: )?[\w.]+: .*(allowed|should be|needs)")


@dataclass(frozen=True)
class End:
    """Outcome of a case."""

    kind: str
    why: str  # status, or the key that was refused
    message: str = ""  # of a refusal
    steps: int = 0  # marched
    contact: bool = False
    numerical: float = 0.0  # energy over the casing's work
    alone: str = ""  # status without halving
    change: dict[str, float] = field(default_factory=dict)  # relative, by halving the step
    error: dict[str, float] = field(default_factory=dict)  # relative, against the reference
    spread: dict[str, float] = field(default_factory=dict)  # of the reference


def judge_case(case: Case, rom: Rom) -> End:
    """March a case and its checks."""
    try:
        of = ready(case, rom)
    except (SettingsError, SceneError) as error:
        return _refused(str(error))
    outcome = march(of.scene, of.setup)
    if outcome.status == "ok":
        outcome, _ = beside_twin(of.scene, of.setup, outcome)
    end = _end(of, outcome)
    return end if outcome.status != "ok" else _against_reference(of, outcome, end)


def _refused(message: str) -> End:
    lines = message.splitlines()
    well = all(map(A_REFUSAL.match, lines))
    key = lines[0].removeprefix("scene.yaml: ").split(":")[0]
    return End("refused" if well else "wrong", key, message)


def _end(of: Ready, outcome: Outcome) -> End:
    """Outcome of a run by its status alone: flagged, until compared with the reference."""
    ledger = outcome.ledger
    return End(
        kind="flagged",
        why=outcome.status,
        steps=of.setup.steps * of.scene.rounds,
        contact=outcome.contact_share > 0,
        numerical=ledger.numerical / ledger.casing if ledger.casing else 0.0,
        alone=outcome.status,
    )


def _against_reference(of: Ready, outcome: Outcome, end: End) -> End:
    judged, change = beside_halved(of.scene, of.rom, of.setup, outcome)
    runs = references(of)
    own, one, other = map(observables, (outcome, *runs))
    error, spread = changes(own, _nearest(own, one, other)), changes(one, other)
    end = replace(end, change=change, error=error, spread=spread)
    if judged.status != "ok":
        return replace(end, why=f"{judged.status} by halving")
    usable = all(run.status in ("ok", "inaccurate") for run in runs)  # checked by their difference
    if not usable or max(spread.values()) > STATED:
        return replace(end, kind="unjudged", why="no reference")
    return replace(end, kind="right" if max(error.values()) <= STATED else "wrong")


def _nearest(own: Observables, one: Observables, other: Observables) -> Observables:
    """For each observable, the point between the two references that is closest to the run."""
    return {name: _closest_between(values, one[name], other[name]) for name, values in own.items()}


def _closest_between(
    own: NDArray[np.float64], one: NDArray[np.float64], other: NDArray[np.float64]
) -> NDArray[np.float64]:
    difference = (other - one).ravel()
    length = float(difference @ difference)
    share = float((own - one).ravel() @ difference) / length if length else 0.0
    return one + min(max(share, 0.0), 1.0) * (other - one)


def hidden(end: End) -> bool:
    """Whether an error above the stated one is `ok` without halving."""
    return end.alone == "ok" and max(end.error.values()) > STATED


def numbers(files: Any) -> dict[str, Any]:
    """All cases on the reduced model ``files.rom``: counts by outcome, and each case."""
    start, rom = process_time(), Rom.load(files.rom)
    ends = [judge_case(draw(number), rom) for number in range(CASES)]
    return {
        "cases": len(ends),
        "kinds": Counter(end.kind for end in ends),
        "right_in_contact": sum(end.kind == "right" and end.contact for end in ends),
        "hidden_without_halving": sum(map(hidden, ends)),
        "why": {
            kind: Counter(end.why for end in ends if end.kind == kind)
            for kind in ("flagged", "refused", "wrong", "unjudged")
        },
        "cpu_seconds": process_time() - start,
        "ends": [asdict(end) for end in ends],
    }
