"""Natural modes of a blade."""

from adapter import job

from workflow.jobs.reduced import solve

job(
    snakemake,
    lambda of, tell: solve(of.input.matrices, of.params.count, of.output.modes, tell),
)
