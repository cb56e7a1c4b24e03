"""Shares of draws at which the paper's other claims hold, and hold together."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from workflow.identify.fits import posterior_of
from workflow.paper.claims import CLAIMS
from workflow.paper.verdict import HOLDS, judge

# Claims not judged at points: the reduced model, densities, steps and times (C01 to C10), the data
# (C11), the tilted tip (C21 to C23) and stress (C24).
JUDGED = ("C12", "C13", "C14", "C15", "C16", "C17", "C18", "C19", "C20", "C25", "C26")

type Verdicts = Mapping[str, str]  # by claim


def numbers(fits: Mapping[str, Any], measured: list[dict[str, Any]]) -> dict[str, Any]:
    """Verdicts at the medoid of the posterior, and shares of its draws at which the claims hold.

    ``measured``: numbers at points, of a job each. "values": of the parameters at the draw at which
    most claims hold.
    """
    at_points = {point: verdicts(at) for block in measured for point, at in block.items()}
    posterior = posterior_of(fits)
    of_draws = shares([at_points[str(point)] for point in posterior["draws"]])
    best = posterior["draws"][of_draws["best"]]
    return {
        "effective": posterior["effective"],
        "medoid": at_points[str(posterior["medoid"])],
        "values": {name: values[best] for name, values in fits["values"].items()},
        **of_draws,
    }


def verdicts(at: Mapping[str, Any]) -> Verdicts:
    """Verdict of each claim on the numbers at one point."""
    return {claim.id: judge(claim, at, {})["verdict"] for claim in CLAIMS if claim.id in JUDGED}


def shares(verdicts: Sequence[Verdicts]) -> dict[str, Any]:
    """Shares of the draws at which claims hold, whether their numbers agree or not.

    Returns
    -------
    dict
        "draws": their number; "holds": by claim; "not judged": by claim, the share at which a
        peak that it needs is missing; "together": by claim and claim, the share of the draws with
        the first one at which the second one holds as well; nan where the first one never holds;
        "best": the first draw at which most claims hold; "missed": claims that do not hold there.
    """
    held = np.array([[draw[c] in HOLDS for c in JUDGED] for draw in verdicts], float)
    unknown = np.array([[draw[c] == "not judged" for c in JUDGED] for draw in verdicts])
    best = int(held.sum(axis=1).argmax())
    with np.errstate(invalid="ignore"):
        together = held.T @ held / held.sum(axis=0)[:, None]
    return {
        "draws": len(verdicts),
        "holds": _by_claim(held.mean(axis=0)),
        "best": best,
        "missed": [c for c in JUDGED if verdicts[best][c] not in HOLDS],
        "not judged": _by_claim(unknown.mean(axis=0)),
        "together": {c: _by_claim(row) for c, row in zip(JUDGED, together, strict=True)},
    }


def _by_claim(values: NDArray[np.float64]) -> dict[str, float]:
    return dict(zip(JUDGED, values.tolist(), strict=True))
