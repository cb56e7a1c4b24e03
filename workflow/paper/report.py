"""The claims table: rows as plain values, and as Markdown."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from workflow.markdown import Number, records, table
from workflow.paper.verdict import HOLDS, NO_PEAK, VERDICTS, Claim, Numbers, judge

type Row = dict[str, Any]


def verdicts(
    claims: Sequence[Claim],
    numbers: Numbers,
    repeats: Mapping[str, Numbers],
    other: Mapping[str, Numbers],
    causes: Mapping[str, Numbers],
    shares: Mapping[str, Mapping[str, float]],
) -> list[Row]:
    """Rows of the claims table.

    Parameters
    ----------
    repeats
        Numbers under half the step, twice the density and a richer basis, by name: they give the
        uncertainty.
    other
        Numbers of another blade, by name: without repeats of their own, they are judged with the
        same uncertainty.
    causes
        Numbers with one choice changed, by its name.
    shares
        Share of the draws of a distribution at which a claim holds, by its name and by claim.
    """
    return [
        _with_others(claim, judge(claim, numbers, repeats), {"other": other, "causes": causes})
        | {"shares": {name: held[claim.id] for name, held in shares.items() if claim.id in held}}
        for claim in claims
    ]


def _with_others(claim: Claim, row: Row, groups: Mapping[str, Mapping[str, Numbers]]) -> Row:
    """A row with the verdicts of other numbers on the same claim."""
    like = row.pop("by_quantity")
    for key, editions in groups.items():
        there = {
            name: judge(claim, numbers, {}, like, fitted=False)
            for name, numbers in editions.items()
        }
        row[key] = {
            name: {part: judged[part] for part in ("ours", "verdict")}
            for name, judged in there.items()
            if judged["verdict"] != "not judged" or judged["because"] == NO_PEAK or key == "other"
        }
    return row


def counts(judged: Sequence[Row]) -> str:
    """Number of claims by verdict."""
    number = Counter(row["verdict"] for row in judged)
    return ", ".join(f"{number[verdict]} {verdict}" for verdict in VERDICTS if number[verdict])


def markdown(judged: Sequence[Row]) -> str:
    """The whole report."""
    return "\n".join(
        [
            f"# The paper's claims\n\n{counts(judged)}, of {len(judged)}.\n",
            HEAD,
            _claims(judged),
            "## Claims that differ or are undecided, and choices of ours that reverse them\n",
            *(
                _why(row)
                for row in judged
                if row["verdict"] in ("differs", "undecided", "not judged")
            ),
            *_causes(judged),
        ]
    )


def short(judged: Sequence[Row]) -> str:
    """The table of verdicts without numbers."""
    others, drawn = (named(judged, group) for group in ("other", "shares"))
    rows = [
        {"": row["id"], "the paper says": row["says"], "verdict": row["verdict"]}
        | {name: share(row, name) for name in drawn}
        | {f"on {name}": row["other"].get(name, {}).get("verdict", "") for name in others}
        for row in judged
    ]
    return f"{counts(judged)}, of {len(judged)}.\n\n{records(rows)}"


def named(judged: Sequence[Row], group: str) -> list[str]:
    """Names in a group of any row, in order."""
    return list(dict.fromkeys(name for row in judged for name in row[group]))


def share(row: Row, name: str) -> str:
    """Share of the draws of a distribution at which the claim holds."""
    return f"{100 * row['shares'][name]:.0f} %" if name in row["shares"] else ""


HEAD = """\
Every verdict is computed (`workflow/paper/claims.py`, one function for each claim). Speeds are over
f1(0), displacements and wear over the gap, displacements and gap at 1/16 of the chord, wear as the
mean over its first eighth. Behind ± is the largest change under half the step, twice the density of
rods, and a richer reduced model; differences within it do not count. Mesh, patches and strips are
the same throughout: their errors are in the summary.
`reproduced in kind`: the paper's statement holds, but one of its numbers does not agree.
`undecided`: the claim may hold or not within our uncertainty. `calibrated`: what it says was a
datum of ours, and holds, though its numbers may miss the paper's; such numbers are marked. On
another blade they are predictions, but for that of C21, which a setting decides there, too.
`not comparable`: the paper gives a picture and no number. Shares are those of the draws of the
identification at which what a claim says holds.
"""


def _claims(judged: Sequence[Row]) -> str:
    others, drawn = (named(judged, group) for group in ("other", "shares"))
    rows = [
        {
            "claim": f"**{row['id']}** {row['says']} ({row['where']})",
            "paper": row["paper"],
            "here": "; ".join(ours(row).values()),
            "verdict": row["verdict"],
            **{name: share(row, name) for name in drawn},
            **{f"on {name}": _cell(row["other"].get(name)) for name in others},
            "figure": f"[{row['figure']}](../figures/{row['figure']}.png)" if row["figure"] else "",
        }
        for row in judged
    ]
    return records(rows) + "\n"


def ours(row: Row) -> dict[str, str]:
    """Our numbers with their uncertainty, by name."""
    return {
        name: f"{name}: {Number(value, row['uncertainty'].get(name))}"
        for name, value in row["ours"].items()
    }


def _why(row: Row) -> str:
    failed = ", ".join(f"{name} = {Number(row['ours'][name])}" for name in row["failed"])
    because = f" {row['because']}" if row["because"] else ""
    return f"- **{row['id']}** ({row['says']}): {failed or 'not judged'}.{because}{_turned(row)}"


def _turned(row: Row) -> str:
    turned = [n for n, there in row["causes"].items() if there["verdict"] in HOLDS]
    if turned:
        return f" Reversed by: {', '.join(turned)}."
    lacking = [n for n, there in row["causes"].items() if there["verdict"] == "not judged"]
    but = f"; without a peak to judge: {', '.join(lacking)}" if lacking else ""
    tried = len(row["causes"]) - len(lacking)
    return f" None of {tried} choices, changed one at a time, reverses it{but}." if tried else ""


def _causes(judged: Sequence[Row]) -> list[str]:
    """Influence of each choice: a table for each set of claims decided by the same runs."""
    decided = {
        names: [row for row in judged if tuple(row["causes"]) == names]
        for names in dict.fromkeys(tuple(row["causes"]) for row in judged if row["causes"])
    }
    tables = [
        table(
            ["choice", *(f"{row['id']} {', '.join(row['ours'])}" for row in rows)],
            [[name, *(_cell(row["causes"][name]) for row in rows)] for name in names],
        )
        + "\n"
        for names, rows in decided.items()
    ]
    return ["\n## Choices of ours, changed one at a time\n", *tables] if tables else []


def _cell(there: Mapping[str, Any] | None) -> str:
    """Verdict and numbers of other runs; empty without them."""
    if there is None:
        return ""
    return f"{there['verdict']}: {', '.join(map(str, map(Number, there['ours'].values())))}"
