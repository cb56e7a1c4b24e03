"""What the strain gauges of a scene read."""

from adapter import job

from workflow.jobs.gauges import place

job(
    snakemake,
    lambda of, tell: place(
        of.params.settings,
        of.input.mesh,
        of.input.basis,
        of.input.rom,
        of.params.record,
        of.output.model,
    ),
)
