"""The study's scenes -> their fronts, and the settings to take."""

from adapter import stage

from geometry.files import read_json, write_json
from workflow.study.trade_levels import merge

with stage(snakemake):
    files = zip(snakemake.params.names, snakemake.input.scenes, strict=True)
    parts = {name: read_json(file) for name, file in files}
    write_json(merge(parts), snakemake.output.json)
