"""Stability limit of central differences, free and with every strip engaged.

With the liner force taken at the predicted position, an engaged elastic liner of stiffness K_c
makes the step map

    q_{n+1} = B (c1 q_n - c2 q_{n-1}),  B = I - c3 Phi_b^T K_c Phi_b                             (a)

The limit is the largest h at which its spectral radius stays 1. Two bounds enclose it, both from
eigenvalues of interface size, b(h) = lambda_max(K_c Phi_b diag(c3) Phi_b^T):

* b <= 1 and h omega < 2 is stable: B^-1 - I is then a positive stiffness taken at t_{n+1}.
* An eigenvalue reaches -1, q_{n+1} = -q_n = q_{n-1}, where lambda_max(K_c Phi_b diag(s) Phi_b^T) =
1 with
  s = c3 (3/h^2 - omega^2 - xi omega/h) / (4/h^2 - omega^2). One free mass m on a rod k: b = h^2 k/m
  = 4/3.

Between them, several modes on one strip can grow as a pair of complex eigenvalues: an undamped
blade does so little above b = 1, far below 4/3; a little damping takes it away. K_c is taken from
E, the unloading slope, and all strips engaged: the worst case.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

FLIP_TOLERANCE = 1e-9  # relative width of the brackets of the two bounds
RADIUS_TOLERANCE = 1e-3  # relative width of the bracket where the spectral radius decides
ROUND_OFF = 1e-9  # of eigenvalues on the unit circle; a growth of this size needs 1e9 steps


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

    def gain(weights: Callable[..., NDArray]) -> Callable[[float], bool]:
        return lambda h: (
            np.linalg.eigvalsh(k_strip * (Phi_b * weights(h, omega, xi)) @ Phi_b.T)[-1] < 1
        )

    def stable(h: float) -> bool:
        return spectral_radius(h, omega, Phi_b, xi, k_strip) <= 1 + ROUND_OFF

    flip = _last_true(gain(_flip_weights), 0.0, 2 / omega.max(), FLIP_TOLERANCE)
    if stable(flip * (1 - 1e-6)):
        return flip
    proven = _last_true(gain(_correction), 0.0, flip, FLIP_TOLERANCE)
    return _last_true(stable, proven, flip, RADIUS_TOLERANCE)


def spectral_radius(
    h: float, omega: NDArray[np.float64], Phi_b: NDArray[np.float64], xi: float, k_strip: float
) -> float:
    """Spectral radius of the step map (a), (q_n, q_{n-1}) -> (q_{n+1}, q_n); k_strip = 0: free."""
    n, c3 = len(omega), _correction(h, omega, xi)
    B = np.eye(n) - (Phi_b.T * c3[:, None]) @ (k_strip * Phi_b)
    c1, c2 = (2 / h**2 - omega**2) * c3, (1 / h**2 - xi * omega / h) * c3
    step = np.block([[B * c1, -B * c2], [np.eye(n), np.zeros((n, n))]])
    return float(np.abs(np.linalg.eigvals(step)).max())


def _last_true(holds: Callable[[float], bool], low: float, high: float, tolerance: float) -> float:
    """Where ``holds`` ends, by bisection; it is taken to hold at ``low``."""
    while high - low > tolerance * high:
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low


def _correction(h: float, omega: NDArray[np.float64], xi: float) -> NDArray[np.float64]:
    """c3 of Eq. (20)."""
    return 1 / (1 / h**2 + xi * omega / h)


def _flip_weights(h: float, omega: NDArray[np.float64], xi: float) -> NDArray[np.float64]:
    """The weights s of the second bound."""
    shape = (3 / h**2 - omega**2 - xi * omega / h) / (4 / h**2 - omega**2)
    return _correction(h, omega, xi) * shape
