"""Run the function of a study's module on its files; write JSON, a table, a page, a design."""

from importlib import import_module

from adapter import stage

from geometry.project import whole, write_json

with stage(snakemake):
    module, output = import_module(snakemake.params.module), snakemake.output
    compute = getattr(module, snakemake.params.get("function", "numbers"))
    result = compute(snakemake.input, **snakemake.params.get("given", {}))
    if output.get("json"):
        write_json(result, output.json)
    for text in filter(None, (output.get("markdown"), output.get("html"))):
        with whole(text) as temporary:
            temporary.write_text(module.table(result) if output.get("json") else result)
    if output.get("csv"):
        with whole(output.csv) as temporary:
            temporary.write_text(module.csv(result))
