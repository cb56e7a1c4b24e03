"""Numbers, and those of repeats, causes and the other blade that are there -> the verdicts."""

import json
from pathlib import Path

from adapter import stage, write_json

from geometry.files import whole
from workflow.paper.claims import CLAIMS
from workflow.paper.report import markdown, table


def read(files: dict[str, str]) -> dict[str, dict]:
    """Numbers of each file, by the same names."""
    return {name: json.loads(Path(file).read_text()) for name, file in files.items()}


with stage(snakemake):
    numbers = json.loads(Path(snakemake.input.numbers).read_text())
    found = table(
        CLAIMS, numbers, *(read(snakemake.params[x]) for x in ("repeats", "other", "causes"))
    )
    write_json(found, snakemake.output.json)
    with whole(snakemake.output.markdown) as temporary:
        temporary.write_text(markdown(found, read(snakemake.params.mapped).get("map")))
