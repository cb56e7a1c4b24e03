"""Long times, beyond the paper."""

from adapter import job

from simulate.sweeps.dataset import load
from workflow.paper.long import numbers

job(
    snakemake,
    lambda of, tell: numbers(
        [*map(load, of.input.long)],
        *map(load, (of.input.rest, of.input.run_up, of.input.run_down, of.input.on_worn)),
    ),
)
