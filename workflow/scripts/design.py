"""The tables of a design."""

from adapter import job

from workflow.jobs.many import tables

job(
    snakemake,
    lambda of, tell: tables(
        of.params.scene,
        of.input.rom,
        of.input.settings,
        of.params.file,
        of.params.folder,
        of.input.blocks,
        of.output.runs,
        of.output.rows,
    ),
)
