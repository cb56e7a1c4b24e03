"""Speeds at which the reduced model needs the full matrices."""

import numpy as np
from numpy.typing import NDArray

from geometry.blade import EnrichedBasis, PaperBasis

CHECK_SPEEDS = 17


def basis_speeds(basis: EnrichedBasis | PaperBasis, Omega_m: float) -> NDArray[np.float64]:
    """Speeds (n,) of a basis and of the polynomial K(Omega), rad/s.

    For `paper` 0, Omega_m/2, Omega_m (Eq. 3), else the Chebyshev-Lobatto points of Omega^2: for
    four speeds Omega_m times 0, 1/2, sqrt(3)/2, 1.
    """
    if isinstance(basis, PaperBasis):
        return Omega_m * np.array([0, 0.5, 1])
    angles = np.linspace(0, np.pi, basis.speeds)
    return Omega_m * np.sin(angles / 2)  # squares: (1 - cos)/2


def check_speeds(Omega_m: float) -> NDArray[np.float64]:
    """Equally spaced speeds (CHECK_SPEEDS,) over [0, Omega_m], rad/s, for the check of a model."""
    return np.linspace(0, Omega_m, CHECK_SPEEDS)
