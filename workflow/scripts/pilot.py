"""Step, density and strips for the accuracy of a scene."""

from adapter import job

from workflow.jobs.march import pilot

job(
    snakemake,
    lambda of, tell: pilot(
        of.params.scene, of.input.rom, of.input.check, of.input.mesh_error, tell.report
    ),
)
