"""Records, of which ``lines`` and ``cells`` draw: plain values by the name of their column."""

from collections.abc import Mapping, Sequence
from numbers import Real
from types import MappingProxyType
from typing import Any

import pandas as pd

type Records = pd.DataFrame | Sequence[Mapping[str, Any]]
type Labels = Mapping[Any, str]  # by column or value
NO_LABELS: Labels = MappingProxyType({})


def split(records: Records, column: str) -> dict[Any, pd.DataFrame]:
    """Records by their value of a column, in the order in which these occur; without one by ""."""
    frame = pd.DataFrame(records)
    values = frame[column].fillna("") if column else pd.Series("", frame.index)
    return dict([*frame.groupby(values, sort=False)])


def labelled(labels: Labels, name: Any) -> str:
    """Text for a column or a value: its label, or itself."""
    return labels.get(name, f"{name:g}" if isinstance(name, Real) else str(name))
