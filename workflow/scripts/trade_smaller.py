"""Scenes and reduced models -> what less work changes."""

from adapter import stage

from geometry.files import write_json
from simulate.scene import Scene
from workflow.study.trade import rom_of
from workflow.study.trade_smaller import smaller

with stage(snakemake):
    scenes = {name: Scene(**values) for name, values in snakemake.params.scenes.items()}
    write_json(smaller(scenes, rom_of), snakemake.output.json)
