"""Scenes, matrices and reduced models -> what changes without each feature."""

from adapter import stage, write_json

from fem.matrices import Matrices
from simulate.scene import Scene
from workflow.study.trade import rom_of
from workflow.study.trade_features import features

with stage(snakemake):
    fom = Matrices.load(snakemake.input.matrices)
    rows = [
        row
        for name, values in snakemake.params.scenes.items()
        for row in features(name, Scene(**values), rom_of, fom)
    ]
    write_json({"features": rows}, snakemake.output.json)
