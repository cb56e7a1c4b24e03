"""The rows of a design."""

from pathlib import Path
from typing import Any

from geometry.project import Say
from simulate.scene.design import Design
from simulate.sweeps import dataset
from simulate.sweeps.closing_in import sweep as swept
from simulate.sweeps.design_runs import Engine, load, march_block, merge, row_table, save
from workflow.jobs.march import given


def _engine(scene: dict[str, Any], rom: str, settings: str, file: str) -> Engine:
    of, model, choice, _ = given(scene, rom, settings)
    return Engine.of(Design.of(of, Path(file)), model, choice)


def block(
    scene: dict[str, Any],
    rom: str,
    file: str,
    parts: str,
    blocks: int,
    names: dict[str, str],
    block: str,
    tell: Say,
    settings: str = "",
) -> None:
    """Run one of the ``blocks`` of the rows; ``parts``: folder of the rows that are done."""
    engine = _engine(scene, rom, settings, file)
    save(march_block(engine, parts, int(names["block"]), blocks, tell), block)


def tables(
    scene: dict[str, Any],
    rom: str,
    file: str,
    blocks: list[str],
    runs: str,
    rows: str,
    settings: str = "",
) -> None:
    """Write both tables of a design from its blocks."""
    engine, merged = _engine(scene, rom, settings, file), merge([load(path) for path in blocks])
    save(merged, runs)
    save(row_table(engine, merged), rows)


def row(
    scene: dict[str, Any],
    rom: str,
    file: str,
    settings: str,
    names: dict[str, str],
    sweep: str,
    tell: Say,
) -> None:
    """Run one row as a sweep, with all that its scene records."""
    of, model, choice, _ = given(scene, rom, settings)
    one = Design.of(of, Path(file)).require_row(int(names["row"]))
    name = f"{names['scene']}, row {names['row']}"
    dataset.save(swept(one, model, tell, choice).assign_attrs(name=name), sweep)
