"""Error of the mesh of a blade."""

from adapter import job

from workflow.study.mesh_error import numbers

job(
    snakemake,
    lambda of, tell: numbers(of.params.blade, of.input.full, of.input.source),
)
