"""A scene against its reduced model."""

from adapter import job

from geometry.base import check_settings
from rom.model import Rom
from simulate.scene import Scene
from simulate.sweeps.over_speeds import check_sweep

job(
    snakemake,
    lambda of, tell: check_sweep(
        check_settings(Scene, of.params.scene, ""), Rom.load(of.input.rom), tell.report
    ),
)
