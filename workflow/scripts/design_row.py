"""A row of a design as a sweep."""

from adapter import job

from workflow.jobs.many import row

job(
    snakemake,
    lambda of, tell: row(
        of.wildcards.scene,
        of.params.scene,
        of.input.rom,
        of.input.settings,
        of.params.file,
        int(of.wildcards.row),
        of.output.sweep,
        tell,
    ),
)
