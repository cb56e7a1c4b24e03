"""Results of the study of stability: sentences for the README, and the map as a figure."""

from collections.abc import Mapping, Sequence
from statistics import median
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import NDArray

from workflow.figures import lines, units
from workflow.many.row import ComputedRow
from workflow.many.table import Whole
from workflow.study.stability.matrix import counts

KINDS = {
    "As plain runs (`verify: {share: 0}`)": "plain",
    "By default, runs in contact checked": "default",
    "With `verify: every`": "checked",
}
ERRORS = {0.01: "1 %", 0.1: "10 %"}
SCHEMES = {"central-difference": "central differences", "piecewise-exact": "piecewise-exact"}
ENGAGED = {
    "limit": "limit allowed, any strips engaged",
    "predicted": "predicted: spectral radius 1",
    "failed": "runs fail from here",
}


def limits(rows: Sequence[ComputedRow]) -> str:
    """Agreement of the predicted limit of central differences with failing runs."""
    rows = engaged(rows)
    off = max(abs(row["failed"] / row["predicted"] - 1) for row in rows)
    below = [1 - row["limit"] / row["failed"] for row in rows]
    moduli = f"E = {rows[0]['E']:g} to {rows[-1]['E']:g}, {len(rows)} always engaged liners"
    return (
        f"{moduli}: runs fail within {off:.1%} of the step at which the spectral radius exceeds 1; "
        f"the limit allowed is {min(below):.1%} to {max(below):.0%} below."
    )


def extremes(rows: Sequence[ComputedRow]) -> str:
    """Outcomes of the cases with extreme parameters: plain, by default and with all checks."""
    study = counts(rows)
    kinds = [f"{words}: {_outcomes(study[name])}" for words, name in KINDS.items()]
    cost = f"by default {study['checks']} runs are checked, in {study['cost']:.0%} more steps"
    return "\n\n".join([f"{study['cases']} cases; {cost}.", *kinds])


def sweeps(rows: Sequence[ComputedRow]) -> str:
    """Outcomes of drawn sweeps with the default share of checks."""
    study = [row["numbers"] for row in rows if row["numbers"]]
    peaks = [peak for sweep in study for peak in sweep["peaks"]]
    return (
        f"{len(study)} sweeps of 12 speeds, {len(peaks)} peaks that have a reference: "
        f"{sum(peak['silent'] for peak in peaks)} off by over 10 % and `ok`. Checks took "
        f"{median(sweep['share'] for sweep in study):.0%} more steps (median)."
    )


def _outcomes(counts: Mapping[str, Any]) -> str:
    kinds = dict.fromkeys(("right", "flagged", "refused", "wrong", "unjudged"), 0) | counts["kinds"]
    flagged, strips = counts["why"]["flagged"], counts["why"]["refused"].get("liner.strips", 0)
    flags = ", ".join(f"{count} {name}" for name, count in sorted(flagged.items()))
    stopped, accurate = sum(counts["stopped"].values()), counts["accurate"]
    well, well_stopped = counts["well_accurate"], counts["well_stopped"]
    silent = f"{kinds['wrong']} silently wrong"
    if counts["wrong_by"]:
        ends = dict.fromkeys(f"{counts['wrong_by'][i]:.0%}" for i in (0, -1))
        silent += f", by {' to '.join(ends)}"
    return (
        f"{kinds['right']} right ({counts['right_in_contact']} of them in contact), "
        f"{kinds['flagged']} flagged ({flags}), {kinds['refused']} refused ({strips} for their "
        f"strips), {silent}; "
        f"{kinds['unjudged']} without a reference. Of {accurate} right runs {stopped} "
        f"({stopped / max(accurate, 1):.1%}) were flagged or refused; of {well} right to half of "
        f"that {well_stopped} ({well_stopped / max(well, 1):.1%})."
    )


def engaged(rows: Sequence[ComputedRow]) -> list[Mapping[str, float]]:
    """Numbers of the always engaged elastic liners, among the rows of the map."""
    return [row["numbers"] for row in rows if row["scene"] == "engaged"]


def intermittent(rows: Sequence[ComputedRow]) -> list[Mapping[str, float | None]]:
    """For each plastic liner the limit, and the step of each scheme that reaches each error, s."""
    compared = pd.json_normalize([row for row in rows if "wear" in row["numbers"]])
    found = []
    for E, of_liner in compared.groupby("settings.liner.law.E"):
        liner = {"E": E, "limit": of_liner["numbers.limit"].iloc[0]}
        for scheme, runs in of_liner.groupby("settings.integrator.scheme"):
            steps = runs["numbers.h"].to_numpy(), runs["numbers.wear"].to_numpy(float)
            liner |= {f"{scheme} wear {level}": passes(*steps, level) for level in ERRORS}
        found.append(liner)
    return found


def passes(h: NDArray[np.float64], error: NDArray[np.float64], level: float) -> float | None:
    """Step at which the error reaches ``level``, interpolated; None if all or no runs meet it."""
    order = np.argsort(h)
    h, error = h[order], error[order]
    beyond = np.flatnonzero(error > level)
    if len(beyond) == 0 or beyond[0] == 0:
        return None
    around = slice(beyond[0] - 1, beyond[0] + 1)
    return float(np.exp(np.interp(np.log(level), np.log(error[around]), np.log(h[around]))))


def draw(study: Whole) -> Figure:
    """Left: an always engaged elastic liner. Right: a plastic liner, steps by error of wear."""
    by_error = {
        f"{scheme} wear {error}": f"{name}: error of wear {words}"
        for scheme, name in SCHEMES.items()
        for error, words in ERRORS.items()
    }
    panels = {
        "always engaged, elastic": (engaged(study), ENGAGED),
        "intermittent contact, plastic": (
            intermittent(study),
            {"limit": "limit allowed"} | by_error,
        ),
    }
    shown = pd.concat(
        pd.DataFrame(rows)
        .rename(columns=names)
        .melt("E", [*names.values()], "of", "step")
        .assign(panel=panel)
        for panel, (rows, names) in panels.items()
    )
    return lines.draw(
        shown.assign(step=units.MICRO * shown["step"].astype(float)),
        "E",
        "step",
        line="of",
        panel="panel",
        labels={"E": "modulus $E$ of the liner, paper's unit", "step": "time step $h$, µs"},
        log="xy",
    )
