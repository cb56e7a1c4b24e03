"""Run one block of the speeds of a scene."""

from adapter import stage

from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.scene import Scene
from simulate.sweeps.dataset import load, save
from simulate.sweeps.over_speeds import at_speeds, block_speeds

with stage(snakemake) as tell:
    rom = Rom.load(snakemake.input.rom)
    scene = Scene.model_validate(snakemake.params.scene)
    choice = Choice.load(snakemake.input.settings) if scene.accuracy else None
    block = int(snakemake.wildcards.block)
    speeds = block_speeds(scene, rom, block, snakemake.params.blocks)
    start = load(snakemake.input.start) if scene.start else None
    save(at_speeds(scene, rom, speeds, tell, choice, start), snakemake.output.block)
