"""What the cut of thin edges changes: a blade from a section table, cut less and more."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from fem.assemble import assemble
from geometry.blade import Blade
from geometry.mesh import build_mesh
from rom.modes import ShiftInvert

FACTORS = (2 / 3, 1.0, 5 / 3)  # of the blade's own cut
MODES = 8


def measure(blade: Blade, source: str | Path) -> dict[str, Any]:
    """Frequencies at rest (cuts, ``MODES``), Hz, over the cuts, % of chord."""
    own = blade.section_table.edge_cut_percent
    cuts = [round(factor * own, 6) for factor in FACTORS]
    return {
        "own_percent": own,
        "cut_percent": cuts,
        "at_rest_Hz": [_at_rest(blade, cut, source) for cut in cuts],
    }


def _at_rest(blade: Blade, cut: float, source: str | Path) -> list[float]:
    other = blade.changed(section_table__edge_cut_percent=cut)
    with TemporaryDirectory() as folder:
        mesh = Path(folder, "blade.msh")
        build_mesh(other, mesh, source)
        fom = assemble(other, f"cut at {cut:g} %", mesh, [0.0])
    return (ShiftInvert(fom.K[0], fom.M).modes(MODES).omega / (2 * np.pi)).tolist()
