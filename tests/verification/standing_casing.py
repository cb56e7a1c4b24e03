"""A rub on a casing that moves, in an independent march: the casing in its own frame.

Central differences on the modes of blade and casing with the force at the middle of the three
steps, explicit and of order two, and rods found anew at every step. Nothing turns here: the casing
is a cos(n phi) + b sin(n phi) in its own frame, and the blade passes at phi = theta + Omega t. A
rod wears while its centre is covered; so short a step passes a small part of a rod.
"""

from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

from rom.model import Rom
from simulate.scene import LEADING, TRAILING, Scene


class Blade(NamedTuple):
    """Modes, and what the tip rubs on."""

    omega: NDArray[np.float64]  # (n,), rad/s
    zeta: float
    rows: NDArray[np.float64]  # (m, n), u_r over the strips
    out: NDArray[np.float64]  # (n,), u_r at xi = 1/16
    theta: NDArray[np.float64]  # (m,), rad
    gap: NDArray[np.float64]  # (m,), m
    length: NDArray[np.float64]  # (m,), footprint, rods
    area: NDArray[np.float64]  # (m,), m2, of a rod
    law: tuple[float, float, float, float]  # E, K, sigma_Y, Pa; thickness, m
    d: NDArray[np.float64]  # (nu,), m
    ramp: float  # revolutions


@numba.njit(cache=False)
def marched(blade, mode, Omega, steps, rounds):
    """u_r (steps * rounds,), m, at xi = 1/16, casing a and b there, and plastic strains (m, nu).

    ``mode``: order, rad/s, modal mass, damping ratio of the casing.
    """
    h = 2 * np.pi / Omega / steps
    order, omega_c, mass, zeta_c = mode
    n, m, nu = blade.omega.size, blade.theta.size, blade.d.size
    E, K, sigma_Y, thickness = blade.law
    s = 1 / h**2 + blade.zeta * blade.omega / h
    a1, a2 = (2 / h**2 - blade.omega**2) / s, (1 / h**2 - blade.zeta * blade.omega / h) / s
    s_c = 1 / h**2 + zeta_c * omega_c / h
    c1, c2 = (2 / h**2 - omega_c**2) / s_c, (1 / h**2 - zeta_c * omega_c / h) / s_c
    q, q_old, modal = np.zeros(n), np.zeros(n), np.zeros(n)
    of_casing, of_casing_old = np.zeros(2), np.zeros(2)
    eps_p, u_r, casing = np.zeros((m, nu)), np.zeros(steps * rounds), np.zeros((steps * rounds, 2))
    for step in range(steps * rounds):
        turn = step / steps  # revolutions
        x = min(turn / blade.ramp, 1.0) if blade.ramp > 0 else 1.0
        share = x * x * (3 - 2 * x)
        modal[:] = 0.0
        on_a = on_b = 0.0
        for i in range(m):
            phi = blade.theta[i] + 2 * np.pi * turn
            c, sn = np.cos(order * phi), np.sin(order * phi)
            w = blade.rows[i] @ q - of_casing[0] * c - of_casing[1] * sn
            centre, half = phi * nu / (2 * np.pi), blade.length[i] / 2
            if w - blade.gap[i] + share * blade.d.max() <= 0:
                continue
            force = 0.0
            for j in range(int(np.floor(centre - half - 1)), int(np.ceil(centre + half + 1)) + 1):
                away = abs(j - centre)
                part = min(max(half + 0.5 - away, 0.0), 1.0)
                eps = (share * blade.d[j % nu] - blade.gap[i] + w) / thickness
                trial = E * (eps - eps_p[i, j % nu])
                if part == 0.0 or eps <= 0 or trial <= 0:
                    continue
                over = trial - sigma_Y - K * eps_p[i, j % nu]
                gamma = max(over, 0.0) / (E + K)
                force += part * (trial - E * gamma)
                if away <= half + nu / steps / 2:  # on average to the end of what is covered
                    eps_p[i, j % nu] += gamma
            force *= blade.area[i]
            modal += force * blade.rows[i]
            on_a += force * c
            on_b += force * sn
        q_old, q = q, a1 * q - a2 * q_old - modal / s
        pushed = np.array([on_a, on_b]) / mass / s_c
        of_casing_old, of_casing = of_casing, c1 * of_casing - c2 * of_casing_old + pushed
        u_r[step] = blade.out @ q
        casing[step] = of_casing
    return u_r, casing, eps_p


def blade_of(scene: Scene, rom: Rom, Omega: float) -> Blade:
    """What a plain ``scene`` is made of: radial contact, gaps at speed, harmonics that stand."""
    liner, law = scene.liner, scene.liner.law
    omega, Phi = rom.modes(Omega)
    xi = (np.arange(liner.m) + 0.5) / liner.m
    radius, theta, _ = rom.line(xi).T
    width = np.diff(rom.line(np.linspace(0, 1, liner.m + 1))[:, 2])
    nu = liner.rods_per_round
    length = np.full(liner.m, liner.footprint_m * nu / (2 * np.pi * rom.camber[:, 0].mean()))
    at = scene.clearance.gaps([LEADING, TRAILING], rom.span)
    angle = 2 * np.pi * np.arange(nu) / nu
    return Blade(
        omega=omega,
        zeta=scene.damping_ratio,
        rows=np.ascontiguousarray(rom.rows(xi, "r") @ Phi),
        out=(rom.rows(np.array([LEADING]), "r") @ Phi)[0],
        theta=theta,
        gap=at[0] + (at[1] - at[0]) * (xi - LEADING) / (TRAILING - LEADING),
        length=length,
        area=width * liner.footprint_m / length,
        law=(*(law.unit_Pa * np.array([law.E, law.K, law.sigma_Y])), liner.thickness_m),
        d=scene.casing.inward(angle, at[0]),
        ramp=float(scene.casing.ramp_rounds),
    )
