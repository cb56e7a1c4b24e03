"""The strain gauges of a scene as CSV."""

from adapter import job

from simulate.sweeps.dataset import load
from workflow.figures.spectra import gauges_csv

job(
    snakemake,
    lambda of, tell: gauges_csv(load(of.input.sweep)),
    csv=str,
)
