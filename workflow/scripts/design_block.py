"""A block of the rows of a design."""

from adapter import job

from workflow.jobs.many import design

job(
    snakemake,
    lambda of, tell: design(
        of.params.scene,
        of.input.rom,
        of.input.settings,
        of.params.file,
        of.params.folder,
        int(of.wildcards.block),
        of.params.blocks,
        tell,
        tell.report,
    ),
)
