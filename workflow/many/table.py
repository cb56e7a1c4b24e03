"""The table of an experiment: a line for each row on each scene."""

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from operator import itemgetter
from pathlib import Path
from typing import Annotated, Any

import pandas as pd

from geometry.base import ProvenanceError, UserError, read_json
from workflow import markdown
from workflow.many.row import About, ComputedRow
from workflow.many.store import Store

FIRST = ["group", "row", "scene", "blade", "refused", "cpu_s"]  # columns before the numbers
OF_BLOCKS = ("number", "key")  # of an entry, which a table leaves out
NONE = {"cpu_s": 0.0, "numbers": None}  # of a row that is refused


def in_turn(blocks: Iterable[Iterable[About]]) -> list[About]:
    """Rows of all blocks in the order of their table."""
    return sorted(chain(*blocks), key=itemgetter("number"))


def require_kept(entries: Iterable[About], kept: Mapping[str, Any], folder: str | Path) -> None:
    """Refuse entries of blocks whose numbers are not among those ``kept`` in a ``folder``.

    Raises
    ------
    ProvenanceError
        When one is missing.
    """
    lost = [entry["row"] for entry in entries if "key" in entry and entry["key"] not in kept]
    if lost:
        text = f"{len(lost)} rows are gone or damaged, the first is {lost[0]}: delete the files "
        raise ProvenanceError(f"{text}*block-*.json beside it, and run it again", file=folder)


def rows(blocks: list[list[About]], folder: str) -> list[ComputedRow]:
    """Rows of all blocks, in the order of their table, with the numbers in the store ``folder``.

    Raises
    ------
    ProvenanceError
        When the store has lost some.
    """
    entries = in_turn(blocks)
    kept = Store(folder).read({entry["key"] for entry in entries if "key" in entry})
    require_kept(entries, kept, folder)
    return [
        {name: value for name, value in entry.items() if name not in OF_BLOCKS}
        | kept.get(entry.get("key"), NONE)
        for entry in entries
    ]


def whole(path: str | Path) -> list[ComputedRow]:
    """The rows of a table, for a function of all of them.

    Raises
    ------
    geometry.base.errors.UserError
        When a row is refused, with its reason; or the table cannot be read.
    """
    found = read_json(path)
    if not isinstance(found, list) or not all(isinstance(row, dict) for row in found):
        raise UserError("is no table of an experiment", file=path)
    for row in found:
        if "refused" in row:
            text = f"{row['refused']}: mend the row, and run the experiment again"
            raise UserError(text, file=path, key=f"{row['row']}, {row['scene']}")
    return found


Whole = Annotated[Sequence[ComputedRow], whole]  # an argument of a job, read from its path


def frame(rows: Sequence[ComputedRow]) -> pd.DataFrame:
    """Description of each row, its CPU time, and its numbers, nested ones by a joint name.

    Lists among the numbers are left out, and columns without any value.

    >>> row = dict.fromkeys(FIRST, "a") | {"numbers": {"k = 4": {"amplitude": 2.0}}}
    >>> frame([row])["k = 4 amplitude"].tolist()
    [2.0]
    """
    numbers = pd.json_normalize([row["numbers"] or {} for row in rows], sep=" ")
    lists = [name for name in numbers if numbers[name].map(type).isin([list]).any()]
    about = pd.DataFrame(rows).reindex(columns=FIRST)
    whole = pd.concat([about, numbers.drop(columns=lists)], axis=1)
    return whole.replace("", None).dropna(axis=1, how="all")


def last_words(path: str | Path) -> str:
    """How many rows the CSV table of a design or of an experiment has, and those without a result.

    With the first reason; and how many rows of a design have runs that ended otherwise than ok.
    """
    columns = ["row", "refused", "runs", "why", "runs not ok"]  # as far as the table has them
    rows = pd.read_csv(path, dtype={"row": str}).reindex(columns=columns)
    why = rows["why"].where(rows["runs"] == 0).combine_first(rows["refused"])
    refused = rows.assign(why=why)[why.notna()]
    said = [f"{len(rows)} rows"]
    if len(refused):
        row, reason = refused.iloc[0][["row", "why"]]
        said.append(f"{len(refused)} refused, the first is row {row}: {reason}")
    bad = int((rows["runs not ok"] > 0).sum())
    return "; ".join([*said, *[f"{bad} with runs not ok"] * (bad > 0)])


def csv(rows: Sequence[ComputedRow]) -> str:
    """The table as CSV."""
    return frame(rows).to_csv(index=False)


def table(rows: Sequence[ComputedRow]) -> str:
    """The table as Markdown."""
    columns = frame(rows).astype(object)
    return markdown.table([*columns], columns.map(markdown.cell).values) + "\n"
