"""Central differences with prediction and correction, Eqs. (18)-(20), in modal coordinates.

With Phi the modes of K(Omega) and D = M Phi diag(2 xi omega) Phi^T M, the matrices of Eqs.
(19)-(20) are diagonal in the modal coordinates q = Phi^T M u, so a step costs O(n) and the
interface rows of Phi:

    q_p = c1 q_n - c2 q_{n-1},    q_{n+1} = q_p - c3 Phi_b^T t_N
    s = 1/h^2 + xi omega/h,  c1 = (2/h^2 - omega^2)/s,  c2 = (1/h^2 - xi omega/h)/s,  c3 = 1/s

The numbers are those of the dense scheme up to round-off.
"""

from functools import cache
from typing import Any, NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

from simulate.contact import contact_forces, reach

LANES = 8  # interface rows summed together: they share one pass over the modes
SUM_IN_ANY_ORDER = {"reassoc", "contract", "nsz"}  # vector sums; still IEEE for inf and nan


class Scheme(NamedTuple):
    """Coefficients of the march as the kernel reads them."""

    c1: NDArray[np.float64]  # (n,)
    c2: NDArray[np.float64]  # (n,)
    Phi: NDArray[
        np.float64
    ]  # (nodes, n) interface rows, padded with zero rows to a multiple of LANES
    c3_Phi: NDArray[np.float64]  # (nodes, n)


def coefficients(
    omega: NDArray[np.float64], Phi_b: NDArray[np.float64], xi: float, h: float
) -> Scheme:
    """Coefficients of Eqs. (19)-(20) for modes ``omega`` (n,), rad/s, and step ``h``, s.

    Parameters
    ----------
    Phi_b : (nodes, n)
        Rows of the M-normalised modes at the radial interface DoFs.
    """
    s = 1 / h**2 + xi * omega / h
    padding = -len(Phi_b) % LANES
    return Scheme(
        c1=(2 / h**2 - omega**2) / s,
        c2=(1 / h**2 - xi * omega / h) / s,
        Phi=np.ascontiguousarray(np.pad(Phi_b, ((0, padding), (0, 0)))),
        c3_Phi=Phi_b / s,
    )


@numba.njit(fastmath=SUM_IN_ANY_ORDER)
def predict(scheme, q, q_old):
    """q_p of Eq. (19), written over ``q_old`` (n,)."""
    for k in range(q.size):
        q_old[k] = scheme.c1[k] * q[k] - scheme.c2[k] * q_old[k]


@numba.njit(fastmath=SUM_IN_ANY_ORDER)
def tip_displacement(scheme, q, u_r):
    """u_r = Phi_b q (padded nodes,), m, written over ``u_r``; LANES rows in each pass."""
    Phi = scheme.Phi
    for i in range(0, u_r.size, LANES):
        u0 = u1 = u2 = u3 = u4 = u5 = u6 = u7 = 0.0
        for k in range(q.size):
            u0 += Phi[i, k] * q[k]
            u1 += Phi[i + 1, k] * q[k]
            u2 += Phi[i + 2, k] * q[k]
            u3 += Phi[i + 3, k] * q[k]
            u4 += Phi[i + 4, k] * q[k]
            u5 += Phi[i + 5, k] * q[k]
            u6 += Phi[i + 6, k] * q[k]
            u7 += Phi[i + 7, k] * q[k]
        u_r[i], u_r[i + 1], u_r[i + 2], u_r[i + 3] = u0, u1, u2, u3
        u_r[i + 4], u_r[i + 5], u_r[i + 6], u_r[i + 7] = u4, u5, u6, u7


@numba.njit
def may_touch(u_r, safe):
    """Whether any interface node is beyond its safe displacement."""
    beyond = False
    for i in range(safe.size):
        beyond |= u_r[i] > safe[i]
    return beyond


@numba.njit(fastmath=SUM_IN_ANY_ORDER)
def correct(scheme, force, q):
    """Eq. (20), in place on ``q`` (n,)."""
    for i in range(force.size):
        if force[i] > 0.0:
            for k in range(q.size):
                q[k] -= scheme.c3_Phi[i, k] * force[i]


@numba.njit(error_model="numpy")
def distortion_share(rounds, ramp_rounds):
    """a(t): smooth step x^2 (3 - 2 x) from 0 to 1 over the ramp."""
    if rounds >= ramp_rounds:
        return 1.0
    x = rounds / ramp_rounds
    return x * x * (3.0 - 2.0 * x)


@cache
def march_kernel(record_force: bool) -> Any:
    """Compiled march over one round; what the scene does not record is not in the code."""

    @numba.njit(error_model="numpy")
    def march_round(scheme, strips, ramp_rounds, done, steps, q, q_old, eps_p, samples, forces):
        """March one round of ``steps`` steps.

        Parameters
        ----------
        done : int
            Rounds done before.
        q, q_old : (n,) modal displacements at the last two steps, modified in place
        eps_p : (nodes, nu) plastic strains, modified in place
        samples : (samples, nodes), m, u_r after every steps/samples-th step, filled
        forces : (2, nodes), N, peak and sum over steps of t_N in this round, filled

        Returns
        -------
        int
            Steps with contact.
        """
        nodes = strips.g0.size
        u_r, force, safe = np.zeros(scheme.Phi.shape[0]), np.zeros(nodes), np.zeros(nodes)
        forces[:] = 0.0
        every = steps // len(samples)
        contacts = step = 0
        now, before = q, q_old
        for sample in range(len(samples)):
            a_first = distortion_share(done + step / steps, ramp_rounds)
            a_last = distortion_share(done + (step + every) / steps, ramp_rounds)
            reach(strips, a_first, a_last, step, step + every, safe)
            for _ in range(every):
                step += 1
                predict(scheme, now, before)
                now, before = before, now
                tip_displacement(scheme, now, u_r)
                if may_touch(u_r, safe):
                    a = distortion_share(done + step / steps, ramp_rounds)
                    if contact_forces(strips, u_r, a, step, eps_p, force):
                        contacts += 1
                        correct(scheme, force, now)
                        if record_force:
                            for i in range(nodes):
                                forces[0, i] = max(forces[0, i], force[i])
                                forces[1, i] += force[i]
            tip_displacement(scheme, now, u_r)
            samples[sample] = u_r[:nodes]
        if steps % 2 == 1:
            for k in range(q.size):
                q[k], q_old[k] = q_old[k], q[k]
        return contacts

    return march_round
