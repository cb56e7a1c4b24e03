"""Blocks of the rows of experiments and designs, and the tables of a design."""

from pathlib import Path

from geometry.base import Say
from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.scene import Scene
from simulate.sweeps import dataset
from simulate.sweeps.sweep import sweep as swept
from workflow.many.design import Design
from workflow.many.design_tables import save, tables as tables_of
from workflow.many.engine import march_block
from workflow.many.expected import expected
from workflow.many.row import About, Row


def experiment(cases: list[Row], blocks: int, block: str, folder: str, tell: Say) -> list[About]:
    """Compute one of the ``blocks`` of an experiment, into the store ``folder``."""
    rows = sorted(cases[int(block) :: blocks], key=lambda row: (row.label, row.against or ""))
    return march_block(rows, folder, len(rows), tell, others=cases)


def design(
    scene: Scene,
    rom: Rom,
    file: str,
    folder: str,
    blocks: int,
    block: str,
    tell: Say,
    report: Say,
    settings: Choice | None = None,
) -> list[About]:
    """Compute one of the ``blocks`` of a design; ``file``: of its ``scene``."""
    of = Design.of(scene, Path(file))
    chosen = range(int(block), of.count, blocks)
    if block == "0":
        report(expected(of, rom, settings))
    rows = of.rows(chosen)
    return march_block(rows, folder, len(chosen), tell, {scene.blade: rom}, settings)


def tables(
    scene: Scene,
    rom: Rom,
    file: str,
    folder: str,
    blocks: list[list[About]],
    runs: str,
    rows: str,
    settings: Choice | None = None,
) -> None:
    """Write both tables of a design from its blocks."""
    made = tables_of(Design.of(scene, Path(file)), rom, blocks, folder, settings)
    for table, path in zip(made, (runs, rows), strict=True):
        save(table, path)


def row(
    scene: Scene,
    rom: Rom,
    file: str,
    settings: Choice | None,
    names: dict[str, str],
    sweep: str,
    tell: Say,
) -> None:
    """Run one row as a sweep, with all that its scene records."""
    one = Design.of(scene, Path(file)).require_row(int(names["row"]))
    name = f"{names['scene']}, row {names['row']}"
    dataset.save(swept(one, rom, tell, settings).assign_attrs(name=name), sweep)
