"""The table of an experiment: a line for each row on each scene."""

from collections.abc import Sequence
from itertools import zip_longest

import pandas as pd

from workflow import markdown
from workflow.experiment.row import ExperimentRow

FIRST = ["group", "row", "scene", "blade", "cpu_s"]  # columns before the numbers


def rows(blocks: list[list[ExperimentRow]]) -> list[ExperimentRow]:
    """Rows of all blocks, in the order of the cases.

    >>> rows([["first", "third"], ["second"]])
    ['first', 'second', 'third']
    """
    return [row for turn in zip_longest(*blocks) for row in turn if row]


def frame(rows: Sequence[ExperimentRow]) -> pd.DataFrame:
    """Description of each row, its CPU time, and its numbers, nested ones by a joint name.

    Lists among the numbers are left out, and columns without any value.

    >>> row = dict.fromkeys(FIRST, "a") | {"numbers": {"k = 4": {"amplitude": 2.0}}}
    >>> frame([row])["k = 4 amplitude"].tolist()
    [2.0]
    """
    numbers = pd.json_normalize([row["numbers"] or {} for row in rows], sep=" ")
    lists = [name for name in numbers if numbers[name].map(type).isin([list]).any()]
    whole = pd.concat([pd.DataFrame(rows)[FIRST], numbers.drop(columns=lists)], axis=1)
    return whole.replace("", None).dropna(axis=1, how="all")


def csv(rows: Sequence[ExperimentRow]) -> str:
    """The table as CSV."""
    return frame(rows).to_csv(index=False)


def table(rows: Sequence[ExperimentRow]) -> str:
    """The table as Markdown."""
    columns = frame(rows).astype(object)
    return markdown.table([*columns], columns.map(markdown.cell).values) + "\n"
