"""Stability limit of central differences with contact.

With the liner force taken at the predicted position, engaged elastic strips of stiffness K_c make
the step map, with c1, c2, c3 the a, b, c of ``central_difference``,

    q_{n+1} = B (c1 q_n - c2 q_{n-1}),  B = I - c3 Phi_b^T K_c Phi_b                             (a)

Multiplied by B^-1 / c3 this is the central difference of the free blade with an additional force,

    G q_{n+1},  G = Phi_b^T (K_c^-1 - Phi_b c3 Phi_b^T)^-1 Phi_b                                 (b)

and q_{n+1} = q_n + h v_n + h^2/2 a_n: a mass h^2 G/2, a damping h G and a stiffness G. While G is
positive the scheme is stable for h omega < 2: 4/h^2 (I + h^2 G/2) - omega^2 - G stays positive.
G is positive where

    b = lambda_max(K_c Phi_b diag(c3) Phi_b^T) < 1                                               (c)

and then also for every subset of engaged strips, whose b is smaller. The limit is this bound for
all strips engaged, with K_c from E, the unloading slope. It is sufficient and nearly sharp: a
single free mass on a rod is unstable from b = h^2 k/m = 4/3, h 15 % larger; several modes can grow
slowly anywhere between, and faster with some strips engaged than with all.
"""

import numpy as np
from numpy.typing import NDArray

from simulate.scene.damping import Ratios

TOLERANCE = 1e-9  # relative width of the bracket of the limit


def step_limit(
    omega: NDArray[np.float64],
    Phi_b: NDArray[np.float64],
    zeta: Ratios,
    k_strip: NDArray[np.float64],
) -> float:
    """Largest step, s, that is stable for any set of engaged strips: h omega < 2, b < 1, Eq. (c).

    Parameters
    ----------
    omega : (n,), rad/s
    Phi_b : (m, n), M-normalised modes over the strips
    zeta : damping ratio, of each mode or of all
    k_strip : (m,), stiffness of each strip, engaged, N/m
    """
    low, high = 0.0, 2 / omega.max()
    if engagement(high, omega, Phi_b, zeta, k_strip) < 1:
        return high
    while high - low > TOLERANCE * high:
        h = (low + high) / 2
        low, high = (h, high) if engagement(h, omega, Phi_b, zeta, k_strip) < 1 else (low, h)
    return low


def engagement(
    h: float,
    omega: NDArray[np.float64],
    Phi_b: NDArray[np.float64],
    zeta: Ratios,
    k_strip: NDArray[np.float64],
) -> float:
    """Number b of Eq. (c): the scheme makes contact 1/(1 - b) times stiffer than K_c, Eq. (b)."""
    c3 = 1 / (1 / h**2 + zeta * omega / h)
    rows = np.sqrt(k_strip)[:, None] * Phi_b
    return float(np.linalg.eigvalsh((rows * c3) @ rows.T)[-1])
