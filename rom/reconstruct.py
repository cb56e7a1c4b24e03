"""``basis-<directions>.h5``: displacements of the full blade from reduced ones, Eq. (5)."""

import numpy as np
from numpy.typing import NDArray

from fem.matrices import Matrices
from geometry.base import Provenance
from geometry.stored import Stored, frozen, stored
from rom.model import CODE, RomError, require_speed
from rom.polynomial import evaluate, interpolate


@frozen
class Basis(Stored):
    """Basis T and static deflection: displacements of the free DoFs from reduced coordinates.

    DoF 3 p + c is component c (x, y, z) of free node p.
    """

    code = CODE

    T: NDArray[np.float64] = stored("dof_full dof")  # (n_full, n), Eq. (5)
    # powers 2, 4, ... of Omega; nan where it is not known
    u_static: NDArray[np.float64] = stored("power dof_full", "m (rad s-1)^-power", may_be_nan=True)
    coordinates: NDArray[np.float64] = stored("point xyz", "m")  # free nodes
    Omega_m: float = stored(units="rad s-1")  # highest speed
    provenance: Provenance  # that of the reduced model

    @classmethod
    def of(cls, fom: Matrices, T: NDArray[np.float64], provenance: Provenance) -> "Basis":
        """Basis from T (n_full, n) of ``rom.reduce.reduce`` and the static deflections of ``fom``.

        The static deflection over Omega^2 is interpolated by a polynomial in Omega^2, so that the
        deflection is exactly zero at rest. Where K is given at rest alone, it is not known.
        """
        spun, deflections = fom.speeds[1:], fom.u_static[1:]
        return cls(
            T=T,
            u_static=(
                interpolate(deflections / spun[:, None] ** 2, spun)
                if len(spun)
                else np.full_like(fom.u_static, np.nan)
            ),
            coordinates=fom.coordinates,
            Omega_m=fom.top_speed,
            provenance=provenance,
        )

    def reconstruct(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Vibration (n_full,), m, about the static deflection, from reduced displacements u (n,).

        Raises
        ------
        RomError
            When u belongs to another reduced model.
        """
        if np.shape(u) != self.T.shape[1:]:
            raise RomError(
                f"reduced displacements of shape {np.shape(u)}: this basis needs one state of "
                f"({self.T.shape[1]},); take sweep and basis of the same blade and directions"
            )
        return self.T @ u

    def static(self, Omega: float) -> NDArray[np.float64]:
        """Static deflection u_static(Omega) (n_full,), m; Omega in rad/s; nan: not known.

        Raises
        ------
        RomError
            Outside [0, Omega_m].
        """
        require_speed(Omega, self.Omega_m)
        return Omega**2 * evaluate(self.u_static, Omega)
