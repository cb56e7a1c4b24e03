"""Results on every mesh of the study -> limits and errors."""

from adapter import stage

from geometry.files import write_json
from workflow.study.mesh_convergence import summarise
from workflow.study.mesh_level import Level

with stage(snakemake):
    levels = [Level.load(path) for path in snakemake.input.levels]
    write_json(summarise(levels), snakemake.output.json)
