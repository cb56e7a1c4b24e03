"""One element size of the mesh study: the blade meshed, assembled and solved."""

from typing import Any

import numpy as np

from geometry.blade import Blade
from geometry.hats import hats
from simulate.scene import LEADING
from workflow.study.variants import frequencies, remeshed

MODES = 10


def numbers(files: Any, blade: str, factor: float) -> dict[str, Any]:
    """Size, nodes, frequencies (``MODES``) at rest and at Omega_m, and deflection of the tip there.

    Elements are ``factor`` times as large as those of the blade in the YAML file ``blade``; the
    deflection, m, is at 1/16 of the chord. ``files`` and errors raised are those of
    ``variants.remeshed``.
    """
    own = Blade.load(blade)
    size = factor * own.mesh.element_size_mm
    resized = own.but(mesh__element_size_mm=size)
    fom, mesh = remeshed(resized, files, [0.0, own.max_speed_rad_s])
    at_rest, at_speed = (frequencies(fom, MODES) / (2 * np.pi)).tolist()
    of_patches = (fom.S @ fom.u_static[-1]).reshape(-1, 3)
    (tip,) = hats(LEADING, fom.xi) @ of_patches
    return {
        "element_size_mm": size,
        "nodes": mesh.nodes,
        "at_rest_Hz": at_rest,
        "at_Omega_m_Hz": at_speed,
        "tip_deflection_m": float(np.linalg.norm(tip)),
    }
