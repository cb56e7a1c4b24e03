"""The study of the interface in tables, each number beside its bar."""

from typing import Any

from workflow import markdown
from workflow.study.interface_plan import FREQUENCY_BAR, OPERATOR_BARS, TOLD
from workflow.study.trade_table import percent

type Row = dict[str, Any]


def table(study: Row) -> str:
    """The whole study as Markdown, a table under each title."""
    parts = {
        "What S and the reduced model keep": operators(study),
        "Ten frequencies at 17 speeds": frequencies(study),
        "Compliance amid the strips, from mesh to mesh": compliances(study),
        "Results": results(study),
        "Largest stress away from clamp and contact": stress(study),
        "All nodes of the tip as interface": all_nodes(study),
    }
    return "\n\n".join(f"## {title}\n\n{text}" for title, text in parts.items()) + "\n"


def operators(study: Row) -> str:
    """Errors of S on fields it keeps, of S T = [I 0], of the compliance at rest."""
    head = ["blade", "patches", "n", *(f"{k} (<= {bar:g})" for k, bar in OPERATOR_BARS.items())]
    rows = [
        [r["blade"], str(r["patches"]), str(r["n"])]
        + [_judged(r[key], bar, f"{r[key]:.1e}") for key, bar in OPERATOR_BARS.items()]
        for r in study["models"]
    ]
    return markdown.table(head, rows)


def frequencies(study: Row) -> str:
    """Worst error of ten frequencies of each default model."""
    rows = [
        [blade, _judged(error, FREQUENCY_BAR, percent(error))]
        for blade, error in study["frequencies"].items()
    ]
    return markdown.table(["blade", f"largest error (<= {100 * FREQUENCY_BAR:g} %)"], rows)


def compliances(study: Row) -> str:
    """Largest change of the compliance amid as many strips as patches."""
    rows = [
        [r["from"], r["to"], str(r["patches"]), _share(r["compliance"], r["bar"])]
        for r in study["between_meshes"]
    ]
    return markdown.table(["from", "to", "patches", "largest change"], rows)


def results(study: Row) -> str:
    """Changes of what users read; of gaps by 1e-10 the largest departure of the twin."""
    rows = []
    for row in study["changes"]:
        if "largest" in row:
            rows.append([row["scene"], row["change"], f"{row['largest']:.1e}", *[""] * 4])
        else:
            told = [_share(row["changes"][key], row["bars"].get(key)) for key in TOLD]
            rows.append([row["scene"], row["change"], *told])
    return markdown.table(["scene", "change", *(name.replace("_", " ") for name in TOLD)], rows)


def stress(study: Row) -> str:
    """Change of the largest von Mises stress, settled and anywhere."""
    rows = [
        [r["change"], _share(r["settled"], r["bar"]), percent(r["anywhere"])]
        for r in study["stress"]
    ]
    return markdown.table(["change", "settled", "anywhere, not settled"], rows)


def all_nodes(study: Row) -> str:
    """The default against contact at every node of the tip, which moves alone or as the patches."""
    rows = [
        [
            r["scene"],
            r["moving"],
            percent(r["wear"]),
            *(f"{100 * r[key]:+.2g} %" for key in ("volume", "amplitude")),
        ]
        for r in study["all_nodes"]
    ]
    return markdown.table(["scene", "nodes move", "wear", "volume", "amplitude"], rows)


def _share(value: float | None, bar: float | None) -> str:
    if value is None:
        return "-"
    text = percent(value)
    return text if bar is None else _judged(value, bar, f"{text} (<= {100 * bar:g} %)")


def _judged(value: float, bar: float, text: str) -> str:
    return text if value <= bar else f"**{text}** missed"
