"""Worst coatings over 200 revolutions."""

from adapter import job

from workflow.many.table import whole
from workflow.paper.numbers import growth_of

job(
    snakemake,
    lambda of, tell: growth_of(whole(of.input.table)),
)
