"""The worst coatings over ten times the rounds."""

import json
from pathlib import Path

from adapter import stage, write_json

from rom.model import Rom
from simulate.scene import Scene
from simulate.sweep import load
from workflow.paper.worst import growth

with stage(snakemake):
    rom, scene = Rom.load(snakemake.input.rom), Scene.model_validate(snakemake.params.scene)
    grid = json.loads(Path(snakemake.input.grid).read_text())
    rigid = load(snakemake.input.rigid)
    write_json(growth(scene, rom, grid, rigid), snakemake.output.json)
