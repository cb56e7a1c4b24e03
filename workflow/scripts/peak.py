"""Fields of the whole blade, and their numbers, when the tip exceeds its gap most."""

from adapter import stage

from fem.fields import fields
from geometry.blade import Blade
from geometry.project import read_settings, write_json
from rom.reconstruct import Basis
from simulate.marching.states import largest_state
from simulate.sweeps.dataset import load, origin

with stage(snakemake):
    source = snakemake.input
    blade = read_settings(Blade, snakemake.params.blade)
    sweep, basis = load(source.sweep), Basis.load(source.basis)
    basis.provenance.require(origin(sweep), source.basis)
    state = largest_state(sweep)
    static, vibration = basis.static(state.Omega), basis.reconstruct(state.u)
    peak = fields(blade, source.mesh, basis.coordinates, static, vibration)
    # Several readers of VTK files refuse one with text in it: the status stands in the JSON file.
    numbers = {name: value for name, value in state.numbers().items() if name != "status"}
    peak.save(snakemake.output.vtu, numbers)
    names = {name: snakemake.wildcards[name] for name in ("blade", "scene")}
    write_json(names | state.numbers() | peak.numbers(), snakemake.output.numbers)
