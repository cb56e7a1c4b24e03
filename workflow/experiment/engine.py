"""Computed rows of an experiment, and their table.

Each row that is done is kept in a file of its own, under a hash of all that decides its numbers:
its scene, its model, its reference, the code. A row asked for later, with more rows
or in another number of blocks, is computed only if it has no file.
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
from typing import Any

import xarray as xr

from geometry.base import (
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
from geometry.blade import Blade
from geometry.elsewhere import MatricesElsewhere, ModelElsewhere, read_blade
from rom.model import Rom
from simulate.errors.run import Case, Run
from simulate.marching import Setup, check_scene, make_kernel, prepare
from simulate.scene import Scene
from simulate.sweeps.sweep import sweep
from workflow.experiment.plan import PlannedRow
from workflow.experiment.row import ExperimentRow

TURNS, LONG = 3, 1.0  # most times a run is computed, and CPU time, s, after which no more


@dataclass(frozen=True)
class Marched:
    """A case on its model, computed when its results are asked for.

    Functions of numbers get those of these attributes that are their arguments, and of ``files``.
    """

    case: PlannedRow
    rom: Rom | None  # None where it needs none
    files: Mapping[str, str]  # further files of its model, by name
    reference: "Marched | None"  # the case with which it is compared
    seconds: list[float] = field(default_factory=list)  # CPU time of each computation of its run

    @property
    def scene(self) -> Scene:
        """Its scene."""
        return self.case.scene

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
            ]
        )

    def row(self, folder: str | Path) -> ExperimentRow:
        """Description of the row, its numbers and their CPU time.

        These are in a file of ``folder``; where no whole one is there, the row is computed.

        Raises
        ------
        geometry.base.errors.UserError
            When it cannot be computed; the message names the row.
        """
        about = {
            "group": self.case.group,
            "row": self.case.row,
            "names": self.case.names,
            "scene": self.case.label,
            "blade": self.scene.blade,
            "against": self.case.against,
            "rom": self.case.file("rom"),
            "settings": self.scene.model_dump(mode="json"),
        }
        file = Path(folder, f"{self.key}.json")
        with suppress(ProvenanceError):
            return about | read_json(file)
        try:
            numbers = _called(self.case.function, self)
        except UserError as error:
            raise error.within(key=f"{self.case.row}, {self.case.label}") from None
        write_json(
            {"cpu_s": float(f"{median(self.seconds or [0.0]):.4g}"), "numbers": numbers}, file
        )
        return about | read_json(file)


def _called(name: str, marched: Marched) -> Any:
    """Result of a function whose arguments are attributes and files of a case."""
    module, _, function = name.partition(":")
    call = getattr(import_module(module), function)
    return call(
        **{
            asked: marched.files.get(asked) or getattr(marched, asked)
            for asked in signature(call).parameters
        }
    )


def march_block(
    cases: Sequence[PlannedRow],
    folder: str | Path,
    block: str | int = 0,
    blocks: int = 1,
    tell: Say = silent,
) -> list[ExperimentRow]:
    """Rows of every ``blocks``-th case from ``block`` on; those in files of ``folder`` are read.

    Cases that are compared with the same one follow one another, so that it is computed once.

    Raises
    ------
    simulate.marching.setup.SceneError
        When a scene does not fit its model; the message names the row.
    """
    named, model = {(case.label, case.row): case for case in cases}, cache(Rom.load)

    @lru_cache(maxsize=1)
    def reference(label: str, row: str) -> Marched:
        """Row with which others are compared, computed once for all that follow."""
        return on_model(named[label, row])

    def on_model(case: PlannedRow) -> Marched:
        """The row on its model, with the row with which it is compared."""
        files = {name: case.file(name) for name in case.needs if name != "rom"}
        rom = model(case.file("rom")) if "rom" in case.needs else None
        alone = case.against in (None, case.row)
        marched = Marched(case, rom, files, None if alone else reference(case.label, case.against))
        return replace(marched, rom=_called(case.model, marched)) if case.model else marched

    chosen, rows, begun = cases[int(block) :: blocks], {}, monotonic()
    for i in sorted(range(len(chosen)), key=lambda i: (chosen[i].label, chosen[i].against or "")):
        rows[i] = on_model(chosen[i]).row(folder)
        ahead = progress.remaining(len(rows), len(chosen), monotonic() - begun)
        tell(f"{chosen[i].row}, {chosen[i].label}: {rows[i]['cpu_s']} s; row {ahead}")
    return [rows[i] for i in range(len(chosen))]
