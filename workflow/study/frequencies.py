"""Frequencies of a blade over its speeds, and the deflection of its tip: a row of an experiment."""

from typing import Any

import numpy as np

from fem.matrices import Matrices
from geometry.blade import Blade
from geometry.hats import mean, over_edges
from geometry.readers import read_mesh_file
from rom.modes import ShiftInvert
from simulate.scene import LEADING

MODES = 10


def numbers(blade: Blade, mesh: str, matrices: str) -> dict[str, Any]:
    """Frequencies (3, ``MODES``), Hz, at rest, half and full speed, and deflection at full speed.

    The deflection, m, is that of the tip at 1/16 of the chord. The speeds are among those of every
    basis with three or four.

    Raises
    ------
    rom.modes.ModesError
        When the eigenvalue solver does not converge.
    """
    fom = Matrices.load(matrices)
    fom = fom.at(np.linspace(0, fom.top_speed, 3))
    omega = np.array([ShiftInvert(at.K, fom.M).modes(MODES).omega for at in fom.states()])
    at_leading = over_edges(LEADING, fom.xi, mean(fom.across))
    (tip,) = at_leading @ (fom.S @ fom.u_static[-1]).reshape(-1, 3)
    return {
        "element_size_mm": blade.mesh.element_size_mm,
        "nodes": len(read_mesh_file(mesh).points),
        "speeds_rad_s": fom.speeds.tolist(),
        "frequencies_Hz": (omega / (2 * np.pi)).tolist(),
        "tip_deflection_m": float(np.linalg.norm(tip)),
    }
