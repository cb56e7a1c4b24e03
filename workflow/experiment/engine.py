"""Rows of an experiment marched, and their table.

Each row that is done is kept in a file of its own, under a hash of all that decides its numbers:
its scene, its model, what it is compared with, the code. Whatever is asked for next, with more rows
or in another number of blocks, is marched only if it has no file.
"""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cache, cached_property, lru_cache, partial
from importlib import import_module
from inspect import signature
from pathlib import Path
from statistics import median
from time import monotonic, process_time
from typing import Any, NamedTuple

import xarray as xr

from geometry.blade import Blade
from geometry.given import GivenMatrices, GivenModel, read_blade
from geometry.project import (
    ProvenanceError,
    Say,
    UserError,
    code_hash,
    file_hash,
    fingerprint,
    progress,
    read_json,
    silent,
    write_json,
)
from rom.model import Rom
from simulate.errors.neighbours import Case as Prepared
from simulate.errors.observables import Run
from simulate.marching import Setup, check_scene, make_kernel, prepare
from simulate.scene import Scene
from simulate.sweeps.closing_in import sweep
from workflow.experiment.plan import Case

TURNS, LONG = 3, 1.0  # most marches of a single run, and CPU time, s, after which there is no more
REFERENCES = 4  # marched ones that are kept in memory

_hash = cache(file_hash)  # matrices of a blade serve many rows

type Row = dict[str, Any]  # plain values of a row on a scene


class Single(NamedTuple):
    """A run at the first speed of a scene."""

    setup: Setup
    run: Run


@dataclass(frozen=True)
class Marched:
    """A case on its model, marched where its results are asked for.

    Functions of numbers get those of these attributes that are their arguments, and of ``files``.
    """

    case: Case
    rom: Rom | None  # None where it needs none
    files: Mapping[str, str]  # further files of its model, by name
    reference: "Marched | None"  # the case with which it is compared
    seconds: list[float] = field(default_factory=list)  # CPU time of each march, all the same

    @property
    def scene(self) -> Scene:
        """Its scene."""
        return self.case.scene

    @property
    def blade(self) -> Blade | GivenMatrices | GivenModel:
        """Settings of its blade."""
        return read_blade(f"workflow/blades/{self.scene.blade}.yaml")

    def _compiled(self) -> Setup:
        """The set-up at its first speed; the march is compiled: no part of its CPU time."""
        check_scene(self.scene, self.rom)
        setup = prepare(self.scene, self.rom, float(self.scene.speeds.omega(self.rom.f1)[0]))
        make_kernel(self.scene, setup)
        return setup

    def _timed[Result](self, march: Callable[[], Result]) -> Result:
        """What a march gives; its CPU time is kept."""
        begun = process_time()
        result = march()
        self.seconds.append(process_time() - begun)
        return result

    @cached_property
    def runs(self) -> xr.Dataset:
        """The sweep over its speeds, with those around its peaks."""
        self._compiled()
        return self._timed(partial(sweep, self.scene, self.rom))

    @cached_property
    def single(self) -> Single:
        """The run at its first speed alone, repeated while it is short, for its CPU time."""
        case = Prepared(self.scene, self.rom, self._compiled())
        run = self._timed(case.march)
        while len(self.seconds) < TURNS and sum(self.seconds) < LONG:
            run = self._timed(case.march)
        return Single(case.setup, run)

    @cached_property
    def key(self) -> str:
        """Hash of all that decides its numbers."""
        functions = [of for of in (self.case.function, self.case.model) if of]
        return fingerprint(
            [
                self.scene.model_dump_json(),
                self.rom and self.rom.provenance.hash,
                functions,
                code_hash(__name__, *(of.partition(":")[0] for of in functions)),
                {name: _hash(file) for name, file in self.files.items()},
                self.reference and self.reference.key,
            ]
        )

    def row(self) -> Row:
        """Its numbers, what they are of, and their CPU time."""
        numbers = _called(self.case.function, self)
        return {
            "group": self.case.group,
            "row": self.case.row,
            "names": self.case.names,
            "scene": self.case.label,
            "blade": self.scene.blade,
            "against": self.case.against,
            "rom": self.case.file("rom"),
            "cpu_s": float(f"{median(self.seconds or [0.0]):.4g}"),
            "numbers": numbers,
            "settings": self.scene.model_dump(mode="json"),
        }


def _called(name: str, of: Marched) -> Any:
    """What a function makes of those attributes and files of a case that are its arguments."""
    module, _, function = name.partition(":")
    call = getattr(import_module(module), function)
    return call(
        **{asked: of.files.get(asked) or getattr(of, asked) for asked in signature(call).parameters}
    )


def march_block(
    cases: Sequence[Case], folder: str | Path, block: int, blocks: int, report: Say = silent
) -> list[Row]:
    """Rows of every ``blocks``-th case from ``block`` on; those in files of ``folder`` are read.

    Raises
    ------
    simulate.marching.setup.SceneError
        When a scene does not fit its model; the message names the row.
    """
    named, model = {(case.label, case.row): case for case in cases}, cache(Rom.load)

    @lru_cache(REFERENCES)
    def reference(label: str, row: str) -> Marched:
        return on_model(named[label, row])

    def on_model(case: Case) -> Marched:
        itself = case.against in (None, case.row)
        against = None if itself else reference(case.label, case.against)
        files = {name: case.file(name) for name in case.needs}
        rom = model(case.file("rom")) if case.marched else None
        marched = Marched(case, rom, files, against)
        return replace(marched, rom=_called(case.model, marched)) if case.model else marched

    rows, own, begun = [], cases[block::blocks], monotonic()
    for count, case in enumerate(own, 1):
        marched = on_model(case)
        rows.append(_kept_row(marched, Path(folder, f"{marched.key}.json")))
        far = progress.left(count, len(own), monotonic() - begun)
        report(f"{case.row}, {case.label}: {rows[-1]['cpu_s']} s; row {far}")
    return rows


def _kept_row(marched: Marched, file: Path) -> Row:
    """The row in a file; where there is none that is whole, it is marched."""
    with suppress(ProvenanceError):
        return read_json(file)
    try:
        write_json(marched.row(), file)
    except UserError as error:
        raise error.within(key=f"{marched.case.row}, {marched.case.label}") from None
    return read_json(file)


def merge(blocks: Sequence[Sequence[Row]]) -> list[Row]:
    """Rows of all blocks, in the order of the cases.

    >>> merge([["first", "third"], ["second"]])
    ['first', 'second', 'third']
    """
    count = sum(map(len, blocks))
    return [blocks[i % len(blocks)][i // len(blocks)] for i in range(count)]
