"""Mesh a blade."""

from adapter import stage

from geometry.blade import Blade
from geometry.description import ENOUGH, describe
from geometry.mesh import build_mesh
from geometry.project import WARNING, read_settings

with stage(snakemake) as tell:
    blade = read_settings(Blade, snakemake.params.blade)
    source = snakemake.input.get("source")
    summary = build_mesh(blade, snakemake.output.mesh, source)
    described = describe(blade, snakemake.output.mesh, summary.volume)
    tell.now(("" if described.through >= ENOUGH else WARNING) + described.line())
