"""Values of a rule for a function, in the types of its arguments: files are read."""

from collections.abc import Callable, Mapping
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Union, get_args, get_origin

from geometry.base import check_settings, read_json

type Readers = Mapping[Any, Callable[[str | Path], Any]]  # by type


def argument(kind: Any, given: Any, readers: Readers | None = None) -> Any:
    """An argument of type ``kind`` from the value that a rule gives for it.

    A path is read, or each of a list: by one of ``readers``, by the annotation of the type,
    by the `load` of its class, or else as a JSON file. It stays a path where the type allows a
    text; where it allows None that stands for a rule's empty list. Values of settings are checked.

    >>> argument(str, "results/mine.json"), argument(list[str], ["a.csv"]), argument(int, 2)
    ('results/mine.json', ['a.csv'], 2)
    >>> argument(list[float] | None, [0.5])
    [0.5]
    """
    kind = getattr(kind, "__value__", kind)  # of an alias
    if kind is Any:
        return given
    kinds = get_args(kind) if get_origin(kind) in (Union, UnionType) else (kind,)
    if given == [] and NoneType in kinds:
        return None
    kind = kinds[0]
    if isinstance(given, list):
        (kind_of_each,) = get_args(kind) or (Any,)
        return [argument(kind_of_each, value, readers) for value in given]
    if isinstance(given, Mapping) and hasattr(kind, "model_validate"):
        return check_settings(kind, dict(given), "")
    if str in kinds or not isinstance(given, str | Path):
        return given
    (reader,) = getattr(kind, "__metadata__", [getattr(kind, "load", read_json)])
    return (readers or {}).get(kind, reader)(given)
