"""Reduced model and scene -> its whole sweep, in one job."""

from adapter import stage

from rom.model import Rom
from simulate.peaks import close_in
from simulate.scene import Scene
from simulate.sweep import save, sweep

with stage(snakemake):
    rom, scene = Rom.load(snakemake.input.rom), Scene.model_validate(snakemake.params.scene)
    found = sweep(scene, rom, scene.speeds.omega(rom.f1), report=print)
    save(close_in(scene, rom, found, report=print), snakemake.output.sweep)
