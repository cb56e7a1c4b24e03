"""Assemble M, K(Omega) and S on a mesh."""

from adapter import stage

from geometry.blade import Blade
from geometry.project import read_settings
from workflow.assembled import assembled

with stage(snakemake) as tell:
    blade = read_settings(Blade, snakemake.params.blade)
    matrices = assembled(blade, snakemake.wildcards.blade, snakemake.input.mesh, tell)
    print("equilibrium residuals over the load:", matrices.residuals)
    matrices.save(snakemake.output.matrices)
