"""M and K(Omega) -> reduced model on one of the bases that are compared."""

from adapter import stage

from fem.matrices import Matrices
from rom.reduce import reduce
from rom.speeds import basis_speeds
from workflow.study.trade_models import BASES

with stage(snakemake):
    basis = BASES[snakemake.wildcards.basis]
    fom = Matrices.load(snakemake.input.matrices)
    speeds = basis_speeds(basis, float(fom.speeds[-1]))
    rom, _ = reduce(fom.at(speeds), basis, snakemake.wildcards.directions)
    print(f"n = {rom.n}, f1(0) = {rom.f1:.2f} Hz")
    rom.save(snakemake.output.rom)
