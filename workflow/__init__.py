"""Snakemake workflow: rules, the studies and figures they ask for, and the paper's claims."""
