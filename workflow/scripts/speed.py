"""Scenes and matrices -> what accuracy costs in time, on their reduced model and the paper's."""

import json

from adapter import stage

from fem.matrices import Matrices
from geometry.blade import PaperBasis
from geometry.files import whole
from rom.model import Rom
from rom.reduce import reduce
from rom.speeds import basis_speeds
from simulate.scene import Scene
from workflow.study.speed import SPEEDS, work_precision

with stage(snakemake):
    fom, basis = Matrices.load(snakemake.input.matrices), PaperBasis(kind="paper")
    paper, _ = reduce(fom.at(basis_speeds(basis, float(fom.speeds[-1]))), basis)
    models = {"default": Rom.load(snakemake.input.rom), "paper": paper}
    study = {
        model: {
            name: work_precision(Scene(**snakemake.params.scenes[name]), rom, speed)
            for name, speed in SPEEDS.items()
        }
        for model, rom in models.items()
    }
    with whole(snakemake.output.json) as temporary:
        temporary.write_text(json.dumps(study, indent=1))
