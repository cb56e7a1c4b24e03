"""Both coatings with one choice made otherwise."""

from adapter import stage, write_json

from rom.model import Rom
from simulate.scene import Scene
from workflow.paper.causes import pair

with stage(snakemake):
    scene = Scene.model_validate(snakemake.params.scene)
    found = pair(scene, Rom.load(snakemake.input.rom), snakemake.params.cause)
    write_json(found, snakemake.output.json)
