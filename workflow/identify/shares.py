"""Shares of draws at which the paper's other claims hold, and hold together."""

from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np

from workflow.paper.claims import CLAIMS
from workflow.paper.verdict import HOLDS, judge

# What is not judged at points: the reduced model, densities, steps and times (C01 to C10), the data
# (C11), the tilted tip (C21 to C23) and stress (C24).
JUDGED = ("C12", "C13", "C14", "C15", "C16", "C17", "C18", "C19", "C20", "C25", "C26")
GIVEN = ("C12", "C16")  # data of the second fit
SOME = 10  # draws from which a share among them is told

type Verdicts = Mapping[str, str]  # by claim


def verdicts(draw: Mapping[str, Any], K: str) -> Verdicts:
    """Verdict of each claim on the numbers of one draw, with K of the coating with E = 1."""
    numbers = {**draw, "e1": draw["e1"][K]}
    return {
        claim.id: judge(claim, numbers, {})["verdict"] for claim in CLAIMS if claim.id in JUDGED
    }


def shares(of_draws: Sequence[Verdicts]) -> dict[str, Any]:
    """Shares of the draws at which claims hold, whether their numbers agree or not.

    Returns
    -------
    dict
        "draws", "holds", "not judged": as of ``_shares``; "together": by claim and claim, the
        share of the draws with the first one at which the second one holds as well; nan where the
        first one never holds; "given": ``_shares`` of those where ``GIVEN`` hold.
    """
    held = np.array([[draw[c] in HOLDS for c in JUDGED] for draw in of_draws], float)
    with np.errstate(invalid="ignore"):
        together = held.T @ held / held.sum(axis=0)[:, None]
    given = [draw for draw in of_draws if all(draw[c] in HOLDS for c in GIVEN)]
    return {
        **_shares(of_draws),
        "together": {
            c: dict(zip(JUDGED, row, strict=True))
            for c, row in zip(JUDGED, together.tolist(), strict=True)
        },
        "given": _shares(given),
    }


def _shares(of_draws: Sequence[Verdicts]) -> dict[str, Any]:
    """Number of draws; by claim the shares at which it holds, or lacks a peak that it needs."""

    def share(verdicts: Collection[str], claim: str) -> float:
        return sum(draw[claim] in verdicts for draw in of_draws) / max(len(of_draws), 1)

    return {
        "draws": len(of_draws),
        "holds": {claim: share(HOLDS, claim) for claim in JUDGED},
        "not judged": {claim: share(["not judged"], claim) for claim in JUDGED},
    }


def distributions(of: Mapping[str, Any], K: str) -> dict[str, Mapping[str, Any]]:
    """Draws with K of the coating with E = 1 and their shares, by name, as far as there are any."""
    found = {"prior": of.get("prior"), "posterior": of.get(K)}
    drawn = {name: draws[K] for name, draws in found.items() if draws}
    if "posterior" in drawn and drawn["posterior"]["given"]["draws"] >= SOME:
        drawn["posterior where C12 and C16 hold"] = drawn["posterior"]["given"]
    return drawn
