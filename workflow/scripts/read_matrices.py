"""M and K(Omega) from elsewhere."""

from adapter import job

from workflow.jobs.elsewhere import read

job(
    snakemake,
    lambda of, tell: read(of.params.blade, of.output.matrices),
)
