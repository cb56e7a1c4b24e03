"""Reduced against full model; a model that misses its own tolerance fails."""

from adapter import stage

from rom.check import check
from rom.full_model import FullModel
from rom.model import Rom

with stage(snakemake):
    result = check(Rom.load(snakemake.input.rom), FullModel.load(snakemake.input.full))
    print(f"largest frequency error of each mode: {abs(result.error).max(axis=0)}")
    result.require(snakemake.params.tolerance)
    result.save(snakemake.output.check)
