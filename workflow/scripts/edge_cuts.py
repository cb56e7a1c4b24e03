"""Section table -> frequencies at rest with other cuts of the edges."""

from adapter import stage

from geometry.blade import Blade
from geometry.files import write_json
from geometry.settings import read_settings
from workflow.study.edge_cuts import measure

with stage(snakemake):
    blade = read_settings(Blade, snakemake.params.blade)
    write_json(measure(blade, snakemake.input.source), snakemake.output.json)
