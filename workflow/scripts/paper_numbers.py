"""Sweeps and tables of one edition -> the numbers that the claims compare."""

import json
from pathlib import Path

from adapter import stage, write_json

from rom.model import Rom
from simulate.sweep import load
from workflow.paper.measure import edition

with stage(snakemake):
    files = snakemake.input
    sweeps = {part: load(files[part]) for part in snakemake.params.parts}
    grid, grown = (json.loads(Path(file).read_text()) for file in (files.grid, files.growth))
    numbers = edition(sweeps, Rom.load(files.rom), grid, grown)
    for file in files.get("more", []):
        numbers |= json.loads(Path(file).read_text())
    write_json(numbers, snakemake.output.json)
