"""Draw a figure: load the inputs of its module, draw, and save as PNG and PDF."""

from importlib import import_module

from adapter import stage

from workflow.figures.origins import origins
from workflow.figures.style import save

with stage(snakemake):
    module = import_module(snakemake.params.module)
    loaded = module.load(snakemake.input, **snakemake.params.get("given", {}))
    paths = snakemake.output.png, snakemake.output.pdf
    save(module.draw(*loaded), *paths, origin=origins(snakemake.input))
