"""Speeds at which the reduced model needs the full matrices."""

import numpy as np
from numpy.typing import NDArray

CHECK_SPEEDS = 9


def basis_speeds(Omega_m: float) -> NDArray[np.float64]:
    """The three speeds of Eqs. (3)-(4): 0, Omega_m/2, Omega_m (rad/s)."""
    return np.array([0.0, Omega_m / 2, Omega_m])


def check_speeds(Omega_m: float) -> NDArray[np.float64]:
    """Nine speeds over [0, Omega_m], rad/s."""
    return np.linspace(0, Omega_m, CHECK_SPEEDS)
