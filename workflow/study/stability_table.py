"""The study of stability in words, for the README."""

from typing import Any


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
