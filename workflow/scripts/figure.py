"""Any figure."""

from adapter import job

from workflow.jobs.figure import draw

job(
    snakemake,
    lambda of, tell: draw(
        of.params.module, of.input, of.output.png, of.output.pdf, of.params.given
    ),
)
