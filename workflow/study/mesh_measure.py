"""One size of the mesh study: the blade meshed, assembled and solved there."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from fem.assemble import assemble
from geometry.blade import Blade
from geometry.hats import hats
from geometry.mesh import build_mesh
from rom.modes import ShiftInvert
from simulate.scene import LEADING
from workflow.study.mesh_level import MODES, Level


def measure(blade: Blade, factor: float, source: str | Path | None = None) -> Level:
    """Frequencies and tip deflection with elements ``factor`` times the blade's own.

    ``source`` is the geometry file that the blade names, if it names one.

    Raises
    ------
    geometry.mesh.MeshError, fem.prestress.EquilibriumError, rom.modes.ModesError
        When a stage fails on this mesh.
    """
    size = factor * blade.mesh.element_size_mm
    resized = blade.changed(mesh__element_size_mm=size)
    with TemporaryDirectory() as folder:
        path = Path(folder, "blade.msh")
        built = build_mesh(resized, path, source)
        matrices = assemble(resized, f"{size:g} mm", path, [0.0, blade.max_speed_rad_s])
    frequencies = [ShiftInvert(K, matrices.M).modes(MODES).omega / (2 * np.pi) for K in matrices.K]
    of_patches = (matrices.S @ matrices.u_static[-1]).reshape(-1, 3)
    (tip,) = hats(LEADING, matrices.xi) @ of_patches
    return Level(
        element_size_mm=size,
        nodes=built.nodes,
        at_rest_Hz=frequencies[0].tolist(),
        at_Omega_m_Hz=frequencies[1].tolist(),
        tip_deflection_m=float(np.linalg.norm(tip)),
    )
