"""The study of interfaces as a page."""

from adapter import job

from workflow.many.table import whole
from workflow.study.interface import table

job(
    snakemake,
    lambda of, tell: table(whole(of.input.changes), whole(of.input.models)),
    markdown=str,
)
