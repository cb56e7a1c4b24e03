"""The time integration of scenes, compiled."""

from adapter import job

from workflow.jobs.march import kernels

job(
    snakemake,
    lambda of, tell: kernels(of.params.scenes),
)
