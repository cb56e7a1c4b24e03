"""The paper and our results side by side: verdicts on its claims, and a page of them, as HTML."""

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from jinja2 import Environment

from workflow.paper.claims import CLAIMS
from workflow.paper.numbers import editions
from workflow.paper.report import Row, counts, markdown as table, named, ours, share, verdicts
from workflow.paper.verdict import Numbers

__all__ = ["claims", "html", "table"]  # the claims, and texts that the rule writes of them

BESIDE = {  # figures shown before that of the claims
    "fig10b": ("fig10a",),
    "fig11b": ("fig11a",),
    "fig15": ("fig15-without",),
}
PAGE = """\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>The paper, side by side</title>
<style>
body { font: 15px/1.45 sans-serif; max-width: 76em; margin: 2em auto; padding: 0 1em; }
section { border-top: 1px solid #999; padding: 1em 0; }
img { max-width: 100%; display: block; margin: 0.5em 0; }
table { border-collapse: collapse; width: 100%; }
th, td { border-bottom: 1px solid #ddd; padding: 0.3em 0.6em; text-align: left; }
td { vertical-align: top; }
.differs { font-weight: bold; }
@media print { section { break-inside: avoid; } }
</style>
</head>
<body>
<h1>The paper, side by side</h1>
<p>{{ counts(judged) }}, of {{ judged | length }}.</p>
<p>Each figure of the paper whose numbers or statements can be compared, as computed here; where the
paper prints a number that fits into the picture, it is marked in it. Below: what the paper says,
its number, ours (bold: does not agree), and the verdict, which is computed. Behind ± is the
largest change under half the step, twice the density of rods and a richer reduced model. Shares:
in how many of the draws of the identification what the paper says holds.</p>
{% for figure, rows in figures.items() %}
<section>
<h2>Section {{ rows | map(attribute="where") | unique(true) | join("; ") | text }}</h2>
{% for name in beside.get(figure, ()) + (figure,) if figure %}
<img src="../figures/{{ name }}.png" alt="{{ name }}">
{% endfor %}
<table>
<tr>
{%- for name in ["", "the paper says", "in the paper", "here", "verdict"] + named(rows, "shares") %}
<th>{{ name | text }}</th>
{%- endfor %}
</tr>
{% for row in rows %}
<tr><td>{{ row.id }}</td><td>{{ row.says | text }}</td><td>{{ row.paper | text }}</td><td>
{%- for name, number in ours(row).items() %}
{{ "<br>" if not loop.first }}
{%- if name in row.failed %}
<span class="differs">{{ number | text }}</span>
{%- else %}
{{ number | text }}
{%- endif %}
{% endfor %}
</td><td><span class="{{ row.verdict.split()[0] }}">{{ row.verdict }}</span>
{%- if row.verdict == "differs" and row.because %}
<br>{{ row.because | text }}
{%- endif %}
</td>
{%- for name in named(rows, "shares") %}
<td>{{ share(row, name) }}</td>
{%- endfor %}
</tr>
{% endfor %}
</table>
</section>
{% endfor %}
</body>
</html>
"""


def claims(
    numbers: Numbers,
    further: Mapping[str, Mapping[str, str]],
    narrow: Mapping[str, Any],
    wide: Mapping[str, Any],
) -> list[Row]:
    """Verdicts on the claims, with the repeats, other blades and causes that have been run.

    Parameters
    ----------
    numbers : those of the scenes
    further : files of these runs by group, as ``editions`` takes them
    narrow, wide : what the identification found with either prior (workflow/paper/identified)
    """
    return verdicts(
        CLAIMS,
        numbers,
        **{
            group: editions(**further[group]) if group in further else {}
            for group in ("repeats", "other", "causes")
        },
        shares={
            "narrow prior": narrow["shares"]["holds"],
            "wide prior": wide["shares"]["holds"],
        },
    )


def html(judged: Sequence[Row]) -> str:
    """The page; ``judged``: rows of the claims table, each under its figure, or under none."""
    names = dict.fromkeys(row["figure"] for row in judged)
    environment = Environment(trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True)
    environment.filters["text"] = escape
    return environment.from_string(PAGE).render(
        {"counts": counts, "named": named, "ours": ours, "share": share},
        judged=judged,
        figures={name: [row for row in judged if row["figure"] == name] for name in names},
        beside=BESIDE,
    )
