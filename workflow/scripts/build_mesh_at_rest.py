"""The mesh at rest of a blade whose geometry is given as it runs."""

from adapter import job

from workflow.jobs.mesh_at_rest import build

job(
    snakemake,
    lambda of, tell: build(of.params.blade, of.input.source, of.output.mesh, tell.report),
)
