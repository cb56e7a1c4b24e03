"""Both coatings, or both tip forces, with one choice made otherwise."""

from adapter import stage

from geometry.files import write_json
from rom.model import Rom
from simulate.scene import Scene
from workflow.paper import causes

with stage(snakemake):
    scene = Scene.model_validate(snakemake.params.scene)
    study = getattr(causes, snakemake.params.study)
    found = study(scene, Rom.load(snakemake.input.rom), snakemake.params.cause)
    write_json(found, snakemake.output.json)
