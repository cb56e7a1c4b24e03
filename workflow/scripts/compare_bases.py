"""Full matrices -> what each reduction basis costs in accuracy."""

import json

from adapter import stage

from fem.matrices import Matrices
from geometry.files import whole
from rom.full_model import FullModel
from workflow.study.bases import compare

with stage(snakemake):
    fom, full = Matrices.load(snakemake.input.matrices), FullModel.load(snakemake.input.full)
    with whole(snakemake.output.json) as temporary:
        temporary.write_text(json.dumps(compare(fom, full), indent=1))
