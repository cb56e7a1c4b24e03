"""Error of a mesh at rest, from frequencies and compliances of the tip on a coarser mesh."""

from math import sqrt
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from fem.assemble import assemble
from fem.at_rest import build_mesh_at_rest
from fem.matrices import Matrices
from geometry.base import UserError
from geometry.blade import Blade
from rom.full_model import FullModel, compliance_of_strips, solve

COARSER = sqrt(2)  # element size of the coarser mesh over the blade's
ORDER = 1.7  # of the compliance of patches; frequencies converge faster, with order 3 to 4


def numbers(blade: str, full: str, source: str) -> dict[str, Any]:
    """Relative error of the blade's mesh, the larger of those of frequencies and compliances.

    Both are of order ``ORDER`` at least in the element size, so that they follow from the
    difference from a mesh coarser by ``COARSER`` (Roache 1994). ``blade``: YAML file of the blade;
    ``full``: its full model; ``source``: the file of its geometry, if any. Without a coarser mesh
    they are None, and `why` says why.
    """
    settings, model = Blade.load(blade), FullModel.load(full)
    size = COARSER * settings.mesh.element_size_mm
    about = {
        "mesh": model.provenance.mesh,
        "element_size_mm": settings.mesh.element_size_mm,
        "coarser_mm": size,
    }
    try:
        fom = remeshed(settings.but(mesh__element_size_mm=size), source or None)
    except UserError as error:
        unknown = dict.fromkeys(("error", "frequencies", "compliance"))
        return about | unknown | {"why": str(error)}
    other, times = solve(fom, fom.states()), COARSER**ORDER - 1
    frequencies = np.abs(other.omega[0] / model.omega[0] - 1).max() / times
    own, finer = (
        compliance_of_strips(of.compliance[0][::3, ::3], fom.across) for of in (other, model)
    )
    compliance = np.abs(own / finer - 1).max() / times
    return about | {
        "error": float(max(frequencies, compliance)),
        "frequencies": float(frequencies),
        "compliance": float(compliance),
    }


def remeshed(blade: Blade, source: str | None) -> Matrices:
    """Matrices of a blade at rest; its mesh is not kept. ``source``: the geometry file, if any.

    Raises
    ------
    geometry.mesh.MeshError, fem.prestress.EquilibriumError
        When a stage fails on this mesh.
    """
    with TemporaryDirectory() as folder:
        mesh = Path(folder, "blade.msh")
        build_mesh_at_rest(blade, mesh, source)
        return assemble(blade, "coarser", mesh, [0.0])
