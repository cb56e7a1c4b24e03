"""The animation of a scene at one speed."""

from adapter import job

from workflow.jobs.rub import animate

job(
    snakemake,
    lambda of, tell: animate(
        of.params.scene,
        of.input.rom,
        of.input.settings,
        of.input.start,
        float(of.wildcards.speed),
        f"scene {of.wildcards.scene}, blade {of.wildcards.blade}",
        of.output.animation,
    ),
)
