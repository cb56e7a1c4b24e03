"""M and K(Omega) of a blade."""

from adapter import job

from workflow.jobs.full_model import assemble

job(
    snakemake,
    lambda of, tell: assemble(of.params.blade, of.input.mesh, of.output.matrices, tell),
)
