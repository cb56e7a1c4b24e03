"""Full matrices -> what each reduction basis costs in accuracy."""

from adapter import stage

from fem.matrices import Matrices
from geometry.files import write_json
from rom.full_model import FullModel
from workflow.study.bases import ON_PATCHES, ON_POINTS, compare

with stage(snakemake):
    files, rows = snakemake.input, []
    if files.of_paper:  # the blade as the paper reduces its own
        matrices, full = files.of_paper
        rows += compare(Matrices.load(matrices), FullModel.load(full), ON_POINTS)
    rows += compare(Matrices.load(files.matrices), FullModel.load(files.full), ON_PATCHES)
    write_json(rows, snakemake.output.json)
