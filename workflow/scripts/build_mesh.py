"""The mesh of a blade."""

from adapter import job

from workflow.jobs.mesh import build

job(
    snakemake,
    lambda of, tell: build(of.params.blade, of.input.source, of.output.mesh, tell.report),
)
