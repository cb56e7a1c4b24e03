"""What a mesh errs by at rest: frequencies and compliances of the tip beside a coarser mesh's."""

from math import sqrt
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from fem.assemble import assemble
from geometry.blade import Blade
from geometry.hats import hats, middles
from geometry.mesh import build_mesh
from rom.full_model import FullModel, solve

COARSER = sqrt(2)  # its element size
ORDER = 1.7  # of the compliance of patches, the slower of the two; frequencies have 3 to 4


def mesh_error(blade: Blade, full: FullModel, source: str | None = None) -> dict[str, Any]:
    """Relative error of the mesh of ``full``, the larger of frequencies' and compliances'.

    Both go with the element size to the power ``ORDER`` at least, so the difference from a mesh
    coarser by ``COARSER`` tells them (Roache 1994). ``source`` is the blade's file of geometry.
    """
    other = _coarser(blade, source)
    times = COARSER**ORDER - 1
    frequencies = np.abs(other.omega[0] / full.omega[0] - 1).max() / times
    compliance = np.abs(_of_strips(other) / _of_strips(full) - 1).max() / times
    return {
        "mesh": full.provenance.mesh,
        "error": float(max(frequencies, compliance)),
        "frequencies": float(frequencies),
        "compliance": float(compliance),
        "element_size_mm": blade.mesh.element_size_mm,
        "coarser_mm": COARSER * blade.mesh.element_size_mm,
    }


def _coarser(blade: Blade, source: str | None) -> FullModel:
    size = COARSER * blade.mesh.element_size_mm
    with TemporaryDirectory() as folder:
        path = Path(folder, "blade.msh")
        build_mesh(blade.changed(mesh__element_size_mm=size), path, source)
        return solve(assemble(blade, "coarser", path, [0.0]))


def _of_strips(full: FullModel) -> np.ndarray:
    """Radial compliance at rest, m/N, amid as many strips as there are patches."""
    C = full.compliance[0][::3, ::3]
    n = len(C)
    P = hats(middles(n), np.linspace(0, 1, n))
    return np.diag(P @ C @ P.T)
