"""Blocks of pages that the paper fills, for ``workflow.readme``."""

from collections import Counter
from collections.abc import Mapping, Sequence
from textwrap import fill
from typing import Any

from workflow.markdown import WIDTH, table
from workflow.paper import long, report
from workflow.paper.claims import COATING
from workflow.paper.published import SHIFTS
from workflow.paper.verdict import HOLDS
from workflow.summary import OVER_F1, OVER_GAP, over_gap, peaks

OF_MODEL = 10  # claims on model and method, the first ones
PARAGRAPH = """\
Of the paper's {model} statements on its model and method, {held} hold here; of {silent} the
paper gives no number. Of its {motion} statements on how the blade vibrates and the liner wears,
{data} served to infer or set what it leaves open; of the other {predicted}, {holding} hold on the
blade inferred, {in_kind} of them with other numbers than the paper's. Not found there: {differs};
undecided, within the error of our runs: {undecided}."""


def coatings(summary: Mapping[str, Any]) -> str:
    """Critical speeds, amplitudes and wear of both coatings at the two main engine orders."""
    by_scene = {
        (scene["scene"], str(row["k"])): row for scene, row in peaks(summary) if 1 in row["modes"]
    }
    rows = [
        [COATING[part], k, *cells[:2], f"{paper:.3f}", *cells[2:]]
        for (part, k), (paper, _) in SHIFTS.items()
        if (row := by_scene.get((f"paper-{part}", k))) and (cells := over_gap(row))
    ]
    return table(["coating", "k", *OVER_F1, "in the paper", *OVER_GAP], rows)


def verdicts(judged: Sequence[Mapping[str, Any]]) -> str:
    """Three sentences on the paper's claims for a reader who does not know them."""
    model, motion = (
        Counter(row["verdict"] for row in of) for of in (judged[:OF_MODEL], judged[OF_MODEL:])
    )
    held, holding = (sum(of[verdict] for verdict in HOLDS) for of in (model, motion))
    data = motion["calibrated"]
    return fill(
        PARAGRAPH.format(
            model=model.total(),
            held=held,
            silent=model["not comparable"],
            motion=motion.total(),
            data=data,
            predicted=motion.total() - data,
            holding=holding - data,
            in_kind=motion["reproduced in kind"],
            **{
                verdict: ", ".join(
                    f'"{row["says"]}"' for row in judged if row["verdict"] == verdict
                )
                or "none"
                for verdict in ("differs", "undecided")
            },
        ),
        WIDTH,
    )


# block, file that holds its numbers, function that writes them
COMPUTED = (
    ("found", "results/summary.json", coatings),
    ("verdicts", "results/paper/claims.json", verdicts),
    ("claims", "results/paper/claims.json", report.short),
    ("conclusions", "results/paper/conclusions.md", str),
    ("cost", "results/paper/cost.md", str),
    ("long", "results/paper/long-times.json", long.table),
)
