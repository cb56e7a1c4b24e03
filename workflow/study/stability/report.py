"""Results of the study of stability: sentences for the README, and the map as a figure."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from workflow.figures import style

MICRO = 1e6
DRAWINGS = {"now": "", "before": ", drawn while fewer strips than patches were allowed"}
ERRORS = {"0.01": ("-", "1 %"), "0.1": (":", "10 %")}
SCHEMES = {
    "central-difference": ("s", style.VERMILLION, "central differences"),
    "piecewise-exact": ("o", style.BLUE, "piecewise-exact"),
}


def limits(study: Mapping[str, Any]) -> str:
    """Agreement of the predicted limit of central differences with failing runs."""
    rows = study["engaged"]
    off = max(abs(row["failed"] / row["predicted"] - 1) for row in rows)
    below = [1 - row["limit"] / row["failed"] for row in rows]
    moduli = f"E = {rows[0]['E']:g} to {rows[-1]['E']:g}, {len(rows)} always engaged liners"
    return (
        f"{moduli}: runs fail within {off:.1%} of the step at which the spectral radius exceeds 1; "
        f"the limit allowed is {min(below):.1%} to {max(below):.0%} below."
    )


def extremes(study: Mapping[str, Any]) -> str:
    """Outcomes of the cases with extreme parameters, as plain runs and with all checks."""
    return "\n\n".join(
        f"{study[name]['cases']} cases{words}. As plain runs: {_outcomes(study[name]['plain'])}\n\n"
        f"With `twin: true` and `halving: true`: {_outcomes(study[name]['checked'])}"
        for name, words in DRAWINGS.items()
    )


def _outcomes(counts: Mapping[str, Any]) -> str:
    kinds = dict.fromkeys(("right", "flagged", "refused", "wrong", "unjudged"), 0) | counts["kinds"]
    flags, strips = (
        _listed(counts["why"]["flagged"]),
        counts["why"]["refused"].get("liner.strips", 0),
    )
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


def _listed(whys: Mapping[str, int]) -> str:
    return ", ".join(f"{count} {name}" for name, count in sorted(whys.items()))


@style.styled
def draw(study: dict[str, Any]) -> Figure:
    """Left: an always engaged elastic liner. Right: a plastic liner, steps by error of wear."""
    drawn = style.figure(style.DOUBLE, 3.4)
    left, right = drawn.subplots(1, 2, sharey=True)
    _engaged(left, study["engaged"])
    _intermittent(right, study["intermittent"])
    for axes in (left, right):
        axes.set(xscale="log", yscale="log", xlabel="modulus $E$ of the liner, paper's unit")
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.18))
    left.set_ylabel("time step $h$, µs")
    left.set_title("always engaged, elastic")
    right.set_title("intermittent contact, plastic")
    return drawn


def _engaged(axes: Axes, rows: list[dict[str, float]]) -> None:
    E = [row["E"] for row in rows]
    limit, predicted, failed = (
        MICRO * np.array([row[key] for row in rows]) for key in ("limit", "predicted", "failed")
    )
    axes.fill_between(E, predicted, 1.0, color=style.GREY, alpha=0.3, linewidth=0)
    axes.annotate("unstable", (E[-4], 0.35))
    axes.plot(E, failed, "x", color="black", markersize=5, label="runs fail from here")
    axes.plot(E, predicted, "--", color=style.VERMILLION, label="predicted: spectral radius 1")
    axes.plot(E, limit, "-", color="black", label="limit allowed, any strips engaged")


def _intermittent(axes: Axes, rows: list[dict[str, Any]]) -> None:
    E = np.array([row["E"] for row in rows])
    axes.plot(E, [MICRO * row["limit"] for row in rows], "-", color="black", label="limit allowed")
    for scheme, (marker, color, name) in SCHEMES.items():
        for level, (line, words) in ERRORS.items():
            h = [row[scheme]["wear"][level] for row in rows]
            met = np.array([np.nan if step is None else MICRO * step for step in h])
            if np.isfinite(met).any():
                label = f"{name}: error of wear {words}"
                face = color if level == "0.01" else "white"
                axes.plot(E, met, f"{marker}{line}", color=color, label=label, markerfacecolor=face)
