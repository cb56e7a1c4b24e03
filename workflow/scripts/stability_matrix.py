"""Reduced models with 8 and 16 interface nodes -> how the cases of the stability matrix end."""

import json

from adapter import stage

from geometry.files import whole
from rom.model import Rom
from workflow.study.stability_matrix import matrix, models

with stage(snakemake):
    roms = models(Rom.load(snakemake.input.blade), Rom.load(snakemake.input.sixteen))
    with whole(snakemake.output.json) as temporary:
        temporary.write_text(json.dumps(matrix(roms), indent=1))
