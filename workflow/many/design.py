"""Key ``design`` of a scene: a table of many runs, each row a scene with other values of some keys.

The columns of the CSV file are keys of the scene by their paths (``columns``). A cell is written as
in YAML; an empty one leaves the value of the scene, ``null`` takes the key away. Rows are numbered
from 1, the line below the header. Instead of a CSV file the scene may name a YAML file with a Sobol
design (``sobol``), which draws the rows.

The table is read a line at a time: rows are counted before any is computed, and each becomes a
scene where it is computed. A row whose scene is not valid stays a row, with its reason.
"""

import os
import re
import sys
from collections.abc import Container, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from os.path import normpath
from pathlib import Path
from typing import Any, Self

import numpy as np

from geometry.base import (
    Fault,
    SettingsError,
    check_settings,
    csv_rows,
    failed,
    number,
    parse,
    refuse,
    unquoted,
)
from simulate.scene import Scene, own_laws
from workflow.many.columns import COLUMN, keys, placed, value_at
from workflow.many.row import Row
from workflow.many.sobol import Sobol

# What the name of a file or of a law of one's own has, and no number
FILE = re.compile(r"[/\\]|\.(?![eEdD][+-]?\d)[^\W\d]|\w:[^\W\d]")
LOOKED = 100  # rows at most by whose scenes the columns are checked
NUMBERS = "workflow.many.design_rows:numbers"  # function of a row
BLADE = "blade"  # column
SEED = ".seed"  # ends the columns of seeds
REFUSED = {  # columns that no row may have, by their first key
    "accuracy": "one pilot chooses step, rods and strips for all rows: give it in the scene",
    "design": "a row is one scene",
    "start": "a row starts from rest",
    "base": "give it in the scene",
    "format": "give it in the scene",
}


@dataclass(frozen=True)
class Design:
    r"""The rows of a table.

    >>> _ = Path("table.csv").write_text("liner.law.K,damping_ratio\n0.3,0.01\n0.5,\n")
    >>> design = Design.of(scene.but(design="table.csv"), Path("table.csv"))
    >>> [(row.scene.liner.law.K, row.scene.damping_ratio) for row in design.rows()]
    [(0.3, 0.01), (0.5, 0.005)]
    """

    path: Path
    name: str  # of the scene
    base: Scene  # without its design
    columns: list[str]
    count: int  # of the rows
    blades: tuple[str, ...]  # of the rows, that of the scene first
    files: tuple[str, ...]  # paths of the table, and of those that its cells name
    laws: tuple[str, ...] = ()  # of one's own that its cells name, module:class
    sobol: Sobol | None = None  # where it has drawn the rows

    @classmethod
    def load(cls, scene_path: str | Path) -> Self:
        """Read the scene file, and the header of the table that it names.

        Raises
        ------
        geometry.base.errors.SettingsError
            When the scene names none, or scene or header are not valid: a line for each fault.
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
        path, base = Path(normpath(scene_path.parent / scene.design)), scene.but(design=None)
        about, blades, files = (path, scene_path.stem, base), {base.blade: None}, {str(path): None}
        if path.suffix in (".yaml", ".yml"):
            with unquoted(path):
                sobol = Sobol.load(path)
                columns = [key for factor in sobol.factors.values() for key in factor.keys]
                refuse(_column_faults(columns, base), file=path)
            refuse(_number_faults(columns, base), file=path)
            return cls(*about, columns, sobol.rows, tuple(blades), tuple(files), sobol=sobol)
        lines, count = _lines(path), 0
        with unquoted(path):
            refuse(_column_faults(columns := next(lines, []), base), file=path)
        at = columns.index(BLADE) if BLADE in columns else len(columns)
        first: list[list[str]] = []
        for count, line in enumerate(lines, 1):
            if count <= LOOKED:
                first.append(line)
            blades |= dict.fromkeys(filter(None, line[at : at + 1]))
            files |= dict.fromkeys(filter(FILE.search, line))
        if not count:
            raise SettingsError("needs a header of keys and at least one row", file=path)
        refuse(_key_faults(base, columns, first), file=f"{path}: column")
        named = (_read(cell) for cell in blades)  # another value is refused in its row
        blades = [name for name in named if isinstance(name, str)]
        texts = {text for cell in files for text in _texts(_read(cell))}
        named = str(path), *sorted(filter(os.path.isfile, texts - {str(path)}))
        laws = sorted({law for cell in files for law in re.findall(own_laws.KIND, cell)})
        return cls(*about, columns, count, tuple(blades), named, tuple(laws))

    def rows(self, chosen: Container[int] | None = None) -> Iterator[Row]:
        """The ``chosen`` rows (from 0), or all, with their scenes, which are read and checked."""
        values = self.base.model_dump(exclude_unset=True)
        for index, line in enumerate(self._lines()):
            if chosen is None or index in chosen:
                yield self._row(1 + index, values, line)

    def _lines(self) -> Iterator[list[Any]]:
        """Cells of all rows: of the CSV file; or values of the base times the factors drawn."""
        if self.sobol is None:
            return islice(_lines(self.path), 1, None)
        of_base = [value_at(self.base, column) for column in self.columns]
        keys_of_each = [len(factor.keys) for factor in self.sobol.factors.values()]
        drawn = np.repeat(self.sobol.points(), keys_of_each, axis=1)
        return (line.tolist() for line in of_base * drawn)

    def _row(self, row: int, values: dict[str, Any], line: list[Any]) -> Row:
        """Row of the cells of a ``line``; ``values`` are those of the base.

        Without a scene it has the numbers that are given, but no texts.
        """
        about = {
            "number": row,
            "label": self.name,
            "names": (str(row),),
            "directions": self.base.directions,
            "function": NUMBERS,
        }
        try:
            scene, refused, cells = _scene(values, self.columns, line), (), ()
        except SettingsError as error:
            scene, refused = None, map(str, error.faults)
            cells = zip(self.columns, line, strict=False)
        found = {name: value_at(scene or self.base, name) for name in self.columns}
        found |= {name: _read(cell) for name, cell in cells if cell != ""}
        given = {
            name: value if value is None or _is_number(value) else scene and str(value)
            for name, value in found.items()
        }
        return Row(scene=scene, refused=refused, given=given, **about)

    def require_row(self, row: int) -> Scene:
        """The scene of a row, from 1.

        Raises
        ------
        geometry.base.errors.SettingsError
            When the table has no such row, or its scene is not valid.
        """
        about = {"file": self.path, "key": f"row {row}"}
        if not 1 <= row <= self.count:
            allowed = {"ge": 1, "le": self.count}
            raise SettingsError(f"allowed 1 to {self.count}", allowed=allowed, **about)
        found = next(self.rows({row - 1}))
        if found.scene is None:
            raise SettingsError(*found.refused, **about)
        return found.scene


def over_seeds(path: Path) -> bool:
    """Whether the rows of the table at a path differ by a seed."""
    there = path.suffix == ".csv" and path.is_file()
    return there and any(name.endswith(SEED) for name in next(_lines(path), []))


def _lines(path: Path) -> Iterator[list[str]]:
    """Header and rows of the CSV file. A line of commas alone is the scene as it is."""
    try:
        yield from (cells for _, cells in csv_rows(path))
    except SettingsError as error:
        raise error.within(path) from None


def _column_faults(columns: Sequence[str], base: Scene) -> list[Fault]:
    """Columns that no row may have."""
    return [
        Fault(fault, "column", name) for name in columns for fault in _refused(name, columns, base)
    ]


def _refused(name: str, columns: Sequence[str], base: Scene) -> list[str]:
    """Why there may be no such column; empty if there may."""
    path = keys(name)
    if not COLUMN.fullmatch(name) or path[0] == BLADE != name:
        return ["is no key of a scene"]
    within = (
        other for other in columns if other != name and path[: len(keys(other))] == keys(other)
    )
    return failed(
        (path[0] not in REFUSED, REFUSED.get(path[0], "")),
        (name != BLADE or not base.accuracy, f"accuracy: {REFUSED['accuracy']}, of one blade"),
        *((False, f"is a part of column {other!r}") for other in within if other),
        (columns.count(name) == 1, "is there twice"),
    )


def _key_faults(base: Scene, columns: Sequence[str], lines: Iterable[Sequence[str]]) -> list[Fault]:
    """Columns that are no keys of the scene in any of the ``lines`` that have a value there."""
    values, unknown, known = base.model_dump(exclude_unset=True), {}, set()
    for line in lines:
        faults = {}
        try:
            _scene(values, columns, line)
        except SettingsError as error:
            faults = {fault.key: fault for fault in error.faults if "unknown key" in fault.text}
        for column, cell in zip(columns, line, strict=False):
            above = [key for key in faults if f"{column}.".startswith(f"{key}.")]
            if above:
                unknown[column] = faults[above[0]]
            elif cell not in ("", "null"):
                known.add(column)
    return [fault for column, fault in unknown.items() if column not in known]


def _scene(values: dict[str, Any], columns: Sequence[str], line: Sequence[Any]) -> Scene:
    """The scene of a row: ``values`` of the base with the row's own."""
    if len(line) != len(columns):
        raise SettingsError(f"{len(line)} cells for {len(columns)} columns")
    cells = {name: cell for name, cell in zip(columns, line, strict=True) if cell != ""}
    scene = check_settings(Scene, placed(values, cells, read=_cell), "")
    if scene.speeds.in_turn:
        raise SettingsError("allowed false: speeds of a row start from rest", key="speeds.in_turn")
    return scene


def _is_number(value: Any) -> bool:
    """Whether a value is a number that a table holds."""
    return isinstance(value, int | float) and abs(value) < sys.float_info.max


def _number_faults(columns: Sequence[str], base: Scene) -> list[Fault]:
    """Factors on keys that are no numbers in the scene."""
    return [
        Fault("in the scene: should be a number", f"factors.{column}", value)
        for column in columns
        for value in [value_at(base, column)]
        if isinstance(value, bool) or not isinstance(value, int | float)
    ]


def _cell(text: Any) -> Any:
    """Value of a cell; of a number, itself."""
    value = parse(text)[0] if isinstance(text, str) else text
    if isinstance(value, str):
        with suppress(ValueError):  # it stays a text
            value = number(value)
    return value


def _read(text: Any) -> Any:
    """The same; the text where it is no YAML."""
    with suppress(ValueError):
        return _cell(text)
    return text


def _texts(value: Any) -> list[str]:
    """All texts in a value of a cell, some of which may be names of files."""
    if isinstance(value, str):
        return [value]
    parts = value.values() if isinstance(value, dict) else value if isinstance(value, list) else []
    return [text for part in parts for text in _texts(part)]
