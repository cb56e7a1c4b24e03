"""Blocks -> one sweep, speeds ascending."""

from adapter import stage

from simulate.sweep import load, merge, save

with stage(snakemake):
    save(merge([load(path) for path in snakemake.input.blocks]), snakemake.output.sweep)
