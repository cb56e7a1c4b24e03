"""The summary of the scenes to deliver."""

from adapter import job

from workflow.summary import csv, margins_csv, numbers, table

job(
    snakemake,
    lambda of, tell: numbers(of.input, of.params.operating, of.params.others),
    csv=csv,
    margins=margins_csv,
    markdown=table,
)
