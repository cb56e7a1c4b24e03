"""Component modes of a blade, and the full model at their speeds."""

from adapter import job

from workflow.jobs.full_model import solve_modes

job(
    snakemake,
    lambda of, tell: solve_modes(
        of.params.blade,
        of.input.matrices,
        of.input.mesh,
        of.params.natural,
        of.output.modes,
        of.output.full,
        tell,
    ),
)
