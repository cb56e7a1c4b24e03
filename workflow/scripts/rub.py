"""The animation of a scene at one speed."""

from adapter import stage

from rom.model import Rom
from simulate.scene import Scene
from workflow.explore.rub import march, save

with stage(snakemake):
    scene, rom = Scene.model_validate(snakemake.params.scene), Rom.load(snakemake.input.rom)
    save(march(scene, rom, float(snakemake.wildcards.speed)), snakemake.output.animation)
