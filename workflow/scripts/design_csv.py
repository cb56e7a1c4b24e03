"""The rows of a design as CSV."""

from adapter import job

from workflow.figures.designs import csv
from workflow.many.design_tables import load

job(
    snakemake,
    lambda of, tell: csv(load(of.input.rows)),
    csv=str,
)
