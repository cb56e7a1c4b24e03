"""The table of an experiment: a line for each row on each scene."""

import csv as text
from collections.abc import Iterator, Mapping, Sequence
from io import StringIO
from typing import Any

from workflow import markdown

FIRST = ("group", "row", "scene", "blade", "cpu_s")  # columns before the numbers


def records(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Columns of each row: what it is, its CPU time, and its numbers, nested ones by a joint name.

    >>> row = dict.fromkeys(FIRST, "") | {"numbers": {"k = 4": {"amplitude": 2.0}}}
    >>> records([row])[0]["k = 4 amplitude"]
    2.0
    """
    return [{key: row[key] for key in FIRST} | dict(_flat(row["numbers"])) for row in rows]


def _flat(numbers: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    """Single values among ``numbers``; lists are left out."""
    for name, value in numbers.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{before}{name} ")
        elif not isinstance(value, list):
            yield f"{before}{name}", value


def columns(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Names of all columns that have a value, in the order in which rows have them."""
    return list(
        dict.fromkeys(name for row in rows for name, of in row.items() if of not in ("", None))
    )


def csv(rows: Sequence[Mapping[str, Any]]) -> str:
    """The table as CSV."""
    found, written = records(rows), StringIO()
    writer = text.DictWriter(written, columns(found), extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    writer.writerows(found)
    return written.getvalue()


def table(rows: Sequence[Mapping[str, Any]]) -> str:
    """The table as Markdown."""
    found = records(rows)
    head = columns(found)
    return markdown.table(head, [[_cell(row.get(name)) for name in head] for row in found]) + "\n"


def _cell(value: Any) -> str:
    if value is None:
        return "-"
    return str(markdown.Number(value)) if isinstance(value, float) else str(value)
