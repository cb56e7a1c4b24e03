"""Matrices of a coarse mesh and scenes -> the default interface against all nodes of the tip."""

from adapter import stage

from fem.matrices import Matrices
from geometry.blade import Blade
from geometry.files import write_json
from geometry.settings import read_settings
from simulate.scene import Scene
from workflow.study.interface_nodes import against_nodes

with stage(snakemake):
    source, params = snakemake.input, snakemake.params
    scenes = {name: (Scene(**values), speed) for name, (values, speed) in params.scenes.items()}
    blade, fom = read_settings(Blade, params.blade), Matrices.load(source.matrices)
    write_json(against_nodes(scenes, blade, fom, source.mesh), snakemake.output.json)
