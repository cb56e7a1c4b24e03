"""The rows of a design."""

from pathlib import Path

from geometry.base import Say
from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.scene import Scene
from simulate.scene.design import Design
from simulate.sweeps import dataset
from simulate.sweeps.design_runs import Engine, Rows, march_block, merge, row_table, save
from simulate.sweeps.sweep import sweep as swept


def block(
    scene: Scene,
    rom: Rom,
    file: str,
    parts: str,
    blocks: int,
    names: dict[str, str],
    block: str,
    tell: Say,
    settings: Choice | None = None,
) -> None:
    """Run one of the ``blocks`` of the rows; ``parts``: folder of the rows that are done."""
    engine = Engine.of(Design.of(scene, Path(file)), rom, settings)
    save(march_block(engine, parts, int(names["block"]), blocks, tell), block)


def tables(
    scene: Scene,
    rom: Rom,
    file: str,
    blocks: list[Rows],
    runs: str,
    rows: str,
    settings: Choice | None = None,
) -> None:
    """Write both tables of a design from its blocks."""
    engine, merged = Engine.of(Design.of(scene, Path(file)), rom, settings), merge(blocks)
    save(merged, runs)
    save(row_table(engine, merged), rows)


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
