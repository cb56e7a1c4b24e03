"""M and K(Omega) -> reduced model and its basis."""

from adapter import stage

from fem.matrices import Matrices
from geometry.blade import Blade
from geometry.settings import read_settings
from rom.reconstruct import Basis
from rom.reduce import reduce

with stage(snakemake):
    blade = read_settings(Blade, snakemake.params.blade)
    fom = Matrices.load(snakemake.input.matrices)
    rom, T = reduce(fom, blade.basis, snakemake.wildcards.directions)
    print(f"n = {rom.n}, f1(0) = {rom.f1:.2f} Hz")
    Basis.of(fom, T, rom.provenance).save(snakemake.output.basis)
    rom.save(snakemake.output.rom)
