"""The study's scenes -> their fronts, and the settings to take."""

import json
from pathlib import Path

from adapter import stage, write_json

from workflow.study.trade_levels import merge

with stage(snakemake):
    files = zip(snakemake.params.names, snakemake.input.scenes, strict=True)
    parts = {name: json.loads(Path(file).read_text()) for name, file in files}
    write_json(merge(parts), snakemake.output.json)
