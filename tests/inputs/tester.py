"""The tester: draws inputs of every kind, always the same ones, and counts the verdicts."""

import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from case import BAD, Case, judge
from hypothesis import HealthCheck, Phase, given, seed, settings
from matrix_cases import matrix_cases
from mesh_cases import mesh_cases
from result_cases import result_cases
from table_cases import table_cases
from yaml_cases import yaml_cases

SEED = 5_181_320  # of the draws: another one has other inputs
SHARES = {
    "yaml": (yaml_cases, 0.4),
    "tables": (table_cases, 0.2),
    "meshes": (mesh_cases, 0.15),
    "matrices": (matrix_cases, 0.1),
    "results": (result_cases, 0.15),
}


class Counts(NamedTuple):
    """Verdicts on the inputs of a run."""

    kinds: dict[str, dict[str, int]]  # number of inputs by their kind and by their verdict
    faults: list[str]  # inputs whose verdict is not good


def count(inputs: int, over: Callable = map) -> Counts:
    """Judge ``inputs`` of all kinds, by their shares; ``over`` may map them in processes.

    Each run has the same draws, those of ``SEED``.
    """
    parts = [(name, round(share * inputs)) for name, (_, share) in SHARES.items()]
    counts = list(over(_count, parts))
    kinds = {kind: of for part in counts for kind, of in part.kinds.items()}
    return Counts(
        {kind: kinds[kind] for kind in sorted(kinds)},
        [fault for part in counts for fault in part.faults],
    )


def _count(part: tuple[str, int]) -> Counts:
    name, inputs = part
    kinds: dict[str, Counter] = {}
    faults: list[str] = []

    def take(case: Case) -> None:
        with tempfile.TemporaryDirectory() as folder:
            verdict = judge(case, Path(folder))
        kinds.setdefault(case.kind, Counter())[verdict.name] += 1
        if verdict.name in BAD:
            faults.append(f"{verdict.name}: {verdict.why}\n  {case}")

    _draw(SHARES[name][0], inputs, take)
    return Counts({kind: dict(of) for kind, of in kinds.items()}, faults)


def _draw(cases: Callable, inputs: int, take: Callable[[Case], None]) -> None:
    """Call ``take`` for each of a number of cases."""

    @seed(SEED)
    @settings(
        max_examples=inputs,
        database=None,
        deadline=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(cases())
    def drawn(case: Case) -> None:
        take(case)

    drawn()
