"""Stability limit of central differences, free and with every strip engaged.

With the liner force taken at the predicted position, an engaged elastic liner of stiffness K_c makes the
step map q_{n+1} = B (c1 q_n - c2 q_{n-1}), B = I - c3 Phi_b^T K_c Phi_b. It loses stability where an
eigenvalue passes -1; there, with q_{n+1} = -q_n = q_{n-1},

    det(I - K_c Phi_b diag(s) Phi_b^T) = 0,  s = c3 (3/h^2 - omega^2 - xi omega/h) / (4/h^2 - omega^2)

so the limit needs eigenvalues of interface size only. One free mass m on a rod k gives h^2 k/m = 4/3, a
free mode h omega = 2. K_c is taken from E, the unloading slope, and all strips engaged: the worst case.
"""

import numpy as np
from numpy.typing import NDArray

TOLERANCE = 1e-10  # relative width of the bracket of the limit
ROUND_OFF = 1e-7  # an eigenvalue of a defective double root at 1 is known to sqrt(eps)


def step_limit(
    omega: NDArray[np.float64], Phi_b: NDArray[np.float64], xi: float, k_strip: float
) -> float:
    """Largest stable step, s.

    Parameters
    ----------
    omega : (n,), rad/s
    Phi_b : (nodes, n), M-normalised modes at the radial interface DoFs
    xi : damping ratio
    k_strip : stiffness of one engaged strip, N/m
    """
    low, high = 0.0, 2 / omega.max()
    while high - low > TOLERANCE * high:
        h = (low + high) / 2
        low, high = (h, high) if _gain(h, omega, Phi_b, xi, k_strip) < 1 else (low, h)
    return low


def spectral_radius(
    h: float, omega: NDArray[np.float64], Phi_b: NDArray[np.float64], xi: float, k_strip: float
) -> float:
    """Spectral radius of the step map (q_n, q_{n-1}) -> (q_{n+1}, q_n); k_strip = 0 is the free map."""
    s = 1 / h**2 + xi * omega / h
    B = np.eye(len(omega)) - (Phi_b.T / s[:, None]) @ (k_strip * Phi_b)
    c1, c2 = (2 / h**2 - omega**2) / s, (1 / h**2 - xi * omega / h) / s
    n = len(omega)
    step = np.block([[B * c1, -B * c2], [np.eye(n), np.zeros((n, n))]])
    return float(np.abs(np.linalg.eigvals(step)).max())


def is_stable(
    h: float, omega: NDArray[np.float64], Phi_b: NDArray[np.float64], xi: float, k_strip: float
) -> bool:
    """Whether the step map is stable, free and with every strip engaged."""
    return all(
        spectral_radius(h, omega, Phi_b, xi, k) <= 1 + ROUND_OFF for k in (0.0, k_strip)
    )


def _gain(
    h: float, omega: NDArray[np.float64], Phi_b: NDArray[np.float64], xi: float, k_strip: float
) -> float:
    """Largest eigenvalue of K_c Phi_b diag(s) Phi_b^T: 1 where an eigenvalue of the map is -1."""
    c3 = 1 / (1 / h**2 + xi * omega / h)
    s = c3 * (3 / h**2 - omega**2 - xi * omega / h) / (4 / h**2 - omega**2)
    return float(np.linalg.eigvalsh(k_strip * (Phi_b * s) @ Phi_b.T)[-1])
