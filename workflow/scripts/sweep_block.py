"""A block of the speeds of a scene."""

from adapter import job

from workflow.jobs.march import block

job(
    snakemake,
    lambda of, tell: block(
        of.params.scene,
        of.input.rom,
        of.input.settings,
        of.input.start,
        int(of.wildcards.block),
        of.params.blocks,
        of.output.runs,
        tell,
    ),
)
