"""Reduced model -> how the cases of the stability matrix end."""

import json

from adapter import stage

from geometry.files import whole
from rom.model import Rom
from workflow.study.stability_matrix import matrix

with stage(snakemake):
    rom = Rom.load(snakemake.input.rom)
    with whole(snakemake.output.json) as temporary:
        temporary.write_text(json.dumps(matrix(rom), indent=1))
