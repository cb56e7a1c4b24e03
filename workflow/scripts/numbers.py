"""Any study: what its module computes from the files it asks for, as JSON."""

from importlib import import_module

from adapter import stage

from geometry.files import write_json

with stage(snakemake):
    module = import_module(snakemake.params.module)
    compute = getattr(module, snakemake.params.get("function", "numbers"))
    found = compute(snakemake.input, **snakemake.params.get("given", {}))
    write_json(found, snakemake.output.json)
