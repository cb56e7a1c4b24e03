"""The studies of speed and stability in words and tables, for the README."""

from typing import Any

from workflow.study.speed import LEVELS, OBSERVABLES, cheapest

COLUMNS = (("piecewise-exact", False), ("central-difference", False), ("central-difference", True))
NAMES = ("piecewise-exact", "central", "mass-scaled")
MODELS = {"default": "scenes'", "paper": "paper's"}


def markdown(study: dict[str, Any]) -> str:
    """CPU time (ms) of the cheapest run measured that meets each level."""
    levels = [f"{name} {level:.0%}" for level in LEVELS for name in NAMES]
    lines = [
        "| model, n | scene | error of | " + " | ".join(levels) + " | references differ |",
        "|" + " --- |" * (4 + len(levels)),
    ]
    for model, scenes in study.items():
        for name, scene in scenes.items():
            for observable in OBSERVABLES:
                cells = [
                    _milliseconds(cheapest(scene, observable, level, scheme, scaled))
                    for level in LEVELS
                    for scheme, scaled in COLUMNS
                ]
                spread = f"{100 * scene['spread'][observable]:.2g} %"
                first = f"{MODELS[model]}, {scene['n']}"
                lines.append(
                    f"| {first} | {name} | {observable} | {' | '.join(cells)} | {spread} |"
                )
    worst = max(max(s["twin"].values()) for scenes in study.values() for s in scenes.values())
    lines.append(f"\nA change of 1e-10 of the gaps moves none of these by more than {worst:.1g}.")
    return "\n".join(lines)


def stability(study: dict[str, Any]) -> str:
    """How the predicted limit of central differences agrees with failing runs."""
    rows = study["engaged"]
    off = max(abs(row["failed"] / row["predicted"] - 1) for row in rows)
    below = [1 - row["limit"] / row["failed"] for row in rows]
    moduli = f"Over E = {rows[0]['E']:g} to {rows[-1]['E']:g}, {len(rows)} always engaged liners"
    return (
        f"{moduli}: runs fail within {off:.1%} of the step at which the spectral radius passes 1; "
        f"the limit that is allowed is {min(below):.1%} to {max(below):.0%} below."
    )


def extremes(study: dict[str, Any]) -> str:
    """How the cases at the extremes ended."""
    kinds = dict.fromkeys(("right", "flagged", "refused", "wrong", "unjudged"), 0) | study["kinds"]
    whys = sorted(study["why"]["flagged"].items())
    flags = ", ".join(f"{count} {name}" for name, count in whys)
    return (
        f"{study['cases']} cases: {kinds['right']} right ({study['right_in_contact']} of them in "
        f"contact), {kinds['flagged']} flagged ({flags}), {kinds['refused']} refused, "
        f"{kinds['wrong']} silently wrong, {kinds['unjudged']} without a reference. Without "
        f"halving, {study['hidden_without_halving']} more would have been called `ok`."
    )


def _milliseconds(run: dict[str, Any] | None) -> str:
    return f"{1e3 * run['cpu_s']:.0f}" if run else "-"
