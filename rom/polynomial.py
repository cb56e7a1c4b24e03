"""Interpolation K(Omega) = K0 + Omega^2 K1 + Omega^4 K2 + ... at given speeds: Eqs. (2)-(3).

The paper takes three speeds, 0, Omega_m/2 and Omega_m. The factor of K2 printed in Eq. (3),
3/(4 Omega_m^4), does not interpolate; 4/(3 Omega_m^4) does.
"""

import numpy as np
from numpy.typing import NDArray


def interpolate(K: NDArray[np.float64], speeds: NDArray[np.float64]) -> NDArray[np.float64]:
    """Coefficients (speeds, ...) of the powers 0, 2, 4, ... of Omega.

    Parameters
    ----------
    K : (speeds, ...), N/m
        At ``speeds`` (rad/s), of which the last is the highest.
    """
    if len(speeds) == 1:  # K at rest alone: a constant
        return K
    Omega_m = speeds[-1]
    powers = np.arange(len(speeds))
    unit = np.linalg.inv(np.vander((speeds / Omega_m) ** 2, increasing=True))
    return np.asarray(np.tensordot(unit / Omega_m ** (2.0 * powers)[:, None], K, axes=1), float)


def evaluate(coefficients: NDArray[np.float64], Omega: float) -> NDArray[np.float64]:
    """Value at Omega (rad/s) from ``coefficients`` (powers, ...)."""
    return sum(
        (Omega ** (2 * p) * c for p, c in enumerate(coefficients)),
        start=np.zeros(np.shape(coefficients)[1:]),
    )
