"""Take a reduced model made elsewhere, if what it shows is sound."""

from adapter import stage

from rom.foreign import UNCHECKED, check_foreign, read_foreign

with stage(snakemake):
    rom = read_foreign(snakemake.input.source, snakemake.wildcards.blade)
    rom.require_directions(snakemake.wildcards.directions)
    print(*check_foreign(rom).shown, "not checked:", *UNCHECKED, sep="\n")
    rom.save(snakemake.output.rom)
