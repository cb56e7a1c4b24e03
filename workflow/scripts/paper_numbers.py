"""Sweeps and tables of one edition -> the numbers that the claims compare."""

from adapter import stage

from geometry.files import read_json, write_json
from rom.model import Rom
from simulate.dataset import load
from workflow.paper.measure import edition

with stage(snakemake):
    files = snakemake.input
    sweeps = {part: load(files[part]) for part in snakemake.params.parts}
    grid, grown = (read_json(file) for file in (files.grid, files.growth))
    numbers = edition(sweeps, Rom.load(files.rom), grid, grown)
    for file in files.get("more", []):
        numbers |= read_json(file)
    write_json(numbers, snakemake.output.json)
