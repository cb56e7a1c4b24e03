"""Records, of which ``lines`` and ``cells`` draw: plain values by the name of their column."""

from collections.abc import Mapping, Sequence
from numbers import Real
from types import MappingProxyType
from typing import Any

type Records = Sequence[Mapping[str, Any]]
type Labels = Mapping[Any, str]  # by column or value
NO_LABELS: Labels = MappingProxyType({})


def values_of(records: Records, column: str) -> list[Any]:
    """Different values of a column, in the order in which they occur."""
    return list(dict.fromkeys(record[column] for record in records))


def split(records: Records, column: str) -> dict[Any, list[Mapping[str, Any]]]:
    """Records by their value of a column; without a column all of them, by None."""
    if not column:
        return {None: list(records)}
    return {
        value: [record for record in records if record[column] == value]
        for value in values_of(records, column)
    }


def labelled(labels: Labels, name: Any) -> str:
    """What is written for a column or a value: its label, or itself."""
    plain = f"{name:g}" if isinstance(name, Real) else str(name or "")
    return labels.get(name, plain)
