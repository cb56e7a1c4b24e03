"""Stresses of a scene."""

from adapter import job

from geometry.blade import Blade
from rom.model import Rom
from simulate.sweeps.dataset import load
from workflow.stress import write

job(
    snakemake,
    lambda of, tell: write(
        Blade.load(of.params.blade),
        of.input.mesh,
        Rom.load(of.input.rom),
        of.input.basis,
        load(of.input.sweep),
        dict(of.wildcards.items()),
        of.output.vtu,
    ),
)
