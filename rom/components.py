"""Component modes of the full model at one speed, for ``rom.basis``."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from rom.basis import Components
from rom.modes import ModesError, ShiftInvert

MOST_CONDITION = 1e8  # of C; above, the mesh does not resolve the patches


def natural_components(K: csr_matrix, M: csr_matrix, S: csr_matrix, modes: int) -> Components:
    """Constraint modes, and ``modes`` natural modes with free interface.

    K, M: (n_full, n_full), N/m and kg; S: (n_c, n_full). Raises ``ModesError``.
    """
    inverse = ShiftInvert(K, M)
    return Components(_constraint_modes(inverse, S)[1], inverse.modes(modes).Phi)


def fixed_components(K: csr_matrix, M: csr_matrix, S: csr_matrix, eta: int) -> Components:
    """Constraint modes, and ``eta`` fixed-interface modes, those of (K^-1 - A C^-1 A^T) M.

    K, M: (n_full, n_full), N/m and kg; S: (n_c, n_full). Raises ``ModesError``.
    """
    inverse = ShiftInvert(K, M)
    A, Phi_R = _constraint_modes(inverse, S)
    return Components(Phi_R, inverse.fixed_modes(A, Phi_R, S, eta).Phi)


def _constraint_modes(inverse: ShiftInvert, S: csr_matrix) -> tuple[NDArray, NDArray]:
    """A = K^-1 S^T and Phi_R = A C^-1 (n_full, n_c).

    Raises
    ------
    ModesError
        When C is singular to round-off.
    """
    A = inverse.solve(S.T.toarray())
    C = S @ A
    C = (C + C.T) / 2
    scale = 1 / np.sqrt(np.diag(C))  # axial and radial compliances differ by orders of magnitude
    condition = np.linalg.cond(C * np.outer(scale, scale))
    if not condition <= MOST_CONDITION:
        raise ModesError(
            f"the mesh of the tip cannot tell so many apart (condition {condition:.0e} of their "
            f"compliance, allowed {MOST_CONDITION:.0e}); take half as many, or refine the mesh",
            key="interface.patches",
        )
    Phi_R = np.linalg.solve(C, A.T).T
    return A, Phi_R - A @ np.linalg.solve(C, S @ Phi_R - np.eye(len(C)))  # S Phi_R = I
