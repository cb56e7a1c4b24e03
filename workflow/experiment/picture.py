"""The picture of an experiment: its table as curves (``lines``) or as a matrix (``cells``)."""

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure

from geometry.project import UserError
from simulate.scene.design import value_at
from workflow.experiment.table import frame
from workflow.figures import cells, lines


def draw(rows: Sequence[Mapping[str, Any]], picture: Mapping[str, Any]) -> Figure:
    """Draw the rows of an experiment; ``picture``: values of ``plan.Picture``, those that are set.

    Raises
    ------
    UserError
        When it names no column of the table, and no key of the scenes.
    """
    found = frame(rows)
    look = {key: of for key, of in picture.items() if key != "kind"}
    named = [of for key, of in look.items() if key not in ("log", "labels")]
    for name in [name for of in named for name in ([of] if isinstance(of, str) else of) if name]:
        if name not in found:
            found[name] = [value_at(row["settings"], name) for row in rows]
        if not found[name].notna().any():
            known = ", ".join(found.columns.drop(name))
            raise UserError(f"is no column; there are {known}", key="picture", value=name)
    draw_kind = {"lines": lines.draw, "cells": cells.draw}[picture["kind"]]
    return draw_kind(found, **look)
