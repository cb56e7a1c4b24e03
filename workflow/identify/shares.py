"""Shares of draws at which the paper's other claims hold, and hold together."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from workflow.paper.claims import CLAIMS
from workflow.paper.verdict import HOLDS, judge

# What is not judged at points: the reduced model, densities, steps and times (C01 to C10), the data
# (C11), the tilted tip (C21 to C23) and stress (C24).
JUDGED = ("C12", "C13", "C14", "C15", "C16", "C17", "C18", "C19", "C20", "C25", "C26")
GIVEN = ("C12", "C16")  # data of the second fit

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
        "holds": by claim; "not judged": by claim, the share at which a peak that it needs is
        missing; "together": by claim and claim, the share of the draws with the first one
        at which the second one holds as well; nan where the first one never holds; "given":
        ``GIVEN`` hold at so many "draws", and there each claim "holds" in that share.
    """
    held = np.array([[draw[c] in HOLDS for c in JUDGED] for draw in of_draws], float)
    count = held.sum(axis=0)
    unknown = [np.mean([draw[c] == "not judged" for draw in of_draws]) for c in JUDGED]
    given = held[held[:, [JUDGED.index(c) for c in GIVEN]].all(axis=1)]
    with np.errstate(invalid="ignore"):
        together = held.T @ held / count[:, None]
        there = given.sum(axis=0) / len(given) if len(given) else np.full(len(JUDGED), np.nan)
    return {
        "holds": _by_claim(count / len(held)),
        "not judged": _by_claim(np.array(unknown)),
        "together": {c: _by_claim(row) for c, row in zip(JUDGED, together, strict=True)},
        "given": {"draws": len(given), "holds": _by_claim(there)},
    }


def _by_claim(values: NDArray[np.float64]) -> dict[str, float]:
    return dict(zip(JUDGED, values.tolist(), strict=True))
