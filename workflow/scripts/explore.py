"""The page to explore a sweep."""

from adapter import stage

from geometry.blade import Blade
from geometry.project import read_json, read_settings, whole, write_json
from rom.reconstruct import Basis
from simulate.sweeps.dataset import origin
from workflow.explore.blade import moving
from workflow.explore.page import html
from workflow.explore.results import arrays, facts
from workflow.figures.response import Response
from workflow.summary import panel

with stage(snakemake):
    source, names = snakemake.input, snakemake.wildcards
    blade = read_settings(Blade, snakemake.params.blade)
    response, basis = Response.read(source.sweep, source.rom), Basis.load(source.basis)
    basis.provenance.require(origin(response.sweep), source.basis)
    motion, of_blade, stress = None, {}, []
    if "motion" in response.sweep:
        motion, of_blade = moving(blade, source.mesh, basis, response.sweep, response.rom)
        stress = motion.pop("stress")
    of = {"scene": names.scene, "speed_over_f1": response.speeds.tolist(), "largest_Pa": stress}
    told = panel(read_json(source.answers), snakemake.params.operating, of)
    shown = facts(response, names.blade, names.scene) | {"motion": motion, "answers": told}
    with whole(snakemake.output.html) as temporary:
        temporary.write_text(html(shown, arrays(response) | of_blade))
    write_json(of, snakemake.output.stress)
