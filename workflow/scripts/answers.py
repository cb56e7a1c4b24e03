"""Answers at the peaks of a scene."""

from adapter import job

from workflow.jobs.answers import find

job(
    snakemake,
    lambda of, tell: find(
        of.input.sweep,
        of.input.rom,
        of.input.check,
        of.input.mesh_error,
        of.input.start,
        of.input.stress,
        tell,
    ),
)
