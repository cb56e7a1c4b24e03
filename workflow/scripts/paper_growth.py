"""The worst coatings over ten times the rounds."""

from adapter import stage

from geometry.files import read_json, write_json
from rom.model import Rom
from simulate.dataset import load
from simulate.scene import Scene
from workflow.paper.worst import growth

with stage(snakemake):
    rom, scene = Rom.load(snakemake.input.rom), Scene.model_validate(snakemake.params.scene)
    grid = read_json(snakemake.input.grid)
    rigid = load(snakemake.input.rigid)
    write_json(growth(scene, rom, grid, rigid), snakemake.output.json)
