"""Scene and reduced model -> map of stable and accurate steps over E."""

import json

from adapter import stage

from geometry.files import whole
from rom.model import Rom
from simulate.scene import Scene
from workflow.study.stability_map import stability_map

with stage(snakemake):
    study = stability_map(Scene(**snakemake.params.scene), Rom.load(snakemake.input.rom))
    with whole(snakemake.output.json) as temporary:
        temporary.write_text(json.dumps(study, indent=1))
