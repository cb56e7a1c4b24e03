"""``modes.h5``: component modes of the full model at the speeds of its matrices.

The basis of the reduced model takes them, whatever its directions; the full model with which it is
compared has the same at these speeds.
"""

from collections.abc import Callable, Iterable, Iterator
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
    def of(
        cls,
        fom: Constants,
        state: Prestressed,
        count: int,
        cholesky: Cholesky,
        modes: Callable[[ShiftInvert, int], Modes] = ShiftInvert.modes,
    ) -> Self:
        """Those of a ``state``, with its lowest ``count`` modes.

        ``cholesky``: factorises its K, unless it holds the factor already; ``modes``: SLEPc's, with
        which those of a basis, made in blocks, are compared.

        Raises
        ------
        rom.modes.ModesError
            When K is not positive definite, or modes do not converge.
        """
        inverse = ShiftInvert(state.K, fom.M, cholesky)
        found = modes(inverse, count)
        return cls(state.speed, found, inverse.solve(fom.S.T.toarray()), state.u_static)


def at_speeds(fom: Matrices, count: int, say: Say = silent) -> Iterator[AtSpeed]:
    """Component modes at the speeds of ``fom``, with ``count`` natural ones, each when asked for.

    ``say``: called after each speed. Raises the errors of ``AtSpeed.of``.
    """
    cholesky, states = Cholesky(), counted(fom.states(), len(fom.speeds), "speed", say)
    in_blocks = ShiftInvert.in_blocks
    return (AtSpeed.of(fom, state, count, cholesky, in_blocks) for state in states)


@frozen
class ComponentModes(Stored):
    """Component modes at all speeds, ascending."""

    code = CODE

    speeds: NDArray[np.float64] = stored("speed", "rad s-1")
    omega: NDArray[np.float64] = stored("speed mode", "rad s-1")
    residuals: NDArray[np.float64] = stored("speed mode")  # of these modes
    Phi: NDArray[np.float64] = stored("speed dof mode", "kg-1/2")
    A: NDArray[np.float64] = stored("speed dof interface", "m N-1")  # K^-1 S^T
    provenance: Provenance  # that of the matrices

    @classmethod
    def of(cls, fom: Matrices, each: Iterable[AtSpeed]) -> Self:
        """Those of ``fom`` at each of its speeds, of which one is in memory beside the result."""
        arrays: dict[str, NDArray[np.float64]] = {}
        for i, at in enumerate(each):
            for name, values in (vars(at.modes) | {"A": at.A}).items():
                of_all = arrays.setdefault(name, np.empty((len(fom.speeds), *values.shape)))
                of_all[i] = values
        return cls(speeds=fom.speeds, **arrays, provenance=fom.provenance)

    def at_speeds(self, fom: Matrices) -> Iterator[AtSpeed]:
        """Those at each speed, of the matrices ``fom`` of which they were made."""
        modes = map(Modes, self.omega, self.Phi, self.residuals)
        return map(AtSpeed, self.speeds, modes, self.A, fom.u_static)
