"""Modes and compliance of the full model at the speeds of the check."""

from adapter import stage

from fem.assemble import over_speeds
from fem.cholesky import Cholesky
from geometry.blade import Blade
from geometry.project import counted, read_settings
from rom.full_model import solve

with stage(snakemake) as tell:
    blade, cholesky = read_settings(Blade, snakemake.params.blade), Cholesky()
    name, speeds = snakemake.wildcards.blade, snakemake.params.speeds
    fom, states = over_speeds(blade, name, snakemake.input.mesh, speeds, cholesky)
    full = solve(fom, counted(states, len(speeds), "speed", tell), cholesky)
    print(f"largest residual of a mode: {full.residuals.max():.1e}")
    full.save(snakemake.output.full)
