"""Blade settings -> frequencies and tip deflection on one mesh of the study."""

from adapter import stage

from geometry.blade import Blade
from geometry.settings import read_settings
from workflow.study.mesh_measure import measure

with stage(snakemake):
    blade = read_settings(Blade, snakemake.params.blade)
    level = measure(blade, snakemake.params.factor, snakemake.input.get("source"))
    level.save(snakemake.output.level)
