"""Mesh a blade."""

from adapter import stage

from geometry.blade import Blade
from geometry.mesh import build_mesh
from geometry.settings import read_settings

with stage(snakemake):
    blade = read_settings(Blade, snakemake.params.blade)
    source = snakemake.input.get("source")
    print(build_mesh(blade, snakemake.output.mesh, source))
