"""Columns: keys of a scene by their paths, their values in a scene, and scenes with others.

``liner.law.K`` or ``casing.harmonics[0].amplitude_gaps``: items of lists count from 0.
"""

import re
from collections.abc import Callable, Mapping
from copy import deepcopy
from itertools import pairwise
from typing import Any

from geometry.base import FORMER, SettingsError, converted, merged

COLUMN = re.compile(r"[a-zA-Z]\w*(\[\d{1,6}\])*(\.\w+(\[\d{1,6}\])*)*", re.ASCII)

type Keys = tuple[str | int, ...]  # of a column, items of lists as numbers


def keys(column: str) -> Keys:
    """Keys of a column.

    >>> keys("casing.harmonics[0].order")
    ('casing', 'harmonics', 0, 'order')
    """
    parts = re.findall(r"\[(\d+)\]|([^.\[\]]+)", column)
    return tuple(int(item) if item else name for item, name in parts)


def placed(
    values: dict[str, Any], changes: Mapping[str, Any], read: Callable[[Any], Any] = deepcopy
) -> dict[str, Any]:
    """``values`` with ``read`` of each of the ``changes``, which are by paths of keys.

    >>> placed({"liner": {"law": {"E": 1.0, "K": 4.55}}}, {"liner.law.K": 0.45})
    {'liner': {'law': {'E': 1.0, 'K': 0.45}}}

    Raises
    ------
    geometry.base.errors.SettingsError
        When there is no such place.
    """
    placed_there: dict[str, Any] = {}
    for column, value in changes.items():
        try:
            path, convert = _of_now(values, keys(column))
            _place(
                placed_there,
                values,
                path,
                converted(read(value), convert) if convert else read(value),
            )
        except (ValueError, AttributeError, IndexError, TypeError):
            raise SettingsError(
                "no YAML value, or no such place", key=column, value=value
            ) from None
    return merged(values, placed_there)


def _place(changes: Any, base: Any, path: Keys, value: Any) -> None:
    """Set ``value`` at ``path`` of the mapping ``changes``; a list begins as that of ``base``."""
    for key, following in pairwise(path):
        base = base.get(key) if isinstance(base, dict) else None
        if isinstance(key, str) and key not in changes:
            changes[key] = deepcopy(base) if isinstance(following, int) else {}
        changes = changes[key]
    changes[path[-1]] = value


def _of_now(values: Any, path: Keys) -> tuple[Keys, Callable[[float], float] | None]:
    """A path with the keys of now, and what converts its number, if it has a former one.

    A key that the ``values`` have stays, as one of a law of one's own.
    """
    found, convert = [], None
    for key in path:
        if key in FORMER and not (isinstance(values, dict) and key in values):
            key, convert = FORMER[key].now, FORMER[key].to_now
        values = _under(values, key)
        found.append(key)
    return tuple(found), None if found[-1] == "count" else convert


def value_at(scene: Any, column: str) -> Any:
    """Value of a column's key, in its unit, in a scene or its values; None where it is not set."""
    back = None
    for key in (path := keys(column)):
        found = _under(scene, key)
        if found is None and key in FORMER:
            found, back = _under(scene, FORMER[key].now), FORMER[key].back
        scene = found
    return scene if back is None or path[-1] == "count" else converted(scene, back)


def _under(settings: Any, key: str | int) -> Any:
    """Value of a key, or of an item; None where there is none."""
    if isinstance(key, int):
        return settings[key] if settings is not None and key < len(settings) else None
    return settings.get(key) if isinstance(settings, dict) else getattr(settings, key, None)
