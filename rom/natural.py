"""``modes.h5``: natural modes of the full model at the speeds of its matrices, by SLEPc.

The basis of the reduced model takes them, whatever its directions, and the full model with which
it is compared.
"""

import numpy as np
from numpy.typing import NDArray

from fem.cholesky import Cholesky
from fem.matrices import CODE, Matrices
from geometry.base import Provenance, Say, counted, silent
from geometry.stored import Stored, frozen, stored
from rom.modes import ShiftInvert


@frozen
class NaturalModes(Stored):
    """Lowest natural modes with free interface, M-normalised, at each speed."""

    code = CODE

    speeds: NDArray[np.float64] = stored("speed", "rad s-1")  # ascending
    omega: NDArray[np.float64] = stored("speed mode", "rad s-1")
    Phi: NDArray[np.float64] = stored("speed dof mode", "kg-1/2")
    provenance: Provenance  # that of the matrices

    def at(self, speed: float, count: int) -> list[tuple[float, NDArray[np.float64]]]:
        """omega^2 and phi of the first modes at a speed, rad/s; none where it is another one."""
        return [
            (omega**2, phi)
            for j in np.flatnonzero(self.speeds == speed)
            for omega, phi in zip(self.omega[j, :count], self.Phi[j].T[:count], strict=True)
        ]


def natural_modes(fom: Matrices, count: int, say: Say = silent) -> NaturalModes:
    """Lowest ``count`` modes at the speeds of ``fom``; ``say``: called after each.

    Raises
    ------
    rom.modes.ModesError
        When a K is not positive definite, or modes do not converge.
    """
    cholesky = Cholesky()  # K of all speeds have one symbolic factorisation
    stiffnesses = counted(fom.K, len(fom.K), "speed", say)
    modes = [ShiftInvert(K, fom.M, cholesky).modes(count) for K in stiffnesses]
    return NaturalModes(
        speeds=fom.speeds,
        omega=np.array([each.omega for each in modes]),
        Phi=np.array([each.Phi for each in modes]),
        provenance=fom.provenance,
    )
