"""Run one row of a design as a sweep, with all that its scene records."""

from pathlib import Path

from adapter import stage

from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.scene import Scene
from simulate.scene.design import Design
from simulate.sweeps.closing_in import sweep
from simulate.sweeps.dataset import save

with stage(snakemake) as tell:
    rom, scene = Rom.load(snakemake.input.rom), Scene.model_validate(snakemake.params.scene)
    choice = Choice.load(snakemake.input.settings) if scene.accuracy else None
    design = Design.of(scene, Path(snakemake.params.file))
    row = design.require_row(int(snakemake.wildcards.row))
    name = f"{snakemake.wildcards.scene}, row {snakemake.wildcards.row}"
    save(sweep(row, rom, tell, choice).assign_attrs(name=name), snakemake.output.sweep)
