"""Reduced models of all meshes, and scenes -> the study of the interface, and its tables."""

from pathlib import Path

from adapter import stage

from geometry.files import read_json, whole, write_json
from rom.check import RomCheck
from simulate.scene import Scene
from workflow.study.interface import between_meshes, compare, stresses
from workflow.study.interface_table import tables

with stage(snakemake):
    source = snakemake.input
    models = [row for path in source.models for row in read_json(path)]
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
        "all_nodes": read_json(source.all_nodes),
    }
    write_json(study, snakemake.output.json)
    with whole(snakemake.output.table) as temporary:
        temporary.write_text(tables(study))
