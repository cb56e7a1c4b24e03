"""Assemble M, K(Omega) and S on a mesh."""

from adapter import stage

from fem.assemble import over_speeds
from fem.matrices import Matrices
from geometry.blade import Blade
from geometry.progress import counted
from geometry.settings import read_settings

with stage(snakemake) as tell:
    blade = read_settings(Blade, snakemake.params.blade)
    name, speeds = snakemake.wildcards.blade, snakemake.params.speeds
    constants, states = over_speeds(blade, name, snakemake.input.mesh, speeds)
    matrices = Matrices.of(constants, counted(states, len(speeds), "speed", tell))
    print("equilibrium residuals over the load:", matrices.residuals)
    matrices.save(snakemake.output.matrices)
