"""Compare a reduced model with the full one; fail if its error exceeds its tolerance."""

from adapter import stage

from rom.check import check
from rom.full_model import FullModel
from rom.model import Rom

with stage(snakemake):
    result = check(Rom.load(snakemake.input.rom), FullModel.load(snakemake.input.full))
    print(f"largest frequency error of each mode: {abs(result.error).max(axis=0)}")
    result.require(snakemake.params.tolerance)
    result.save(snakemake.output.check)
