"""Blade settings and full model -> what the mesh errs by."""

from adapter import stage

from geometry.blade import Blade
from geometry.files import write_json
from geometry.settings import read_settings
from rom.full_model import FullModel
from workflow.study.mesh_error import mesh_error

with stage(snakemake):
    blade = read_settings(Blade, snakemake.params.blade)
    full, source = FullModel.load(snakemake.input.full), snakemake.input.get("source")
    write_json(mesh_error(blade, full, source), snakemake.output.error)
