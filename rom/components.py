"""``modes.h5``: component modes of the full model at the speeds of its matrices.

The basis of the reduced model takes them, whatever its directions, and so does the full model with
which it is compared.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fem.cholesky import Cholesky
from fem.matrices import CODE, Constants, Matrices, Prestressed
from geometry.base import Provenance, Say, counted, silent
from geometry.stored import Stored, frozen, stored
from rom.modes import Modes, ShiftInvert


@dataclass(frozen=True)
class AtSpeed:
    """Natural modes with free interface, and static displacements, at one speed."""

    speed: float  # rad/s
    modes: Modes
    A: NDArray[np.float64]  # (n_full, 3 across n), K^-1 S^T
    u_static: NDArray[np.float64]  # (n_full,), m

    @classmethod
    def of(cls, fom: Constants, state: Prestressed, count: int, cholesky: Cholesky) -> Self:
        """Those of a ``state``, with its lowest ``count`` modes.

        ``cholesky``: factorises its K, unless it holds the factor already.

        Raises
        ------
        rom.modes.ModesError
            When K is not positive definite, or modes do not converge.
        """
        inverse = ShiftInvert(state.K, fom.M, cholesky)
        modes = inverse.modes(count)
        return cls(state.speed, modes, inverse.solve(fom.S.T.toarray()), state.u_static)


@frozen
class ComponentModes(Stored):
    """Component modes at all speeds, ascending."""

    code = CODE

    speeds: NDArray[np.float64] = stored("speed", "rad s-1")
    omega: NDArray[np.float64] = stored("speed mode", "rad s-1")
    Phi: NDArray[np.float64] = stored("speed dof mode", "kg-1/2")
    residuals: NDArray[np.float64] = stored("speed mode")
    A: NDArray[np.float64] = stored("speed dof interface", "m N-1")  # K^-1 S^T
    u_static: NDArray[np.float64] = stored("speed dof", "m", may_be_nan=True)
    coordinates: NDArray[np.float64] = stored("point xyz", "m")  # free nodes
    provenance: Provenance  # that of the matrices

    @classmethod
    def of(cls, fom: Matrices, count: int, say: Say = silent) -> Self:
        """Those of ``fom``, with its lowest ``count`` modes; ``say``: called after each speed.

        Raises the errors of ``AtSpeed.of``.
        """
        cholesky, states = Cholesky(), counted(fom.states(), len(fom.speeds), "speed", say)
        each = [AtSpeed.of(fom, state, count, cholesky) for state in states]
        return cls(
            speeds=fom.speeds,
            omega=np.array([at.modes.omega for at in each]),
            Phi=np.array([at.modes.Phi for at in each]),
            residuals=np.array([at.modes.residuals for at in each]),
            A=np.array([at.A for at in each]),
            u_static=fom.u_static,
            coordinates=fom.coordinates,
            provenance=fom.provenance,
        )

    def each(self, count: int) -> Iterator[AtSpeed]:
        """Those of each speed, with the lowest ``count`` modes."""
        for j, speed in enumerate(self.speeds):
            of_speed = self.omega[j], self.Phi[j].T, self.residuals[j]
            omega, Phi, residuals = (values[:count] for values in of_speed)
            yield AtSpeed(speed, Modes(omega, Phi.T, residuals), self.A[j], self.u_static[j])
