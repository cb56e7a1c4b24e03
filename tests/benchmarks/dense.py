"""The paper's march as printed, Eqs. (18)-(20), on dense M, D, K, for the benchmark of speed.

It calls the same compiled contact functions as the modal kernel: they differ in how the blade is
marched alone. What is right is told by tests/simulate/peer.py, which shares nothing.
"""

from typing import NamedTuple

import numba
import numpy as np

from rom.model import Rom
from simulate.contact import cover, nothing_covered, press
from simulate.modal import Step
from simulate.ramp import distortion_share
from simulate.setup import Setup


class Dense(NamedTuple):
    """Propagators of Eq. (19) and the correction of Eq. (20)."""

    now: np.ndarray  # (n, n)
    before: np.ndarray  # (n, n)
    correction: np.ndarray  # (n, m)
    P: np.ndarray  # (m, n), radial displacements over the strips


def dense_matrices(rom: Rom, setup: Setup, xi: float) -> Dense:
    """[M/h^2 + D/2h]^-1 applied to the matrices of Eq. (19)."""
    h, M, K = setup.h, rom.M, rom.stiffness(setup.Omega)
    omega, Phi = rom.modes(setup.Omega)
    P = rom.rows(setup.places.xi)
    M_Phi = M @ Phi
    D = (M_Phi * (2 * xi * omega)) @ M_Phi.T
    left = np.linalg.inv(M / h**2 + D / (2 * h))
    return Dense(
        now=left @ (2 * M / h**2 - K),
        before=left @ (D / (2 * h) - M / h**2),
        correction=np.ascontiguousarray(left @ P.T),
        P=P,
    )


@numba.njit
def contact_forces(strips, covered, u_r, a, step, eps_p, force):
    """t_N (m,) of Eq. (17) at the predicted displacements; whether any is not zero."""
    energies = np.zeros(5)
    for i in range(strips.g0.size):
        force[i] = 0.0
        if u_r[i] - strips.g0[i] + a * strips.d_window[_first(strips, i, step)] > 0.0:
            now = Step(step, a, a, 0, 0, 0)
            cover(strips, covered, eps_p, i, now, 0.0, u_r[i], 0.0, 0.0, False, energies)
            force[i] = press(strips, covered, eps_p, i, u_r[i], u_r[i], energies)[0]
    return force.max() > 0.0


@numba.njit
def _first(strips, i, step):
    return int(strips.first[i] + step * strips.advance) % strips.d.size


def march_dense(dense, strips, covered, ramp_rounds, first, count, steps, u, u_old, eps_p):
    """Steps ``first + 1`` to ``first + count``; returns (u, u_old, steps with contact)."""
    force = np.zeros(strips.g0.size)
    contacts = 0
    for n in range(first + 1, first + count + 1):
        predicted = dense.now @ u + dense.before @ u_old
        done, step = (n - 1) // steps, (n - 1) % steps + 1
        a = distortion_share(ramp_rounds, done + step / steps)
        if contact_forces(strips, covered, dense.P @ predicted, a, step, eps_p, force):
            contacts += 1
            predicted = predicted - dense.correction @ force
        u, u_old = predicted, u
    return u, u_old, contacts


march_dense_compiled = numba.njit(march_dense)


def under(strips):
    """What ``march_dense`` needs to know of the rods under the tip."""
    return nothing_covered(strips)
