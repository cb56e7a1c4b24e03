"""What a reader may conclude of the paper's claims."""

from adapter import job

from geometry.base import read_json
from workflow.paper.conclusions import text

job(
    snakemake,
    lambda of, tell: text(
        read_json(of.input.claims), read_json(of.input.identified), read_json(of.input.long)
    ),
    markdown=str,
)
