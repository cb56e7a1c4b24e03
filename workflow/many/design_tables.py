"""The tables of a design: of all runs, and of all rows, from the numbers that the store has."""

from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated, Any, NamedTuple, Self

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from geometry.base import SettingsError, require_format
from geometry.stored import read, write
from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.marching import STATUSES, WITH_RESULT
from simulate.sweeps import dataset
from simulate.sweeps.dataset import entry, require_numbers
from workflow.many.design import Design
from workflow.many.design_rows import (
    ALWAYS,
    COLUMNS,
    NO_ROW,
    OF_ROW,
    ROW_COLUMNS,
    row_type,
    run_type,
)
from workflow.many.row import About
from workflow.many.store import Store
from workflow.many.table import in_turn, require_kept

FORMAT = 3


class _Kept(NamedTuple):
    """Numbers of a row from the store."""

    runs: NDArray
    row: NDArray  # of one
    sought: tuple[int, ...]  # engine orders

    @classmethod
    def of(cls, value: dict[str, Any]) -> Self:
        """From the plain values that the store has."""
        runs, sought, row = value["numbers"].values()
        table = np.array([tuple(run) for run in runs], run_type(len(runs[0][-1])))
        return cls(table, np.array([tuple(row)], row_type(len(sought))), tuple(sought))

    @property
    def why(self) -> str:
        """How many runs ended otherwise than ok, by status."""
        ends = Counter(STATUSES[code] for code in self.runs["status"])
        return ", ".join(f"{count} {end}" for end, count in ends.items() if end != "ok")


type _Group = Sequence[tuple[int, _Kept]]  # rows by their numbers, of the same engine orders


def _runs_of(group: _Group) -> xr.Dataset:
    """Table of their runs."""
    runs = np.concatenate([of.runs for _, of in group])
    number = np.repeat(*np.transpose([(row, len(of.runs)) for row, of in group])).astype(np.int32)
    variables = {"row": entry(("run",), number, "", "row of the design, from 1")}
    for name, (_, *about) in COLUMNS.items():
        variables[name] = entry(("run", "order")[: runs[name].ndim], runs[name], *about)
    return xr.Dataset(variables, {"order": np.arange(1, runs["amplitudes"].shape[1] + 1)})


def _rows_of(group: _Group) -> xr.Dataset:
    """Table of the rows."""
    rows, (_, first) = np.concatenate([of.row for _, of in group]), group[0]
    variables = {
        name: entry(axes, rows[name], *about) for name, (axes, _, *about) in ROW_COLUMNS.items()
    }
    return xr.Dataset(variables, {"row": [row for row, _ in group], "order": [*first.sought]})


def tables(
    design: Design,
    rom: Rom,
    blocks: Iterable[Iterable[About]],
    folder: str | Path,
    choice: Choice | None = None,
) -> tuple[xr.Dataset, xr.Dataset]:
    """Tables of the runs, and of the rows, of a design, whose numbers are in the store ``folder``.

    ``rom``: reduced model of the scene's blade; ``choice``: that of ``march_block``.

    Raises
    ------
    geometry.base.errors.UserError
        When the store has lost some, or no row has a result.
    """
    entries = in_turn(blocks)
    kept = Store(folder).read({about["key"] for about in entries if "key" in about}, _Kept.of)
    require_kept(entries, kept, folder)
    groups: dict[Any, list[tuple[int, _Kept]]] = {}
    for done in (about for about in entries if "key" in about):
        of = kept[done["key"]]
        groups.setdefault((of.runs.dtype, of.sought), []).append((done["number"], of))
    if not groups:
        about = {"file": design.path, "key": f"row {entries[0]['row']}"}
        raise SettingsError(f"no row has a result; of this one: {entries[0]['refused']}", **about)
    joined = {"join": "outer", "fill_value": NO_ROW, "combine_attrs": "override"}
    runs = xr.concat([*map(_runs_of, groups.values())], dim="run", **joined)
    rows = xr.concat([*map(_rows_of, groups.values())], dim="row", **joined)
    rows = rows.reindex(row=[about["number"] for about in entries], fill_value=NO_ROW)
    why = [kept[of["key"]].why if "key" in of else of["refused"] for of in entries]
    rows["why"] = entry(OF_ROW, why, "", "runs that ended otherwise than ok; why a row has none")
    for column in entries[0]["settings"]:
        values = [about["settings"][column] for about in entries]
        rows[column] = "row", _plain(values), {"long_name": "given"}
    if sobol := design.sobol:
        meaning = "factors on values of the scene"
        rows["factors"] = entry(("row", "factor"), sobol.points(), "1", meaning)
        rows = rows.assign_coords(factor=[*sobol.factors]).assign_attrs(
            sobol=sobol.model_dump_json()
        )
    attrs = dataset.attributes(design.base, rom, choice)
    del attrs["gap_m"]  # rows may differ in it
    attrs |= {"format": FORMAT, "design": design.path.name}
    of_both = runs.sortby(["row", "speed"]), rows
    return tuple(table.assign_attrs(attrs) for table in of_both)


def _plain(values: Sequence[Any]) -> NDArray:
    """Numbers, nan for None, where all values are numbers; else their text."""
    if all(value is None or isinstance(value, int | float) for value in values):
        return np.array([np.nan if value is None else value for value in values], float)
    return np.array(["" if value is None else str(value) for value in values])


def load(path: str | Path) -> xr.Dataset:
    """Read a table.

    Raises
    ------
    ProvenanceError
        When it is missing, damaged, or none.
    """
    run_again = "delete it, and run the design again"
    with read(path, "table of runs", run_again) as table:
        require_format(table.attrs, FORMAT, path, run_again)
        _require_columns(table.load())
        return table


save = write  # a table to a path
Rows = Annotated[xr.Dataset, load]  # an argument of a job, read by ``load`` from its path


def _require_columns(table: xr.Dataset) -> None:
    """Check the columns of a table of runs or of rows, as they are written.

    Raises
    ------
    KeyError, ValueError
        When one is missing, has other dimensions, or no number in a run that has a result.
    """
    of_runs = "run" in table.sizes
    dims: dict[str, tuple[str, ...]] = {name: axes for name, (axes, *_) in ROW_COLUMNS.items()}
    if of_runs:
        dims = dict.fromkeys(COLUMNS, ("run",)) | {"row": ("run",), "amplitudes": ("run", "order")}
    if "design" not in table.attrs:  # made by hand
        dims = {name: axes for name, axes in dims.items() if name in table}
    with_result = [STATUSES.index(status) for status in WITH_RESULT]
    codes = range(-1, len(STATUSES))
    require_numbers(table, dims, codes, with_result, ALWAYS if of_runs else set())
