"""Any study: what its module computes from the files it asks for, as JSON; its table beside."""

from importlib import import_module

from adapter import stage

from geometry.files import whole, write_json

with stage(snakemake):
    module, output = import_module(snakemake.params.module), snakemake.output
    compute = getattr(module, snakemake.params.get("function", "numbers"))
    found = compute(snakemake.input, **snakemake.params.get("given", {}))
    write_json(found, output.json)
    if output.get("markdown"):
        with whole(output.markdown) as temporary:
            temporary.write_text(module.table(found))
