"""Write the two tables of a design from its blocks."""

from pathlib import Path

from adapter import stage

from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.scene import Scene
from simulate.scene.design import Design
from simulate.sweeps.design_runs import Engine, load, merge, row_table, save

with stage(snakemake):
    scene = Scene.model_validate(snakemake.params.scene)
    choice = Choice.load(snakemake.input.settings) if scene.accuracy else None
    design = Design.of(scene, Path(snakemake.params.file))
    engine = Engine.of(design, Rom.load(snakemake.input.rom), choice)
    runs = merge([load(path) for path in snakemake.input.blocks])
    save(runs, snakemake.output.runs)
    save(row_table(engine, runs), snakemake.output.rows)
