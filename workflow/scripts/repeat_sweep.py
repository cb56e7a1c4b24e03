"""Run the whole sweep of a scene in one job."""

from adapter import stage

from rom.model import Rom
from simulate.scene import Scene
from simulate.sweeps.closing_in import sweep
from simulate.sweeps.dataset import save

with stage(snakemake) as tell:
    rom, scene = Rom.load(snakemake.input.rom), Scene.model_validate(snakemake.params.scene)
    save(sweep(scene, rom, tell), snakemake.output.sweep)
