"""The full model between the speeds of the basis."""

from adapter import job

from workflow.jobs.full_model import solve

job(
    snakemake,
    lambda of, tell: solve(
        of.params.blade,
        of.input.mesh,
        of.input.matrices,
        of.params.speeds,
        of.output.full,
        tell,
    ),
)
