"""Reduced model -> how the cases of the stability matrix end."""

from adapter import stage

from geometry.files import write_json
from rom.model import Rom
from workflow.study.stability_matrix import matrix

with stage(snakemake):
    rom = Rom.load(snakemake.input.rom)
    write_json(matrix(rom), snakemake.output.json)
