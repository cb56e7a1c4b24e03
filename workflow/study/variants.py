"""Matrices and frequencies of variants of a blade for studies; their meshes are not kept."""

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fem.assemble import assemble
from fem.matrices import Matrices
from geometry.blade import Blade
from geometry.mesh import MeshSummary, build_mesh
from rom.modes import ShiftInvert

AT_REST = (0.0,)


def remeshed(
    blade: Blade, files: Any, speeds: Sequence[float] = AT_REST
) -> tuple[Matrices, MeshSummary]:
    """Matrices of the blade at ``speeds``, rad/s, and its mesh, which is not kept.

    ``files.source``: the geometry file that the blade names, if any.

    Raises
    ------
    geometry.mesh.MeshError, fem.prestress.EquilibriumError
        When a stage fails on this mesh.
    """
    with TemporaryDirectory() as folder:
        mesh = Path(folder, "blade.msh")
        summary = build_mesh(blade, mesh, getattr(files, "source", None))
        return assemble(blade, "variant", mesh, speeds), summary


def frequencies(fom: Matrices, count: int) -> NDArray[np.float64]:
    """First ``count`` natural frequencies (speeds, count), rad/s, at every speed of ``fom``.

    Raises
    ------
    rom.modes.ModesError
        When the eigenvalue solver does not converge.
    """
    return np.array([ShiftInvert(K, fom.M).modes(count).omega for K in fom.K])
