"""Any table: what its module tells of the files it asks for, as Markdown."""

from importlib import import_module

from adapter import stage

from geometry.files import whole

with stage(snakemake):
    write = getattr(import_module(snakemake.params.module), snakemake.params.function)
    text = write(snakemake.input, **snakemake.params.get("given", {}))
    with whole(snakemake.output.markdown) as temporary:
        temporary.write_text(text)
