"""Results on every mesh of the study -> limits and errors."""

from adapter import stage

from workflow.study.mesh_convergence import summarise
from workflow.study.mesh_level import Level, write_json

with stage(snakemake):
    levels = [Level.load(path) for path in snakemake.input.levels]
    write_json(summarise(levels), snakemake.output.json)
