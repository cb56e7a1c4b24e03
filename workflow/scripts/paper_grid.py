"""The table of E and K."""

from adapter import job

from geometry.base import read_json
from workflow.paper.grid import of_rows

job(
    snakemake,
    lambda of, tell: of_rows(read_json(of.input.rows)),
)
