"""Merge blocks to one sweep, and add speeds around the peaks that the scene asks for."""

from adapter import stage

from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.scene import Scene
from simulate.sweeps.closing_in import close_in
from simulate.sweeps.dataset import load, merge, require_rom, save

with stage(snakemake) as tell:
    runs = merge([load(path) for path in snakemake.input.blocks])
    scene, rom = Scene.model_validate(snakemake.params.scene), Rom.load(snakemake.input.rom)
    choice = Choice.load(snakemake.input.settings) if scene.accuracy else None
    require_rom(runs, rom)
    start = load(snakemake.input.start) if scene.start else None
    swept = close_in(scene, rom, runs, tell, choice, start)
    save(swept.assign_attrs(name=snakemake.wildcards.scene), snakemake.output.sweep)
