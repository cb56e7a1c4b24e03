"""Scene and reduced model -> map of stable and accurate steps over E."""

from adapter import stage

from geometry.files import write_json
from rom.model import Rom
from simulate.scene import Scene
from workflow.study.stability_map import stability_map

with stage(snakemake):
    study = stability_map(Scene(**snakemake.params.scene), Rom.load(snakemake.input.rom))
    write_json(study, snakemake.output.json)
