"""Modes and compliance of the full model at the speeds of the check."""

from adapter import stage

from fem.matrices import Matrices
from rom.full_model import solve

with stage(snakemake):
    full = solve(Matrices.load(snakemake.input.matrices))
    print(f"largest residual of a mode: {full.residuals.max():.1e}")
    full.save(snakemake.output.full)
