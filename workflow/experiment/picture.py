"""The picture of an experiment: its table as curves (``lines``) or as a matrix (``cells``)."""

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure

from geometry.project import UserError
from simulate.scene.design import value_at
from workflow.experiment.table import records
from workflow.figures import cells, lines
from workflow.markdown import Number

COLUMNS = ("x", "y", "value", "line", "panel")  # keys of a picture that name columns


def draw(rows: Sequence[Mapping[str, Any]], picture: Mapping[str, Any]) -> Figure:
    """Draw the rows of an experiment as its ``picture`` says.

    A column is one of the table, or a key of the scenes by its path, as `liner.law.E`.

    Raises
    ------
    UserError
        When there is no such column, or a row has no such number.
    """
    ((kind, look),) = ((kind, of) for kind, of in picture.items() if of)
    names = [name for key in COLUMNS for name in _listed(look.get(key))]
    shown = _with_settings(rows, names)
    if kind == "lines":
        return lines.draw(shown, **look)
    written = [of | {"written": _text(of[look["value"]])} for of in shown]
    return cells.draw(written, **look, text="written")


def _listed(of: Any) -> list[str]:
    return of if isinstance(of, list) else [of] if of else []


def _with_settings(rows: Sequence[Mapping[str, Any]], names: Sequence[str]) -> list[dict[str, Any]]:
    """Records of the table, each with all the named columns; None where it has no such value."""
    found = records(rows)
    for name in names:
        if not any(name in record for record in found):
            of_keys = [value_at(row["settings"], name) for row in rows]
            if not any(value is not None for value in of_keys):
                known = ", ".join(dict.fromkeys(key for record in found for key in record))
                raise UserError(f"is no column; there are {known}", key="picture", value=name)
            found = [of | {name: value} for of, value in zip(found, of_keys, strict=True)]
    return [dict.fromkeys(names) | record for record in found]


def _text(value: float | None) -> str:
    return "" if value is None else str(Number(value))
