"""Reduced model against the full one at the speeds of the check."""

from adapter import stage

from fem.matrices import Matrices
from rom.check import check
from rom.model import Rom

with stage(snakemake):
    result = check(Rom.load(snakemake.input.rom), Matrices.load(snakemake.input.matrices))
    print(f"largest frequency error of each mode: {abs(result.error).max(axis=0)}")
    result.save(snakemake.output.check)
