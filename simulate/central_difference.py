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

LANES = 8  # interface rows summed in one pass over the modes; a cache line of numbers
SUM_IN_ANY_ORDER = {"reassoc", "contract", "nsz"}  # vector sums; still IEEE for inf and nan


class Scheme(NamedTuple):
    """Coefficients of the march as the kernel reads them.

    Modes and interface rows are padded with zeros to multiples of LANES: vectors without a rest.
    """

    c1: NDArray[np.float64]  # (n,)
    c2: NDArray[np.float64]  # (n,)
    Phi: NDArray[np.float64]  # (nodes, n), interface rows
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
    return Scheme(
        c1=_padded((2 / h**2 - omega**2) / s),
        c2=_padded((1 / h**2 - xi * omega / h) / s),
        Phi=_padded(Phi_b),
        c3_Phi=_padded(Phi_b / s),
    )


def modal_zeros(scheme: Scheme) -> NDArray[np.float64]:
    """Modal displacements (padded n,) at rest."""
    return _zeros(scheme.c1.shape)


def _padded(a: NDArray[np.float64]) -> NDArray[np.float64]:
    padded = _zeros(tuple(length + -length % LANES for length in a.shape))
    padded[tuple(slice(length) for length in a.shape)] = a
    return padded


def _zeros(shape: tuple[int, ...]) -> NDArray[np.float64]:
    """Zeros that begin on a cache line: vectors across two lines cost the march a tenth."""
    size = int(np.prod(shape))
    room = np.zeros(size + LANES)
    first = -room.ctypes.data % (8 * LANES) // 8
    return room[first : first + size].reshape(shape)


@numba.njit(fastmath=SUM_IN_ANY_ORDER)
def predict(c1, c2, Phi, q, q_old, u_r):
    """q_p of Eq. (19), written over ``q_old`` (n,), and the first LANES rows of Phi_b q_p, m.

    One pass for both: it is bound by loads. Arrays come one by one because the compiler keeps the
    fields of a tuple in memory.
    """
    u0 = u1 = u2 = u3 = u4 = u5 = u6 = u7 = 0.0
    for k in range(q.size):
        q_p = c1[k] * q[k] - c2[k] * q_old[k]
        q_old[k] = q_p
        u0 += Phi[0, k] * q_p
        u1 += Phi[1, k] * q_p
        u2 += Phi[2, k] * q_p
        u3 += Phi[3, k] * q_p
        u4 += Phi[4, k] * q_p
        u5 += Phi[5, k] * q_p
        u6 += Phi[6, k] * q_p
        u7 += Phi[7, k] * q_p
    u_r[0], u_r[1], u_r[2], u_r[3], u_r[4], u_r[5], u_r[6], u_r[7] = u0, u1, u2, u3, u4, u5, u6, u7


@numba.njit(fastmath=SUM_IN_ANY_ORDER)
def tip_displacement(Phi, q, first, u_r):
    """u_r = Phi_b q (padded nodes,), m, of the rows from ``first`` on."""
    for i in range(first, u_r.size):
        u = 0.0
        for k in range(q.size):
            u += Phi[i, k] * q[k]
        u_r[i] = u


@numba.njit
def may_touch(u_r, safe):
    """Whether any interface node is beyond its safe displacement."""
    beyond = False
    for i in range(safe.size):
        beyond |= u_r[i] > safe[i]
    return beyond


@numba.njit(fastmath=SUM_IN_ANY_ORDER)
def correct(C, force, q):
    """Eq. (20) with C = c3 Phi_b, in place on ``q`` (n,); ``force`` (padded nodes,), N.

    Nodes go by fours: neighbours touch together, and the others cost no pass.
    """
    for i in range(0, force.size, 4):
        f0, f1, f2, f3 = force[i], force[i + 1], force[i + 2], force[i + 3]
        if f0 + f1 + f2 + f3 > 0.0:  # no strip pulls
            for k in range(q.size):
                q[k] -= C[i, k] * f0 + C[i + 1, k] * f1 + C[i + 2, k] * f2 + C[i + 3, k] * f3


@numba.njit(error_model="numpy")
def distortion_share(rounds, ramp_rounds):
    """a(t): smooth step x^2 (3 - 2 x) from 0 to 1 over the ramp."""
    if rounds >= ramp_rounds:
        return 1.0
    x = rounds / ramp_rounds
    return x * x * (3.0 - 2.0 * x)


@cache
def march_kernel(record_force: bool, record_states: bool) -> Any:
    """Compiled march over one round; what the scene does not record is not in the code."""

    @numba.njit(error_model="numpy")
    def march_round(
        scheme, strips, ramp_rounds, done, steps, q, q_old, eps_p, samples, forces, states
    ):
        """March one round of ``steps`` steps.

        Parameters
        ----------
        done : int
            Rounds done before.
        q, q_old : (padded n,) modal displacements at the last two steps, modified in place
        eps_p : (nodes, nu) plastic strains, modified in place
        samples : (samples, nodes), m, u_r after every steps/samples-th step, filled
        forces : (2, nodes), N, peak and sum over steps of t_N in this round, filled
        states : (samples, padded n), modal displacements at every sample, filled

        Returns
        -------
        int, float
            Steps with contact; deepest penetration of a rod that bears, m.
        """
        nodes = strips.g0.size
        c1, c2, Phi, c3_Phi = scheme
        u_r, force = np.zeros(len(Phi)), np.zeros(len(Phi))
        safe = np.zeros(nodes)
        forces[:] = 0.0
        every = steps // len(samples)
        contacts, step, deepest = 0, 0, 0.0
        now, before = q, q_old
        for sample in range(len(samples)):
            a_first = distortion_share(done + step / steps, ramp_rounds)
            a_last = distortion_share(done + (step + every) / steps, ramp_rounds)
            reach(strips, a_first, a_last, step, step + every, safe)
            for _ in range(every):
                step += 1
                predict(c1, c2, Phi, now, before, u_r)
                now, before = before, now
                if nodes > LANES:
                    tip_displacement(Phi, now, LANES, u_r)
                if may_touch(u_r, safe):
                    a = distortion_share(done + step / steps, ramp_rounds)
                    penetration = contact_forces(strips, u_r, safe, a, step, eps_p, force)
                    if penetration > 0.0:
                        contacts += 1
                        deepest = max(deepest, penetration)
                        correct(c3_Phi, force, now)
                        if record_force:
                            for i in range(nodes):
                                forces[0, i] = max(forces[0, i], force[i])
                                forces[1, i] += force[i]
            tip_displacement(Phi, now, 0, u_r)
            samples[sample] = u_r[:nodes]
            if record_states:
                states[sample] = now
        if steps % 2 == 1:
            for k in range(q.size):
                q[k], q_old[k] = q_old[k], q[k]
        return contacts, deepest

    return march_round
