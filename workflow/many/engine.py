"""Computed rows: of experiments and of designs, in blocks.

Each row that is done is kept in a store (``store``) under a hash of all that decides its numbers:
its scene, its model, its reference, the code. A row asked for later, with more rows or in another
number of blocks, is computed only if the store has it not. A row that is refused stays a row, with
its reason.
"""

from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache, cached_property, lru_cache, partial
from importlib import import_module
from inspect import signature
from pathlib import Path
from statistics import mean, median
from time import monotonic, process_time
from typing import Any

import xarray as xr

from geometry.base import (
    WARNING,
    ProvenanceError,
    Say,
    SettingsError,
    UserError,
    WriteError,
    code_hash,
    file_hash,
    fingerprint,
    progress,
    silent,
)
from geometry.blade import Blade
from geometry.elsewhere import MatricesElsewhere, ModelElsewhere, read_blade
from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.errors.run import Case, Run
from simulate.marching import Setup, check_scene, make_kernel, prepare
from simulate.scene import Scene
from simulate.sweeps.sweep import sweep
from workflow.many.row import About, Row
from workflow.many.store import Store

RECENT = 100  # rows computed, by whose time the time left is told
TURNS, LONG = 3, 1.0  # most times a run is computed, and CPU time, s, after which no more


@dataclass
class Shared:
    """What the rows of a block share."""

    choice: Choice | None = None  # of step, rods and strips, for the accuracy of their base
    budget: float = 0.0  # steps that checks may take
    warned: set[str] = field(default_factory=set)  # keys of which a warning was said
    row: str = ""  # name of the one that is computed


@dataclass(frozen=True)
class Marched:
    """A row on its model, computed when its results are asked for.

    Functions of numbers get those of these attributes that are their arguments, and of ``files``.
    """

    case: Row
    rom: Rom | None  # None where it needs none
    files: Mapping[str, str] = field(default_factory=dict)  # further files of its model, by name
    reference: "Marched | None" = None  # the row with which it is compared
    shared: Shared = field(default_factory=Shared)
    seconds: list[float] = field(default_factory=list)  # CPU time of each computation of its run

    @property
    def scene(self) -> Scene:
        """Its scene."""
        return self.case.scene

    @property
    def number(self) -> int:
        """Its number in the table, from 1."""
        return self.case.number

    @property
    def blade(self) -> Blade | MatricesElsewhere | ModelElsewhere:
        """Settings of its blade."""
        return read_blade(f"workflow/blades/{self.scene.blade}.yaml")

    @cached_property
    def setup(self) -> Setup:
        """The set-up at its first speed."""
        check_scene(self.scene, self.rom)
        return prepare(self.scene, self.rom, float(self.scene.speeds.omega(self.rom.f1)[0]))

    def _timed[Result](self, march: Callable[[], Result]) -> Result:
        """Result of a ``march``; its CPU time, without that of compiling, is kept."""
        make_kernel(self.scene, self.setup)
        begun = process_time()
        result = march()
        self.seconds.append(process_time() - begun)
        return result

    @cached_property
    def runs(self) -> xr.Dataset:
        """The sweep over its speeds, with those around its peaks."""
        return self._timed(partial(sweep, self.scene, self.rom))

    @cached_property
    def single(self) -> Run:
        """The run at its first speed alone, repeated while it is short, for its CPU time."""
        march = Case(self.scene, self.rom, self.setup).march
        run = self._timed(march)
        while len(self.seconds) < TURNS and sum(self.seconds) < LONG:
            run = self._timed(march)
        return run

    @cached_property
    def key(self) -> str:
        """Hash of all that decides its numbers."""
        functions = [function for function in (self.case.function, self.case.model) if function]
        return fingerprint(
            [
                self.scene.model_dump_json(),
                self.rom and self.rom.provenance.hash,
                functions,
                code_hash(__name__, *(function.partition(":")[0] for function in functions)),
                {name: file_hash(file) for name, file in self.files.items()},
                self.reference and self.reference.key,
                self.shared.choice and self.shared.choice.plain(),
                self.number if "number" in _asked(self.case.function) else None,
            ]
        )

    def numbers(self) -> dict[str, Any]:
        """Its numbers, and the CPU time of its run."""
        numbers = _called(self.case.function, self)
        return {"cpu_s": float(f"{median(self.seconds or [0.0]):.4g}"), "numbers": numbers}


@cache
def _asked(name: str) -> dict[str, Any]:
    """Arguments of a function of numbers."""
    return dict(signature(_function(name)).parameters)


def _function(name: str) -> Callable[..., Any]:
    module, _, function = name.partition(":")
    return getattr(import_module(module), function)


def _called(name: str, marched: Marched) -> Any:
    """Result of a function whose arguments are attributes and files of a row."""
    values = {asked: marched.files.get(asked) or getattr(marched, asked) for asked in _asked(name)}
    return _function(name)(**values)


def march_block(
    rows: Iterable[Row],
    folder: str | Path,
    total: int,
    tell: Say = silent,
    models: Mapping[str, Rom] | None = None,
    choice: Choice | None = None,
    others: Iterable[Row] = (),
) -> list[About]:
    """Compute the ``rows`` that the store in the ``folder`` has not; what they are, or why not.

    Rows that are compared with the same one should follow one another: it is computed once.

    Parameters
    ----------
    total : number of the ``rows``, which are taken one at a time.
    models : reduced models of blades; those of other blades are read from their files.
    choice : step, rods and strips of all rows, chosen for the accuracy of their base.
    others : rows with which they are compared.

    Raises
    ------
    geometry.base.errors.UserError
        When a model cannot be read, or the store not be written.
    """
    store, shared = Store(folder), Shared(choice and replace(choice, runs={}))
    load, named = cache(Rom.load), {(row.label, row.row): row for row in others}

    @lru_cache(maxsize=1)
    def reference(label: str, row: str) -> Marched:
        """Row with which others are compared, computed once for all that follow."""
        marched = on_model(named[label, row])
        try:
            if marched.rom is not None:
                check_scene(marched.scene, marched.rom)
        except UserError as error:
            raise error.within(key=f"against {row}") from None
        return marched

    def on_model(row: Row) -> Marched:
        """The row on its model, with the row with which it is compared."""
        files = {name: row.file(name) for name in row.needs if name != "rom"}
        rom = (models or {}).get(row.scene.blade) if "rom" in row.needs else None
        if rom is None and "rom" in row.needs:
            rom = load(row.file("rom"))
        other = None if row.against in (None, row.row) else reference(row.label, row.against)
        marched = Marched(row, rom, files, other, shared)
        return replace(marched, rom=_called(row.model, marched)) if row.model else marched

    def computed(row: Row) -> str:
        """Key of the row, whose numbers are then in the store."""
        if row.scene is None:
            raise SettingsError(*row.refused)
        marched, begun, shared.row = on_model(row), monotonic(), row.row
        if marched.key not in store.keys:
            store.add(marched.key, marched.numbers())
            took.append(monotonic() - begun)
            done = len(entries) + 1
            ahead = progress.remaining(done, total, done * mean(took))
            tell(f"row {row.row}, {row.label}: {took[-1]:.2f} s; row {ahead}")
        return marched.key

    entries, took, refused = [], deque(maxlen=RECENT), []
    for row in rows:
        try:
            outcome = {"key": computed(row)}
        except (ProvenanceError, WriteError):  # of the model, of the store
            raise
        except UserError as error:
            outcome = {"refused": "; ".join(map(str, error.faults))}
            refused.append(f"row {row.row}, {row.label}: {outcome['refused']}")
            tell(refused[-1])
        entries.append(row.about | outcome)
    if refused:
        count = f"{len(refused)} of the {total} rows of this block"
        tell(f"{WARNING}{count} refused; the first: {refused[0]}")
    return entries
