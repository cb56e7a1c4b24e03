"""Variants of a blade that the workflow meshes for no scene: their matrices and frequencies."""

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
    """Matrices of the blade at ``speeds``, rad/s, on a mesh of its own that is not kept.

    ``files.source`` is the geometry file that the blade names, if it names one.

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
    """First ``count`` frequencies (speeds, count), rad/s, at every speed of ``fom``.

    Raises
    ------
    rom.modes.ModesError
        When they are not found.
    """
    return np.array([ShiftInvert(K, fom.M).modes(count).omega for K in fom.K])
