"""The figures' numbers, as JSON and as Markdown."""

from adapter import stage

from workflow.figures.summary import load, summarise, write

with stage(snakemake):
    numbers = summarise(*load(snakemake.input, snakemake.params.scenes))
    write(numbers, snakemake.output.json, snakemake.output.markdown)
