"""The page to explore a scene."""

from adapter import job

from workflow.jobs.explore import write

job(
    snakemake,
    lambda of, tell: write(
        of.params.blade,
        of.wildcards.scene,
        of.input.mesh,
        of.input.rom,
        of.input.basis,
        of.input.sweep,
        of.input.answers,
        of.input.stress,
        of.params.operating,
        of.output.html,
    ),
)
