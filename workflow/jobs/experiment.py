"""The rows of an experiment."""

from typing import Any

from geometry.project import Say, read_json
from workflow.experiment.engine import Row, march_block, merge
from workflow.experiment.plan import Case
from workflow.experiment.table import csv, table

__all__ = ["block", "csv", "rows", "table"]  # texts that the rule writes among them


def block(plan: dict[str, Any], names: dict[str, str], folder: str, tell: Say) -> list[Row]:
    """March a block of the rows of the ``plan``; ``folder``: of the rows that are done."""
    cases = [Case.model_validate(case) for case in plan["cases"]]
    return march_block(cases, folder, int(names["block"]), plan["blocks"], tell)


def rows(blocks: list[str]) -> list[Row]:
    """All rows, from their blocks."""
    return merge([read_json(path) for path in blocks])
