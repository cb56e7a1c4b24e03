"""The script of all rules. Jobs rerun when it changes: what may change is in ``adapter``."""

from adapter import run

run(snakemake)
