"""Component modes of a blade."""

from adapter import job

from workflow.jobs.reduced import solve

job(
    snakemake,
    lambda of, tell: solve(of.input.matrices, of.params.natural, of.output.modes, tell),
)
