"""The worst coatings over ten times the rounds."""

import json
from pathlib import Path

from adapter import stage, write_json

from rom.model import Rom
from simulate.scene import Scene
from workflow.paper.worst import growth

with stage(snakemake):
    rom, scene = Rom.load(snakemake.input.rom), Scene.model_validate(snakemake.params.scene)
    grid = json.loads(Path(snakemake.input.grid).read_text())
    write_json(growth(scene, rom, grid), snakemake.output.json)
