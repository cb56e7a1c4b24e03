"""A scene against its reduced model."""

from adapter import job

from simulate.sweeps.over_speeds import check_sweep
from workflow.jobs.given import given

job(
    snakemake,
    lambda of, tell: check_sweep(*given(of.params.scene, of.input.rom)[:2], tell.report),
)
