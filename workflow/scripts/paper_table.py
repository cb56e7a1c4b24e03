"""Rows -> the table."""

import json
from importlib import import_module
from pathlib import Path

from adapter import stage, write_json

with stage(snakemake):
    name = snakemake.params.table
    rows = [json.loads(Path(file).read_text()) for file in snakemake.input.rows]
    write_json(getattr(import_module(f"workflow.paper.{name}"), name)(rows), snakemake.output.json)
