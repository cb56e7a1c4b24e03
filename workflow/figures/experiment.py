"""The picture of an experiment: its table as curves (``lines``) or as a matrix (``cells``)."""

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure

from geometry.base import UserError
from workflow.figures import cells, lines
from workflow.many.columns import value_at
from workflow.many.row import ComputedRow
from workflow.many.table import frame


def draw(rows: Sequence[ComputedRow], picture: Mapping[str, Any]) -> Figure:
    """Draw the rows of an experiment; ``picture``: values of ``plan.Picture``, those that are set.

    Raises
    ------
    UserError
        When it names no column of the table, and no key of the scenes.
    """
    table = frame(rows)
    look = {key: value for key, value in picture.items() if key != "kind"}
    named = [value for key, value in look.items() if key not in ("log", "labels")]
    for name in [
        name for names in named for name in ([names] if isinstance(names, str) else names) if name
    ]:
        if name not in table:
            table[name] = [value_at(row["settings"], name) for row in rows]
        if not table[name].notna().any():
            columns = ", ".join(table.columns.drop(name))
            raise UserError(f"is no column; there are {columns}", key="picture", value=name)
    draw_kind = {"lines": lines.draw, "cells": cells.draw}[picture["kind"]]
    return draw_kind(table, **look)
