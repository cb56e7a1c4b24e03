"""Densities, steps, laws, cost of the density, stress."""

from adapter import job

from geometry.base import check_settings, read_json
from rom.model import Rom
from simulate.scene import Scene
from simulate.sweeps.dataset import load
from workflow.paper.numbers import settled

job(
    snakemake,
    lambda of, tell: settled(
        Rom.load(of.input.rom),
        [*map(load, of.input.densities)],
        [*map(load, of.input.steps)],
        read_json(of.input.stress),
        check_settings(Scene, of.params.scene, ""),
    ),
)
