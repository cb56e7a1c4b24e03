"""The paper and our results side by side: a page of figures, claims and verdicts, as HTML."""

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from workflow.paper.report import counts, named, ours, share

FIGURES = "../figures"  # from the page
BESIDE = {  # figures shown before that of the claims
    "fig10b": ("fig10a",),
    "fig11b": ("fig11a",),
    "fig15": ("fig15-without",),
}
STYLE = """\
body { font: 15px/1.45 sans-serif; max-width: 76em; margin: 2em auto; padding: 0 1em; }
section { border-top: 1px solid #999; padding: 1em 0; }
img { max-width: 100%; display: block; margin: 0.5em 0; }
table { border-collapse: collapse; width: 100%; }
th, td { border-bottom: 1px solid #ddd; padding: 0.3em 0.6em; text-align: left; }
td { vertical-align: top; }
.differs { font-weight: bold; }
@media print { section { break-inside: avoid; } }"""
HEAD = """\
Each figure of the paper whose numbers or statements can be compared, as computed here; where the
paper prints a number that fits into the picture, it is marked in it. Below: what the paper says,
its number, ours (bold: does not agree), and the verdict, which is computed. Behind ± is the
largest change under half the step, twice the density of rods and a richer reduced model. Shares:
in how many of the draws of the identification what the paper says holds."""


def html(judged: Sequence[Mapping[str, Any]]) -> str:
    """The page; ``judged``: rows of the claims table."""
    figures = dict.fromkeys(row["figure"] for row in judged)
    parts = [_section(name, [row for row in judged if row["figure"] == name]) for name in figures]
    return f"""\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>The paper, side by side</title>
<style>
{STYLE}
</style>
</head>
<body>
<h1>The paper, side by side</h1>
<p>{counts(judged)}, of {len(judged)}.</p>
<p>{HEAD}</p>
{"".join(parts)}</body>
</html>
"""


def _section(figure: str, rows: Sequence[Mapping[str, Any]]) -> str:
    """A figure, with those beside it, and its claims; without a figure the claims alone."""
    shown = [*BESIDE.get(figure, ()), figure] if figure else []
    places = dict.fromkeys(row["where"] for row in rows)
    images = [f'<img src="{FIGURES}/{name}.png" alt="{name}">' for name in shown]
    head = f"<h2>Section {escape('; '.join(places))}</h2>"
    return "\n".join(["<section>", head, *images, _table(rows), "</section>", ""])


def _table(rows: Sequence[Mapping[str, Any]]) -> str:
    drawn = named(rows, "shares")
    head = ["", "the paper says", "in the paper", "here", "verdict", *(f"{n}" for n in drawn)]
    lines = [_line("th", map(escape, head))]
    lines += [_line("td", _cells(row, drawn)) for row in rows]
    return "\n".join(["<table>", *lines, "</table>"])


def _cells(row: Mapping[str, Any], drawn: Sequence[str]) -> list[str]:
    verdict = f'<span class="{row["verdict"].split()[0]}">{row["verdict"]}</span>'
    why = row["verdict"] == "differs" and row["because"]
    return [
        row["id"],
        escape(row["says"]),
        escape(row["paper"]),
        "<br>".join(_number(text, name in row["failed"]) for name, text in ours(row).items()),
        verdict + (f"<br>{escape(why)}" if why else ""),
        *(share(row, name) for name in drawn),
    ]


def _number(text: str, failed: bool) -> str:
    return f'<span class="differs">{escape(text)}</span>' if failed else escape(text)


def _line(tag: str, cells: Any) -> str:
    return f"<tr>{''.join(f'<{tag}>{cell}</{tag}>' for cell in cells)}</tr>"
