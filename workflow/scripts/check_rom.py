"""The reduced against the full model of a blade."""

from adapter import job

from workflow.jobs.check_rom import compare

job(
    snakemake,
    lambda of, tell: compare(
        of.input.rom,
        of.input.full,
        of.input.between,
        of.params.settings,
        of.params.tolerance,
        of.params.speeds,
        of.input.mesh,
        of.input.matrices,
        of.output.checked,
        tell.report,
    ),
)
