"""Answers at the peaks of a sweep, with their uncertainty."""

from adapter import stage

from geometry.project import write_json
from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.sweeps.dataset import load, require_rom
from simulate.sweeps.peak_results import Doubt, of_sweep, results

with stage(snakemake) as tell:
    source = snakemake.input
    runs, rom = load(source.sweep), Rom.load(source.rom)
    require_rom(runs, rom)
    choice = Choice.load(source.settings) if source.settings else None
    start = load(source.start) if source.start else None
    doubt = Doubt.of(source.check, source.mesh_error, rom)
    found = results(runs, rom, doubt, choice, start, tell)
    write_json(of_sweep(runs, doubt, found), snakemake.output.answers)
