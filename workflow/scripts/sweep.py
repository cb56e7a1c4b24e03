"""Blocks -> one sweep, speeds ascending, closer around the peaks that the scene asks for."""

from adapter import stage

from rom.model import Rom
from simulate.accuracy import Choice
from simulate.peaks import close_in
from simulate.scene import Scene
from simulate.sweep import load, merge, require_rom, save

with stage(snakemake):
    found = merge([load(path) for path in snakemake.input.blocks])
    scene, rom = Scene.model_validate(snakemake.params.scene), Rom.load(snakemake.input.rom)
    choice = Choice.load(snakemake.input.settings) if scene.accuracy else None
    require_rom(found, rom)
    found = close_in(scene, rom, found, print, choice).assign_attrs(name=snakemake.wildcards.scene)
    save(found, snakemake.output.sweep)
