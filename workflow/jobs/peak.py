"""Fields of the whole blade when the tip exceeds its gap most."""

from typing import Any

from fem.fields import fields
from geometry.blade import Blade
from rom.reconstruct import Basis
from simulate.marching import largest_state
from simulate.sweeps.dataset import Sweep, origin


def write(
    blade: Blade, mesh: str, basis: str, sweep: Sweep, names: dict[str, str], vtu: str
) -> dict[str, Any]:
    """Write the fields, and return their numbers."""
    of = Basis.load(basis)
    of.provenance.require(origin(sweep), basis)
    state, u = largest_state(sweep)
    static, vibration = of.static(state["speed_rad_s"]), of.reconstruct(u)
    peak = fields(blade, mesh, of.coordinates, static, vibration)
    # Several readers of VTK files refuse one with text in it: the status stands in the JSON file.
    numbers = {name: value for name, value in state.items() if name != "status"}
    peak.save(vtu, numbers)
    return {**names, **state, **peak.numbers()}
