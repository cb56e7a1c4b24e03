"""Worst coatings, and the bare casing."""

from adapter import job

from geometry.base import read_json
from workflow.many.table import whole
from workflow.paper.numbers import worst_runs

job(
    snakemake,
    lambda of, tell: worst_runs(whole(of.input.table), read_json(of.input.growth)),
)
