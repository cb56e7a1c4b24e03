"""The tester: draws inputs of every kind, always the same ones, and counts the verdicts."""

import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from case import BAD, Case, Verdict, judge
from hypothesis import HealthCheck, Phase, given, settings
from mesh_cases import mesh_cases
from table_cases import table_cases
from yaml_cases import yaml_cases

SHARES = {"yaml": (yaml_cases, 0.6), "tables": (table_cases, 0.25), "meshes": (mesh_cases, 0.15)}


class Counts(NamedTuple):
    """Verdicts on the inputs of a run."""

    kinds: dict[str, dict[str, int]]  # number of inputs by their kind and by their verdict
    faults: list[tuple[Case, Verdict]]  # whose verdict is not good


def count(inputs: int, of: Callable = judge) -> Counts:
    """Judge ``inputs`` of all kinds, by their shares.

    The draws are derived from the code of this function alone: each run has the same ones.
    """
    judged: list[tuple[Case, Verdict]] = []
    for cases, share in SHARES.values():
        _draw(cases, round(share * inputs), lambda case: judged.append((case, _judged(case, of))))
    kinds: dict[str, Counter] = {}
    for case, verdict in judged:
        kinds.setdefault(case.kind, Counter())[verdict.name] += 1
    return Counts(
        {kind: dict(kinds[kind]) for kind in sorted(kinds)},
        [(case, verdict) for case, verdict in judged if verdict.name in BAD],
    )


def _judged(case: Case, of: Callable) -> Verdict:
    with tempfile.TemporaryDirectory() as folder:
        return of(case, Path(folder))


def _draw(cases: Callable, inputs: int, take: Callable[[Case], None]) -> None:
    """Call ``take`` for each of a number of cases."""

    @settings(
        max_examples=inputs,
        derandomize=True,
        database=None,
        deadline=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(cases())
    def drawn(case: Case) -> None:
        take(case)

    drawn()
