"""Quantiles of the rows of a design over its seeds as CSV."""

from adapter import job

from workflow.figures.designs import quantiles
from workflow.many.design_tables import load

job(
    snakemake,
    lambda of, tell: quantiles(load(of.input.rows)),
    csv=str,
)
