"""The table of an experiment."""

from adapter import job

from geometry.base import read_json
from workflow.many.table import csv, rows, table

job(
    snakemake,
    lambda of, tell: rows([*map(read_json, of.input.blocks)], of.params.folder),
    csv=csv,
    markdown=table,
)
