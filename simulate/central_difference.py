"""Central differences with prediction and correction, Eqs. (18)-(20), in modal coordinates.

    q_p = a q_n - b q_{n-1},    q_{n+1} = q_p - c Phi_b^T F
    s = 1/h^2 + xi omega/h,  a = (2/h^2 - omega^2)/s,  b = (1/h^2 - xi omega/h)/s,  c = 1/s

with F the liner's force at the predicted displacement. The numbers are those of the dense scheme up
to round-off.
"""

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulate.compiled import compiled, compiled_sums
from simulate.contact import contact_functions
from simulate.law import Law
from simulate.ledger import WORK
from simulate.modal import Motion, Scheme, scheme_arrays


def coefficients(
    omega: NDArray[np.float64], Phi_b: NDArray[np.float64], xi: float, h: float
) -> Scheme:
    """Coefficients of Eqs. (19)-(20) for modes ``omega`` (n,), rad/s, and step ``h``, s.

    Parameters
    ----------
    Phi_b : (rows, n)
        Interface rows of the M-normalised modes.
    """
    s = 1 / h**2 + xi * omega / h
    return scheme_arrays(
        a=(2 / h**2 - omega**2) / s,
        b=(1 / h**2 - xi * omega / h) / s,
        loss=(xi * omega / (2 * h))[None],  # h v_n.D v_n, v_n = (q_{n+1} - q_{n-1})/2h
        gain=(1 / s)[None],
        Phi_b=Phi_b,
    )


def energy(omega: NDArray[np.float64], xi: float, h: float, motion: Motion, now: int) -> float:
    """E(n - 1/2) of Krenk 2006 between the last two steps, J; conserved by the free scheme."""
    x, before = motion.x[now, : omega.size], motion.x[now - 1, : omega.size]
    w = (x - before) / h
    return float(w @ w / 2 + before @ (omega**2 * x) / 2)


@compiled_sums
def advance(scheme, x, y, k, now, last, before):
    """q_p of Eq. (19) for mode ``k``, to turn ``now``; returns the damping loss of the step, J."""
    old = x[before, k]
    q = scheme.a[k] * x[last, k] - scheme.b[k] * old
    x[now, k] = q
    return scheme.loss[0, k] * (q - old) ** 2


@compiled_sums
def correct(scheme, x, y, modal, now, last, before):
    """Eq. (20) for the modal force (n,), N; returns the damping loss of the step, J."""
    lost = 0.0
    for k in range(modal.size):
        q = x[now, k] - scheme.gain[0, k] * modal[k]
        x[now, k] = q
        lost += scheme.loss[0, k] * (q - x[before, k]) ** 2
    return lost


@cache
def contact_step(law: type[Law], profile: bool, tangential: bool, rigid: bool, ledger: bool) -> Any:
    """Force of the liner at the predicted displacement, compiled for a law and a tip."""
    cover, _, press = contact_functions(law, profile, tangential, ledger)

    @compiled
    def find_force(
        scheme, strips, covered, solver, motion, eps_p, safe, step, a, now, last, before, books
    ):
        """Fill ``motion.force``, wear the liner, book.

        ``motion.u`` becomes the corrected displacement, ``motion.moved`` off the prediction, to
        which the liner was pressed.

        Returns
        -------
        bool, float, int
            Whether any strip bears; deepest penetration, m, and its strip.
        """
        u, moved, force, C = motion.u, motion.moved, motion.force, scheme.C
        rows, nodes = u.shape[1], strips.g0.size
        across = rows // 2
        deepest, where, touched = 0.0, 0, False
        for i in range(nodes):
            force[i] = 0.0
            if tangential:
                force[across + i] = 0.0
            if u[now, i] <= safe[i] and covered.loaded[i] == 0.0:
                continue
            u_t = u_t_before = 0.0
            if tangential:
                u_t, u_t_before = u[now, across + i], u[last, across + i] + moved[across + i]
            cover(strips, covered, eps_p, i, step, a, u[last, i] + moved[i], u_t, u_t_before, books)
            force[i], along, depth = press(
                strips, covered, eps_p, i, u[now, i], u[last, i] + moved[i], books
            )
            if tangential:
                force[across + i] = along
            touched |= force[i] > 0.0
            if depth > deepest:
                deepest, where = depth, i
        moved[:] = 0.0
        if touched:
            for j in range(rows):
                if force[j] != 0.0:
                    for i in range(rows):
                        moved[i] += C[j, i] * force[j]
            for i in range(rows):
                u[now, i] -= moved[i]
        if ledger and touched:
            for i in range(rows):
                books[WORK] -= force[i] * (u[now, i] - u[before, i]) / 2
        return touched, deepest, where

    return find_force
