"""Scenes, matrices and reduced models -> what changes without each feature."""

from functools import cache

from adapter import stage

from fem.matrices import Matrices
from geometry.files import write_json
from simulate.scene import Scene
from workflow.study.trade import rom_of
from workflow.study.trade_features import features, not_softened

with stage(snakemake):
    fom = Matrices.load(snakemake.input.matrices)
    unsoftened = cache(lambda directions: not_softened(fom, directions))
    rows = [
        row
        for name, values in snakemake.params.scenes.items()
        for row in features(name, Scene(**values), rom_of, unsoftened)
    ]
    write_json({"features": rows}, snakemake.output.json)
