"""The sweep of a scene, of its blocks."""

from adapter import job

from workflow.jobs.sweep import of_blocks

job(
    snakemake,
    lambda of, tell: of_blocks(
        of.wildcards.scene,
        of.params.scene,
        of.input.rom,
        of.input.settings,
        of.input.start,
        of.input.blocks,
        of.params.sought,
        of.output.sweep,
        tell,
    ),
)
