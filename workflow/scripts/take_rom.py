"""A reduced model from elsewhere."""

from adapter import job

from workflow.jobs.elsewhere import take

job(
    snakemake,
    lambda of, tell: take(of.params.blade, of.input.source, of.wildcards.directions, of.output.rom),
)
