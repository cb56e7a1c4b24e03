"""Largest stress of the blade away from the clamp and the contact, at the peak of a run."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fem.fields import Fields, fields
from fem.matrices import Matrices
from geometry.blade import Blade
from rom.model import Rom
from rom.reconstruct import Basis
from simulate.scene import Scene
from simulate.states import largest_state
from simulate.sweep import sweep

AT_CLAMP, AT_TIP = 2.48e-3, 3.75e-3  # m, a row of elements and a patch, on all meshes alike


def at_peak(
    scene: Scene, blade: Blade, fom: Matrices, mesh: str | Path, rom: Rom, T: NDArray
) -> dict[str, Any]:
    """March the scene, which records states, at its only speed: stresses at its largest state.

    Pa, of the nodes' means, where settled (away from clamp and tip) and anywhere.
    """
    case = scene.changed(blade=rom.provenance.blade)
    state = largest_state(sweep(case, rom))
    basis = Basis.of(fom, T, rom.provenance)
    static, u = basis.static(state.Omega), basis.reconstruct(state.u)
    found = fields(blade, mesh, basis.coordinates, static, u)
    of, settled = found.total.von_mises, _settled(found)
    place = found.points[settled][of[settled].argmax()]
    return {
        "settled_Pa": float(of[settled].max()),
        "settled_at_m": place.tolist(),
        "largest_Pa": float(of.max()),
        "u_r_m": state.u_r,
    }


def _settled(found: Fields) -> NDArray[np.bool_]:
    r = np.hypot(found.points[:, 0], found.points[:, 1])
    return (r > r.min() + AT_CLAMP) & (r < r.max() - AT_TIP)
