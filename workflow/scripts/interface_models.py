"""Matrices of a mesh -> its interface's numbers, and reduced models."""

from pathlib import Path

from adapter import stage

from fem.matrices import Matrices
from geometry.blade import Blade
from geometry.files import write_json
from geometry.settings import read_settings
from simulate.scene import Scene
from workflow.study.interface_models import on_mesh

with stage(snakemake):
    source, params = snakemake.input, snakemake.params
    blade, fom = read_settings(Blade, params.blade), Matrices.load(source.matrices)
    folder = Path(snakemake.output.json).with_suffix("")
    folder.mkdir(exist_ok=True)
    rows = on_mesh(blade, fom, source.mesh, Scene(**params.scene), folder)
    write_json(rows, snakemake.output.json)
