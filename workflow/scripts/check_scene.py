"""Check a scene against its reduced model: what no block of its sweep could march."""

from adapter import stage

from rom.model import Rom
from simulate.over_speeds import check_sweep
from simulate.scene import Scene

with stage(snakemake):
    check_sweep(Scene.model_validate(snakemake.params.scene), Rom.load(snakemake.input.rom))
