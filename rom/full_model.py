"""``full-model.nc``: results of the full model with which a reduced model is compared."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fem.cholesky import Cholesky
from fem.matrices import CODE, Constants, State
from geometry.project import Provenance
from rom.modes import Modes, ShiftInvert
from rom.stored import Stored, stored

MODES = 10  # frequencies compared
SPARE = 4  # modes beyond these, among which one may come from above between two speeds
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

    def joined(self, other: Self) -> Self:
        """With the results of ``other``, at further speeds."""
        order = np.argsort(np.concatenate([self.speeds, other.speeds]))
        names = "speeds", "omega", "residuals", "compliance"
        both = {name: np.concatenate([getattr(of, name) for of in (self, other)]) for name in names}
        return replace(self, **{name: values[order] for name, values in both.items()})


def solve(fom: Constants, states: Iterable[State], cholesky: Cholesky | None = None) -> FullModel:
    """First modes, and compliance of the interface, at every state.

    The modes at the last two speeds, ``SPARE`` more than are compared, start the iteration at the
    next.

    Parameters
    ----------
    states : at ascending speeds; one at a time is kept
    cholesky : factorises K of the states, unless it holds the factor already

    Raises
    ------
    rom.modes.ModesError
        When K is not positive definite, or modes do not converge.
    """
    cholesky, loads = cholesky or Cholesky(), fom.S.T.toarray()
    rows: list[tuple] = []
    shapes: list[NDArray[np.float64]] = []  # at rest and at the last two speeds
    for state in states:
        inverse = ShiftInvert(state.K, fom.M, cholesky)
        modes = _modes(inverse, shapes[-2:])
        compliance = fom.S @ inverse.solve(loads)
        rows.append((state.speed, modes.omega[:MODES], modes.residuals[:MODES], compliance))
        shapes = [*shapes[:1], *shapes[1:][-1:], modes.Phi]
    speeds, omega, residuals, compliances = map(np.array, zip(*rows, strict=True))
    return FullModel(
        speeds=speeds,
        omega=omega,
        residuals=residuals,
        compliance=compliances,
        shapes=shapes[0][:, :SHAPES].T.reshape(SHAPES, -1, 3),
        coordinates=fom.coordinates,
        provenance=fom.provenance,
    )


def _modes(inverse: ShiftInvert, at_last: list[NDArray[np.float64]]) -> Modes:
    """First modes, iterated from those ``at_last`` two speeds; those of one do not span enough."""
    count = MODES + SPARE
    return inverse.modes_near(count, np.hstack(at_last)) if at_last[1:] else inverse.modes(count)
