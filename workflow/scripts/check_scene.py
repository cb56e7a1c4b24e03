"""Check a scene against its reduced model: what no block of its sweep could march."""

from adapter import stage

from rom.model import Rom
from simulate.scene import Scene
from simulate.sweeps.over_speeds import check_sweep

with stage(snakemake) as tell:
    scene = Scene.model_validate(snakemake.params.scene)
    check_sweep(scene, Rom.load(snakemake.input.rom), tell.now)
