"""Reduced models of all meshes, and scenes -> the study of the interface, and its tables."""

import json
from pathlib import Path

from adapter import stage, write_json

from geometry.files import whole
from rom.check import RomCheck
from simulate.scene import Scene
from workflow.study.interface import between_meshes, compare, stresses
from workflow.study.interface_table import tables

with stage(snakemake):
    source = snakemake.input
    models = [row for path in source.models for row in json.loads(Path(path).read_text())]
    folder = Path(source.models[0]).parent
    changes = [
        row
        for name, values in snakemake.params.scenes.items()
        for row in compare(name, Scene(**values), folder)
    ]
    checks = {Path(path).parent.name: RomCheck.load(path) for path in source.checks}
    study = {
        "models": models,
        "frequencies": {blade: float(abs(c.error).max()) for blade, c in checks.items()},
        "between_meshes": between_meshes(models),
        "changes": changes,
        "stress": stresses(models),
        "all_nodes": json.loads(Path(source.all_nodes).read_text()),
    }
    write_json(study, snakemake.output.json)
    with whole(snakemake.output.table) as temporary:
        temporary.write_text(tables(study))
