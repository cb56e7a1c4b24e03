"""K(Omega) = K0 + Omega^2 K1 + Omega^4 K2 through three speeds: Eqs. (2)-(3).

The factor printed before K2 in Eq. (3), 3/(4 Omega_m^4), does not interpolate; 4/(3 Omega_m^4)
does.
"""

import numpy as np
from numpy.typing import NDArray

POWERS = (0, 2, 4)


def interpolate(K: NDArray[np.float64], Omega_m: float) -> NDArray[np.float64]:
    """Coefficients (3, n, n) for powers 0, 2, 4 of Omega (rad/s).

    Parameters
    ----------
    K : (3, n, n), N/m
        At 0, Omega_m/2 and Omega_m.
    """
    rest, half, full = K
    K1 = (16 * half - full - 15 * rest) / (3 * Omega_m**2)
    K2 = 4 / (3 * Omega_m**4) * (full - 4 * half + 3 * rest)
    return np.stack([rest, K1, K2])


def evaluate(coefficients: NDArray[np.float64], Omega: float) -> NDArray[np.float64]:
    """K(Omega), (n, n), from ``coefficients`` (3, n, n); Omega in rad/s."""
    return sum(Omega**p * K for p, K in zip(POWERS, coefficients, strict=True))
