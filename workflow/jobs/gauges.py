"""The reduced model of a scene with strain gauges: M and K, and what the gauges read."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from fem.fields import gauge_rows
from geometry.base import check_settings
from geometry.blade import Blade
from rom.model import Rom
from rom.polynomial import interpolate
from rom.reconstruct import Basis
from simulate.scene import Record


def place(
    blade: str, mesh: str, basis: str, rom: str, record: Mapping[str, Any], model: str
) -> None:
    """Add the grids of a ``record`` to a reduced model, at the speeds of its ``basis``."""
    plain = Rom.load(rom)
    full_basis = Basis.load(basis, plain.provenance)
    statics = (full_basis.static(Omega) for Omega in plain.speeds)
    grids = check_settings(Record, dict(record), "").grids
    by_speed = gauge_rows(
        Blade.load(blade), mesh, full_basis.coordinates, grids.values(), statics, full_basis.T
    )
    rows = interpolate(by_speed, plain.speeds)
    replace(plain, gauges=tuple(grids), gauge_rows=rows).save(model)
