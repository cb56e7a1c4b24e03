"""The blade reduced as the paper does, to the letter, and as we do: sizes and errors of both."""

from adapter import stage

from geometry.files import write_json
from rom.check import RomCheck
from rom.model import Rom
from workflow.paper.measure import model

with stage(snakemake):
    files = snakemake.input
    ours = Rom.load(files.rom), RomCheck.load(files.check)
    paper = Rom.load(files.paper), RomCheck.load(files.paper_check)
    write_json({"model": model(*ours, *paper)}, snakemake.output.json)
