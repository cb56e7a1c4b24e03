"""Mesh -> M and K(Omega)."""

from adapter import stage

from fem.assemble import assemble
from geometry.blade import Blade
from geometry.settings import read_settings

with stage(snakemake):
    blade = read_settings(Blade, snakemake.params.blade)
    source = snakemake.input
    matrices = assemble(blade, source.mesh, source.interface, snakemake.params.speeds)
    print("equilibrium residuals over the load:", matrices.residuals)
    matrices.save(snakemake.output.matrices)
