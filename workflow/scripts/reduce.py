"""The reduced model of a blade, and its basis."""

from adapter import job

from workflow.jobs.reduced import make

job(
    snakemake,
    lambda of, tell: make(
        of.params.blade,
        of.input.matrices,
        of.input.modes,
        of.wildcards.directions,
        of.output.rom,
        of.output.basis,
        tell,
    ),
)
