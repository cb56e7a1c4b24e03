"""The reduced model of a scene with strain gauges: M and K, and what the gauges read."""

from dataclasses import replace

from fem.fields import gauge_rows
from geometry.blade import Blade
from rom.model import Rom
from rom.polynomial import interpolate
from rom.reconstruct import Basis
from simulate.scene import Record


def place(settings: Blade, mesh: str, basis: str, rom: Rom, record: Record, model: str) -> None:
    """Add the grids of a ``record`` to a reduced model, at the speeds of its ``basis``.

    ``settings``: of its blade.
    """
    full_basis = Basis.load(basis, rom.provenance)
    statics, grids = (full_basis.static(Omega) for Omega in rom.speeds), record.grids
    by_speed = gauge_rows(
        settings, mesh, full_basis.coordinates, grids.values(), statics, full_basis.T
    )
    replace(rom, gauges=tuple(grids), gauge_rows=interpolate(by_speed, rom.speeds)).save(model)
