"""Benchmark files -> what the targets cost."""

from pathlib import Path

from adapter import stage

from geometry.files import whole
from workflow.paper.cost import cost

with stage(snakemake):
    targets = {
        target: sorted(file for folder in folders for file in Path(folder).glob("benchmarks/*.tsv"))
        for target, folders in snakemake.params.targets.items()
    }
    with whole(snakemake.output.markdown) as temporary:
        temporary.write_text(cost(targets))
