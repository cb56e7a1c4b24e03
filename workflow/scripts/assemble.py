"""Assemble M, K(Omega) and S on a mesh."""

from adapter import stage

from fem.assemble import assemble
from geometry.blade import Blade
from geometry.settings import read_settings

with stage(snakemake):
    blade = read_settings(Blade, snakemake.params.blade)
    name, speeds = snakemake.wildcards.blade, snakemake.params.speeds
    matrices = assemble(blade, name, snakemake.input.mesh, speeds)
    print("equilibrium residuals over the load:", matrices.residuals)
    matrices.save(snakemake.output.matrices)
