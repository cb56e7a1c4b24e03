"""Modes and compliance of the full model from elsewhere."""

from adapter import job

from workflow.jobs.elsewhere import solve

job(
    snakemake,
    lambda of, tell: solve(of.input.matrices, of.input.modes, of.output.full),
)
