"""What a mesh errs by at rest: frequencies and compliances of the tip beside a coarser mesh's."""

from math import sqrt
from pathlib import Path
from typing import Any

import numpy as np

from geometry.blade import Blade
from geometry.settings import read_settings
from rom.compliance import of_strips
from rom.full_model import FullModel, solve
from workflow.study.variants import remeshed

COARSER = sqrt(2)  # its element size
ORDER = 1.7  # of the compliance of patches, the slower of the two; frequencies have 3 to 4


def numbers(files: Any, blade: str) -> dict[str, Any]:
    """``mesh_error`` of ``files.full``; the YAML file ``blade`` may name ``files.source``."""
    source = getattr(files, "source", None)
    return mesh_error(read_settings(Blade, blade), FullModel.load(files.full), source)


def mesh_error(blade: Blade, full: FullModel, source: str | Path | None = None) -> dict[str, Any]:
    """Relative error of the mesh of ``full``, the larger of frequencies' and compliances'.

    Both go with the element size to the power ``ORDER`` at least, so the difference from a mesh
    coarser by ``COARSER`` tells them (Roache 1994). ``source`` is the blade's file of geometry.
    """
    size = COARSER * blade.mesh.element_size_mm
    fom, _ = remeshed(blade.changed(mesh__element_size_mm=size), source)
    other, times = solve(fom), COARSER**ORDER - 1
    frequencies = np.abs(other.omega[0] / full.omega[0] - 1).max() / times
    compliance = np.abs(_radial(other) / _radial(full) - 1).max() / times
    return {
        "mesh": full.provenance.mesh,
        "error": float(max(frequencies, compliance)),
        "frequencies": float(frequencies),
        "compliance": float(compliance),
        "element_size_mm": blade.mesh.element_size_mm,
        "coarser_mm": size,
    }


def _radial(full: FullModel) -> np.ndarray:
    """Radial compliance at rest, m/N, amid as many strips as there are patches."""
    return of_strips(full.compliance[0][::3, ::3])
