"""``full-model.nc``: results of the full model with which a reduced model is compared."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fem.matrices import CODE, Matrices
from geometry.provenance import Provenance
from rom.modes import ShiftInvert
from rom.stored import Stored, stored

MODES = 10  # frequencies compared
SHAPES = 5  # mode shapes at rest, for figures


@dataclass(frozen=True)
class FullModel(Stored):
    """Frequencies and compliance of the interface of the full model over its speeds."""

    code = CODE

    speeds: NDArray[np.float64] = stored("speed", "rad s-1")  # rest first
    omega: NDArray[np.float64] = stored("speed mode", "rad s-1")
    residuals: NDArray[np.float64] = stored("speed mode")  # of these modes
    # C = S K^-1 S^T, (speeds, 3 n, 3 n), order as in S
    compliance: NDArray[np.float64] = stored("speed dof dof_", "m N-1")
    shapes: NDArray[np.float64] = stored("shape point xyz", "kg-1/2")  # modes at rest, Cartesian
    coordinates: NDArray[np.float64] = stored("point xyz", "m")  # free nodes of the mesh
    provenance: Provenance  # that of the matrices


def solve(fom: Matrices) -> FullModel:
    """First modes, and compliance of the interface, at every speed of ``fom``.

    Raises
    ------
    rom.modes.ModesError
        When K is not positive definite, or modes do not converge.
    """
    modes, compliance = [], []
    loads = fom.S.T.toarray()
    for K in fom.K:
        inverse = ShiftInvert(K, fom.M)
        modes.append(inverse.modes(MODES))
        compliance.append(fom.S @ inverse.solve(loads))
    return FullModel(
        speeds=fom.speeds,
        omega=np.array([m.omega for m in modes]),
        residuals=np.array([m.residuals for m in modes]),
        compliance=np.array(compliance),
        shapes=modes[0].Phi[:, :SHAPES].T.reshape(SHAPES, -1, 3),
        coordinates=fom.coordinates,
        provenance=fom.provenance,
    )
