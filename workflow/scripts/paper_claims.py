"""Verdicts on the paper's claims, and their page."""

from adapter import job

from geometry.base import read_json
from workflow.paper.page import claims, html, table

job(
    snakemake,
    lambda of, tell: claims(
        read_json(of.input.numbers),
        of.params.further,
        read_json(of.input.narrow),
        read_json(of.input.wide),
    ),
    html=html,
    markdown=table,
)
