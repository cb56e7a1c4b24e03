"""Blocks of the rows of experiments and designs, and the tables of a design."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from geometry.base import Say, check_settings, read_json
from simulate.sweeps import dataset
from simulate.sweeps.sweep import sweep as swept
from workflow.jobs.given import given
from workflow.many.design import Design
from workflow.many.design_tables import save, tables as tables_of
from workflow.many.engine import march_block
from workflow.many.expected import expected
from workflow.many.row import About, Row

type Settings = Mapping[str, Any]


def experiment(
    cases: Iterable[Settings], blocks: int, block: int, folder: str, tell: Say
) -> list[About]:
    """Compute one of the ``blocks`` of an experiment, into the store ``folder``.

    ``cases``: settings of all rows.
    """
    every = [check_settings(Row, dict(case), "") for case in cases]
    rows = sorted(every[block::blocks], key=lambda row: (row.label, row.against or ""))
    return march_block(rows, folder, len(rows), tell, others=every)


def design(
    scene: Settings,
    rom: str,
    choice: str,
    file: str,
    folder: str,
    block: int,
    blocks: int,
    tell: Say,
    report: Say,
) -> list[About]:
    """Compute one of the ``blocks`` of a design; ``file``: of its ``scene``."""
    of, model, settings, _ = given(scene, rom, choice)
    table = Design.of(of, Path(file))
    chosen = range(block, table.count, blocks)
    if block == 0:
        report(expected(table, model, settings))
    rows = table.rows(chosen)
    return march_block(rows, folder, len(chosen), tell, {of.blade: model}, settings)


def tables(
    scene: Settings,
    rom: str,
    choice: str,
    file: str,
    folder: str,
    blocks: Iterable[str],
    runs: str,
    rows: str,
) -> None:
    """Write both tables of a design from its blocks."""
    of, model, settings, _ = given(scene, rom, choice)
    made = tables_of(Design.of(of, Path(file)), model, [*map(read_json, blocks)], folder, settings)
    for table, path in zip(made, (runs, rows), strict=True):
        save(table, path)


def row(
    name: str, scene: Settings, rom: str, choice: str, file: str, number: int, sweep: str, tell: Say
) -> None:
    """Run the row of a ``number`` as a sweep, with all that its scene of this ``name`` records."""
    of, model, settings, _ = given(scene, rom, choice)
    one = Design.of(of, Path(file)).require_row(number)
    runs = swept(one, model, tell, settings)
    dataset.save(runs.assign_attrs(name=f"{name}, row {number}"), sweep)
