"""Plastic law of the liner with linear isotropic hardening: Eqs. (9)-(16).

Loading past the elastic limit follows the modulus E K / (E + K); unloading follows E. The return
mapping at constant strain has the closed form of Eq. (15). Reference: Simo and Hughes 1998, chapter
1.
"""

from typing import NamedTuple

import numba


class Plastic(NamedTuple):
    """Parameters of the law, Pa."""

    E: float
    K: float
    sigma_Y: float


@numba.njit(inline="always")
def stress(law, eps, eps_p):
    """Stress and plastic strain at total strain ``eps``, from plastic strain ``eps_p``.

    Returns ``(sigma, eps_p)``, Pa and 1; no tension. sigma = E (eps - eps_p) is Eq. (13) summed
    over its increments; alpha = eps_p, Eq. (11).
    """
    sigma = law.E * (eps - eps_p)  # trial, Eq. (13)
    if sigma <= 0.0:
        return 0.0, eps_p
    f = sigma - (law.sigma_Y + law.K * eps_p)  # Eq. (10)
    if f > 0.0:
        gamma = f / (law.E + law.K)  # Eq. (15)
        return sigma - law.E * gamma, eps_p + gamma  # Eq. (16)
    return sigma, eps_p
