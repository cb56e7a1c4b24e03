"""Central differences with prediction and correction, Eqs. (18)-(20), in modal coordinates.

    q_p = a q_n - b q_{n-1},    q_{n+1} = q_p - c Phi_b^T F
    s = 1/h^2 + zeta omega/h,  a = (2/h^2 - omega^2)/s,  b = (1/h^2 - zeta omega/h)/s,  c = 1/s

with F the liner's force at the predicted displacement. The numbers are those of the dense scheme up
to round-off.
"""

import numpy as np
from numpy.typing import NDArray

from simulate.contact.compiled import compiled, compiled_sums
from simulate.contact.ledger import WORK
from simulate.contact.rods import cover, press
from simulate.contact.strips import closest, lean_at
from simulate.marching.modal import Motion, Scheme, scheme_arrays
from simulate.scene.damping import Ratios


def coefficients(
    omega: NDArray[np.float64], Phi_b: NDArray[np.float64], zeta: Ratios, h: float
) -> Scheme:
    """Coefficients of Eqs. (19)-(20) for modes ``omega`` (n,), rad/s, and step ``h``, s.

    Parameters
    ----------
    Phi_b : (rows, n)
        Interface rows of the M-normalised modes.
    """
    s = 1 / h**2 + zeta * omega / h  # Eq. (18) in Eq. (1)
    return scheme_arrays(
        a=(2 / h**2 - omega**2) / s,
        b=(1 / h**2 - zeta * omega / h) / s,
        loss=(zeta * omega / (2 * h))[None],  # h v_n.D v_n, v_n = (q_{n+1} - q_{n-1})/2h
        gain=(1 / s)[None],
        Phi_b=Phi_b,
        functions=(advance, correct, find_force),
    )


def motion_of(
    omega: NDArray[np.float64],
    zeta: Ratios,
    h: float,
    x: NDArray[np.float64],
    y: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Modal displacements (n,) after the last of two steps ``x`` (2, n), velocities between."""
    return x[0], (x[0] - x[1]) / h


def turns_of(
    omega: NDArray[np.float64],
    zeta: Ratios,
    h: float,
    q: NDArray[np.float64],
    v: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The last two steps x (2, n) from displacements and velocities; y is not used."""
    return np.array([q, q - h * v]), np.zeros((2, q.size))


def energy(omega: NDArray[np.float64], zeta: Ratios, h: float, motion: Motion, now: int) -> float:
    """E(n - 1/2) of Krenk 2006 between the last two steps, J; conserved by the free scheme."""
    x, before = motion.x[now, : omega.size], motion.x[now - 1, : omega.size]
    w = (x - before) / h
    return float(w @ w / 2 + before @ (omega**2 * x) / 2)


@compiled_sums
def advance(scheme, x, y, k, now, last, before):
    """q_p of Eq. (19) for mode ``k``, to turn ``now``; returns the damping loss of the step, J."""
    old = x[before, k]
    q = scheme.a[k] * x[last, k] - scheme.b[k] * old  # Eq. (19)
    x[now, k] = q
    return scheme.loss[0, k] * (q - old) ** 2


@compiled_sums
def correct(scheme, x, y, modal, now, last, before):
    """Eq. (20) for the modal force (n,), N; returns the damping loss of the step, J."""
    lost = 0.0
    for k in range(modal.size):
        q = x[now, k] - scheme.gain[0, k] * modal[k]  # Eq. (20)
        x[now, k] = q
        lost += scheme.loss[0, k] * (q - x[before, k]) ** 2
    return lost


@compiled
def find_force(scheme, strips, state, step):
    """Fill ``motion.force`` for the predicted displacement, wear the liner, book.

    ``motion.u`` becomes the corrected displacement; ``motion.moved`` = C F, the part that the
    correction takes off the prediction, is kept: the liner was compressed to the predicted
    displacement.

    Returns
    -------
    bool, float, int
        Whether any strip bears; deepest penetration, m, and its strip.
    """
    motion, covered, eps_p, energies = state.motion, state.covered, state.eps_p, state.energies
    u, moved, force, C = motion.u, motion.moved, motion.force, scheme.C
    first_t, first_lean, leans = strips.first_t, strips.first_lean, len(strips.rows) == 2
    u_t = u_t_before = lean = lean_before = 0.0
    deepest, where, touched = 0.0, 0, False
    force[:] = 0.0
    for i in range(strips.g0.size):
        w, w_before = u[step.now, i], u[step.last, i] + moved[i]
        if leans:
            lean = lean_at(strips, u, step.now, i)
            lean_before = lean_at(strips, u, step.last, i) + moved[first_lean + i]
        nearest = max(closest(strips, w, lean), closest(strips, w_before, lean_before))
        if nearest <= motion.free[i] and covered.strips[i].stored == 0.0:
            continue
        if strips.tangential:
            u_t, u_t_before = (
                u[step.now, first_t + i],
                u[step.last, first_t + i] + moved[first_t + i],
            )
        cover(
            strips, covered, eps_p, i, step, w_before, w, lean_before, lean, u_t, u_t_before, False,
            energies,
        )  # fmt: skip
        force[i], t_T, moment, depth = press(strips, covered, eps_p, i, w, w, lean, lean, energies)
        if leans:
            force[first_lean + i] = moment
        if strips.tangential:
            force[first_t + i] = t_T
        touched |= force[i] > 0.0
        if depth > deepest:
            deepest, where = depth, i
    moved[:] = 0.0
    if touched:
        for j in range(force.size):
            if force[j] != 0.0:
                for i in range(force.size):
                    moved[i] += C[j, i] * force[j]
        for i in range(force.size):
            u[step.now, i] -= moved[i]
            energies[WORK] -= force[i] * (u[step.now, i] - u[step.before, i]) / 2
    return touched, deepest, where
