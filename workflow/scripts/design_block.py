"""Run one block of the rows of a design."""

from pathlib import Path

from adapter import stage

from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.scene import Scene
from simulate.scene.design import Design
from simulate.sweeps.design_runs import Engine, march_block, save

with stage(snakemake) as tell:
    params, scene = snakemake.params, Scene.model_validate(snakemake.params.scene)
    choice = Choice.load(snakemake.input.settings) if scene.accuracy else None
    design = Design.of(scene, Path(params.file))
    engine = Engine.of(design, Rom.load(snakemake.input.rom), choice)
    block = int(snakemake.wildcards.block)
    save(march_block(engine, params.parts, block, params.blocks, tell), snakemake.output.block)
