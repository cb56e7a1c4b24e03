"""Modes and compliance of the full model of a blade."""

from adapter import job

from workflow.jobs.full_model import solve

job(
    snakemake,
    lambda of, tell: solve(
        of.params.blade,
        of.input.mesh,
        of.input.modes,
        of.params.speeds,
        of.output.full,
        tell,
    ),
)
