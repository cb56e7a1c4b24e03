"""Interpolation K(Omega) = K0 + Omega^2 K1 + Omega^4 K2 + ... at given speeds: Eqs. (2)-(3).

The paper takes three speeds, 0, Omega_m/2 and Omega_m. The factor of K2 printed in Eq. (3),
3/(4 Omega_m^4), does not interpolate; 4/(3 Omega_m^4) does.

And its speeds: those at which it needs the full matrices, and at which it is compared with them.
"""

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.blade import EnrichedBasis, PaperBasis

PLACES = 1001  # over the range of Omega^2, at which w is taken


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


def basis_speeds(basis: EnrichedBasis | PaperBasis, Omega_m: float) -> NDArray[np.float64]:
    """Speeds (n,) of a basis and of the polynomial K(Omega), rad/s.

    For `paper` 0, Omega_m/2, Omega_m (Eq. 3), else the Chebyshev-Lobatto points of Omega^2: for
    four speeds Omega_m times 0, 1/2, sqrt(3)/2, 1.
    """
    if isinstance(basis, PaperBasis):
        return Omega_m * np.array([0, 0.5, 1])
    angles = np.linspace(0, np.pi, basis.speeds)
    return Omega_m * np.sin(angles / 2)  # squares: (1 - cos)/2


def places_between(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Between each two of the ``x`` (n,), ascending in [0, 1], where ``|node_polynomial|`` peaks.

    There a polynomial through them errs most.
    """
    x_at = np.linspace(0, 1, PLACES)
    within = [x_at[(start < x_at) & (x_at < end)] for start, end in pairwise(x)]
    return np.array([places[node_polynomial(x, places).argmax()] for places in within])


def node_polynomial(x: NDArray[np.float64], x_at: NDArray[np.float64]) -> NDArray[np.float64]:
    """Product w of the distances to the ``x`` (n,), at each of ``x_at``."""
    return abs(np.atleast_1d(x_at)[:, None] - x).prod(axis=1)


def speeds_between(basis: ArrayLike) -> NDArray[np.float64]:
    """Speeds (n - 1,), rad/s, at which a model is checked beside its ``basis`` speeds (n,).

    At these missing modes show alone; between each two, the polynomial K(Omega) errs most here.
    """
    basis = np.asarray(basis)
    return basis[-1] * np.sqrt(places_between((basis / basis[-1]) ** 2))
