"""Mesh -> M and K(Omega)."""

from adapter import stage

from fem.assemble import assemble
from geometry.blade import Blade
from geometry.settings import read_settings
from rom.speeds import basis_speeds, check_speeds

SPEEDS = {"basis": basis_speeds, "check": check_speeds}

with stage(snakemake):
    blade = read_settings(Blade, snakemake.params.blade)
    speeds = SPEEDS[snakemake.params.speeds](blade.max_speed_rad_s)
    matrices = assemble(blade, snakemake.input.mesh, snakemake.input.interface, speeds)
    print("equilibrium residuals over the load:", matrices.residuals)
    matrices.save(snakemake.output.matrices)
