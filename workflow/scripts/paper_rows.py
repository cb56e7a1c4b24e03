"""One row of a table of coatings: of the grid of E and K, or of the map of contact stiffness."""

from importlib import import_module

from adapter import stage

from geometry.files import write_json
from rom.model import Rom
from simulate.scene import Scene

with stage(snakemake):
    rom, scene = Rom.load(snakemake.input.rom), Scene.model_validate(snakemake.params.scene)
    table = import_module(f"workflow.paper.{snakemake.params.table}")
    write_json(table.row(scene, rom, snakemake.params.value), snakemake.output.json)
