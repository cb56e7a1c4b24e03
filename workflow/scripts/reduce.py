"""Reduce M and K(Omega) to the reduced model; save its basis if asked for."""

from adapter import stage

from fem.matrices import Matrices
from geometry.given import read_blade
from rom.reconstruct import Basis
from rom.reduce import reduce

with stage(snakemake) as tell:
    blade = read_blade(snakemake.params.blade)
    blade = blade.but(**snakemake.params.get("changes", {}))
    fom = Matrices.load(snakemake.input.matrices)
    rom, T = reduce(fom, blade.basis, snakemake.wildcards.directions, tell)
    print(f"n = {rom.n}, f1(0) = {rom.f1:.2f} Hz")
    if snakemake.output.get("basis"):
        Basis.of(fom, T, rom.provenance).save(snakemake.output.basis)
    rom.save(snakemake.output.rom)
