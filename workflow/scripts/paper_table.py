"""Rows -> the table."""

from importlib import import_module

from adapter import stage

from geometry.files import read_json, write_json

with stage(snakemake):
    name = snakemake.params.table
    rows = [read_json(file) for file in snakemake.input.rows]
    write_json(getattr(import_module(f"workflow.paper.{name}"), name)(rows), snakemake.output.json)
