"""Modes and compliance of matrices made elsewhere, at their own speeds."""

from adapter import stage

from fem.matrices import Matrices
from rom.full_model import solve

with stage(snakemake):
    fom = Matrices.load(snakemake.input.matrices)
    full = solve(fom, fom.states())
    print(f"largest residual of a mode: {full.residuals.max():.1e}")
    full.save(snakemake.output.full)
