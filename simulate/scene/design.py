"""Key ``design`` of a scene: a table of many runs, each row a scene with other values of some keys.

The columns of the CSV file are keys of the scene by their paths, ``liner.law.K`` or
``casing.harmonics[0].amplitude_gaps`` (items of lists from 0). A cell is written as in YAML; an
empty one leaves the value of the scene, ``null`` takes the key away. Rows are numbered from 1, the
line below the header. Instead of a CSV file the scene may name a YAML file with a Sobol design
(``scene.sobol``), which draws the rows.
"""

import os
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from copy import deepcopy
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, Self

import numpy as np

from geometry.base import (
    FORMER,
    Fault,
    SettingsError,
    check_settings,
    converted,
    csv_rows,
    merged,
    number,
    parse,
)
from simulate.scene.scene import Scene
from simulate.scene.sobol import Sobol

COLUMN = re.compile(r"[a-zA-Z]\w*(\[\d{1,6}\])*(\.\w+(\[\d{1,6}\])*)*", re.ASCII)
WORD = re.compile(r"[^\W\d_]{2}")  # which no number has
SHOWN, LINES = 3, 30  # row numbers of a fault that a message lists, and its lines
REFUSED = {  # columns that no row may have, by their first key
    "blade": "a design has one reduced model: make a scene with this design for each blade",
    "accuracy": "one pilot chooses step, rods and strips for all rows: give it in the scene",
    "design": "a row is one scene",
    "base": "give it in the scene",
    "format": "give it in the scene",
}

type Keys = tuple[str | int, ...]  # of a column, items of lists as numbers


@dataclass(frozen=True)
class Design:
    r"""The scenes of all rows of a table.

    >>> _ = Path("table.csv").write_text("liner.law.K,damping_ratio\n0.3,0.01\n0.5,\n")
    >>> design = Design.of(scene.but(design="table.csv"), Path("table.csv"))
    >>> [(row.liner.law.K, row.damping_ratio) for row in design.scenes]
    [(0.3, 0.01), (0.5, 0.005)]
    """

    path: Path
    base: Scene  # without its design
    columns: list[str]
    scenes: list[Scene]  # of the rows
    sobol: Sobol | None = None  # where it has drawn the rows
    files: tuple[str, ...] = ()  # paths of the table, and of those that its cells name

    @classmethod
    def load(cls, scene_path: str | Path) -> Self:
        """Read the scene file and the table that it names.

        Raises
        ------
        geometry.base.errors.SettingsError
            When the scene names none, or table or scene are not valid: a line for each fault.
        """
        return cls.of(Scene.load(scene_path), Path(scene_path))

    @classmethod
    def of(cls, scene: Scene, scene_path: Path) -> Self:
        """Read the table of ``scene``, whose file is at ``scene_path``.

        Raises
        ------
        geometry.base.errors.SettingsError
            As ``load``.
        """
        if scene.design is None:
            raise SettingsError("missing: give the table's CSV file", file=scene_path, key="design")
        path, base = scene_path.parent / scene.design, scene.but(design=None)
        sobol = Sobol.load(path) if path.suffix in (".yaml", ".yml") else None
        columns, lines = _drawn(path, sobol, base) if sobol else _read(path)
        scenes, faults = [], []
        values = base.model_dump(exclude_unset=True)
        for row, line in enumerate(lines, 1):
            try:
                scenes.append(_scene(values, columns, line))
            except SettingsError as error:
                faults += [(row, fault) for fault in error.faults]
        refuse(path, faults)
        words = {cell for line in lines for cell in line if WORD.search(str(cell))}
        named = {text for cell in words for text in _texts(_cell(cell))}
        files = str(path), *sorted(filter(os.path.isfile, named))
        return cls(path, base, columns, scenes, sobol, files)

    def require_row(self, row: int) -> Scene:
        """The scene of a row, from 1.

        Raises
        ------
        geometry.base.errors.SettingsError
            When the table has no such row.
        """
        if not 1 <= row <= len(self.scenes):
            raise SettingsError(
                f"allowed 1 to {len(self.scenes)}",
                file=self.path,
                key=f"row {row}",
                allowed={"ge": 1, "le": len(self.scenes)},
            )
        return self.scenes[row - 1]


def keys(column: str) -> Keys:
    """Keys of a column.

    >>> keys("casing.harmonics[0].order")
    ('casing', 'harmonics', 0, 'order')
    """
    parts = re.findall(r"\[(\d+)\]|([^.\[\]]+)", column)
    return tuple(int(item) if item else name for item, name in parts)


def refuse(path: Path, faults: Iterable[tuple[int, Fault]]) -> None:
    """Refuse a table with ``faults``; equal faults of several rows are one line.

    Raises
    ------
    geometry.base.errors.SettingsError
        If there are any.
    """
    rows: dict[str, tuple[Fault, list[int]]] = {}
    for row, fault in faults:
        rows.setdefault(str(fault), (fault, []))[1].append(row)
    lines = [fault._replace(file=f"{path}: {_named(numbers)}") for fault, numbers in rows.values()]
    if len(lines) > LINES:
        lines[LINES:] = [Fault(f"{len(lines) - LINES} more faults", file=str(path))]
    if lines:
        raise SettingsError(*lines)


def _named(rows: list[int]) -> str:
    """Row numbers of a message, not more than ``SHOWN``."""
    shown, others = ", ".join(map(str, rows[:SHOWN])), len(rows) - SHOWN
    return f"row{'s' * (len(rows) > 1)} {shown}" + f" and {others} more" * (others > 0)


def _read(path: Path) -> tuple[list[str], list[list[str]]]:
    """Header and rows of the CSV file; lines without any value are left out."""
    try:
        lines = [cells for _, cells in csv_rows(path) if any(cells)]
    except SettingsError as error:
        raise error.within(path) from None
    columns, *rows = lines or [[]]
    if not rows:
        raise SettingsError("needs a header of keys and at least one row", file=path)
    _require_columns(path, columns)
    return columns, rows


def _drawn(path: Path, sobol: Sobol, base: Scene) -> tuple[list[str], list[list[float]]]:
    """Keys and rows of a Sobol design: values of the base times their factors."""
    columns = [key for factor in sobol.factors.values() for key in factor.keys]
    _require_columns(path, columns)
    values = [value_at(base, column) for column in columns]
    faults = [
        Fault("in the scene: should be a number", f"factors.{column}", value)
        for column, value in zip(columns, values, strict=True)
        if isinstance(value, bool) or not isinstance(value, int | float)
    ]
    if faults:
        raise SettingsError(*faults, file=path)
    keys_of_each = [len(factor.keys) for factor in sobol.factors.values()]
    return columns, (values * np.repeat(sobol.points(), keys_of_each, axis=1)).tolist()


def _require_columns(path: Path, columns: Sequence[str]) -> None:
    """Refuse keys that no row may have.

    Raises
    ------
    SettingsError
        With a line for each.
    """
    faults = [Fault(fault, "column", name) for name in columns for fault in _refused(name, columns)]
    if faults:
        raise SettingsError(*dict.fromkeys(faults), file=path)


def _refused(name: str, columns: Sequence[str]) -> list[str]:
    """Why there may be no such column; empty if there may."""
    if not COLUMN.fullmatch(name):
        return ["is no key of a scene"]
    path = keys(name)
    faults = [REFUSED[path[0]]] if path[0] in REFUSED else []
    within = (
        other for other in columns if other != name and path[: len(keys(other))] == keys(other)
    )
    faults += [f"is a part of column {other!r}" for other in within if other]
    return faults + ["is there twice"] * (columns.count(name) > 1)


def _scene(values: dict[str, Any], columns: list[str], line: list[Any]) -> Scene:
    """The scene of a row: ``values`` of the base with the row's own."""
    if len(line) != len(columns):
        raise SettingsError(f"{len(line)} cells for {len(columns)} columns")
    cells = {name: text for name, text in zip(columns, line, strict=True) if text != ""}
    return check_settings(Scene, placed(values, cells, read=_cell), "")


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


def _cell(text: Any) -> Any:
    """Value of a cell; of a number, itself."""
    value = parse(text)[0] if isinstance(text, str) else text
    if isinstance(value, str):
        with suppress(ValueError):  # it stays a text
            value = number(value)
    return value


def _texts(value: Any) -> list[str]:
    """All texts in a value of a cell, some of which may be names of files."""
    if isinstance(value, str):
        return [value]
    parts = value.values() if isinstance(value, dict) else value if isinstance(value, list) else []
    return [text for part in parts for text in _texts(part)]


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
