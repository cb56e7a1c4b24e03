"""Reduced model and scene with an accuracy -> the settings that meet it."""

from adapter import stage, write_json

from rom.model import Rom
from simulate.accuracy import basis_error, choose
from simulate.scene import Scene

with stage(snakemake):
    scene = Scene.model_validate(snakemake.params.scene)
    error = basis_error(snakemake.input.check)
    choice = choose(scene, Rom.load(snakemake.input.rom), error)
    write_json(choice.plain(), snakemake.output.settings)
