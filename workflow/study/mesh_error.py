"""What a mesh errs by at rest: frequencies and compliances of the tip beside a coarser mesh's."""

from math import sqrt
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
    """Relative error of the blade's mesh, the larger of frequencies' and compliances'.

    Both go with the element size to the power ``ORDER`` at least, so the difference from a mesh
    coarser by ``COARSER`` tells them (Roache 1994). ``blade`` is its YAML file, ``files.full`` its
    full model; errors raised: ``variants.remeshed``.
    """
    own, full = read_settings(Blade, blade), FullModel.load(files.full)
    size = COARSER * own.mesh.element_size_mm
    fom, _ = remeshed(own.but(mesh__element_size_mm=size), files)
    other, times = solve(fom), COARSER**ORDER - 1
    frequencies = np.abs(other.omega[0] / full.omega[0] - 1).max() / times
    compliance = np.abs(_radial(other) / _radial(full) - 1).max() / times
    return {
        "mesh": full.provenance.mesh,
        "error": float(max(frequencies, compliance)),
        "frequencies": float(frequencies),
        "compliance": float(compliance),
        "element_size_mm": own.mesh.element_size_mm,
        "coarser_mm": size,
    }


def _radial(full: FullModel) -> np.ndarray:
    """Radial compliance at rest, m/N, amid as many strips as there are patches."""
    return of_strips(full.compliance[0][::3, ::3])
