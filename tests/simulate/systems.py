"""Small systems with known answers, built straight as the kernel's arrays."""

import numpy as np

from simulate.central_difference import coefficients, march_kernel
from simulate.contact import Strips, largest_over_window
from simulate.plastic import Plastic


def strips(law, g0, d, m=1, area=1.0, thickness=1.0, first=None, advance=0.0) -> Strips:
    """Strips of ``len(d)`` rods; without ``advance`` a node stays on its rods."""
    g0, d = np.atleast_1d(np.asarray(g0, float)), np.asarray(d, float)
    first = np.zeros(len(g0)) if first is None else np.asarray(first, float)
    return Strips(law, g0, d, largest_over_window(d, m), first, advance, m, area, thickness)


def one_rod(E, K, sigma_Y=0.0, gap=0.0) -> Strips:
    """One node on one rod of unit area and thickness: stiffness E, N/m."""
    return strips(Plastic(E, K, sigma_Y), gap, np.zeros(4))


def march(system, omega, Phi_b, xi, h, steps, q, q_old, ramp_rounds=0.0, rounds=1):
    """March from (q, q_old); returns u_r at every step (rounds * steps, nodes), eps_p, contacts."""
    Phi_b = np.atleast_2d(Phi_b).astype(float)
    scheme = coefficients(np.asarray(omega, float), Phi_b, xi, h)
    eps_p = np.zeros((len(Phi_b), len(system.d)))
    samples, forces = np.zeros((rounds, steps, len(Phi_b))), np.zeros((2, len(Phi_b)))
    # the kernel's modes are padded
    q, q_old = (np.pad(np.array(x, float), (0, len(scheme.c1) - len(x))) for x in (q, q_old))
    contacts = 0
    for done in range(rounds):
        contacts += march_kernel(False, False)(
            scheme,
            system,
            ramp_rounds,
            done,
            steps,
            q,
            q_old,
            eps_p,
            samples[done],
            forces,
            samples[done],
        )[0]
    return samples.reshape(-1, len(Phi_b)), eps_p, contacts
