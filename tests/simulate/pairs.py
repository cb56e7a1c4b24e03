"""A blade of one mode that bears without opening on a pair of a casing: kernel, and equations."""

from types import SimpleNamespace

import numpy as np
from scipy.optimize import brentq
from systems import Hooke, in_the_middle, strips

from simulate.contact.compiled import for_types_of
from simulate.contact.ramp import smooth
from simulate.marching import piecewise_exact
from simulate.marching.friction import sliding
from simulate.marching.kernel import Recorded, at_start, march_round
from simulate.marching.modal import padded_rows, rows_of
from simulate.marching.moving_casing import moving_casing
from simulate.scene.casing_modes import CasingMode

PRELOAD = 8.0  # order-0 distortion that keeps the contact closed
W_B, M_R, W_R, N = 1.0, 10.0, 2.0, 2  # blade of mass 1, on a pair of the casing


def mode(zeta=0.0, **more):
    """The pair of the closed forms."""
    values = {"order": N, "frequency_Hz": W_R / (2 * np.pi), "modal_mass_kg": M_R}
    return CasingMode(**values | {"damping_ratio": zeta} | more)


def places(*theta, slope=0.0, footprint=0.0):
    """Strips at angles, rad, at the radius of 1 m."""
    theta = np.array(theta)
    one = np.ones(len(theta))
    return SimpleNamespace(
        xi=theta, theta=theta, radius=one, slope=slope * one, footprint=footprint * one
    )


def pressed(k_c, Omega, h, modes, theta=(0.0,), zeta=0.0, mu=None):
    """Scheme of a blade on elastic strips of a casing that moves, and the strips."""
    m = len(theta)
    moving = moving_casing(modes, places(*theta), mu is not None, False)
    blade = np.ones((m, 1)), np.zeros((m if mu is not None else 0, 1)), np.zeros((0, 1))
    (closing, along, _), omega, zetas = moving.beside(blade, np.array([W_B]), zeta)
    system = strips(Hooke(k_c), np.zeros(m), np.full(4, PRELOAD))
    system = in_the_middle(system, omega, closing, zetas, h)
    rows = rows_of(closing, along) if mu is not None else closing
    scheme = piecewise_exact.coefficients(omega, rows, zetas, h)
    if mu is not None:
        scheme = sliding(scheme, system.first_t, np.full(m, mu), np.full(m, k_c))
        # without arc, as the tip does not pass along the rods, nor is it shifted to others
        system = system._replace(tangential=True, pitch=np.full(m, 1e30))
    return moving.turned(scheme, 1, Omega * h), system


def step_map(scheme, system, n=3):
    """Matrix (2n, 2n) of a step of the kernel on x, y of the modes, contact closed."""

    def after(start):
        state = at_start(scheme, system)
        state.motion.x[0, :n], state.motion.y[0, :n] = start[:n], start[n:]
        state.motion.u[:] = state.motion.x @ scheme.Phi.T
        empty = padded_rows(np.zeros((1, n))), np.zeros((2, 0, 1))
        recorded = Recorded(np.zeros((1, 1)), np.zeros((3, 0)), np.zeros((0, 0)), *empty)
        arguments = scheme, system, state, recorded, smooth(0.0), np.inf, 0, 1
        contacts, *_ = for_types_of(march_round, *arguments)(*arguments)
        assert contacts == 1
        return np.concatenate([state.motion.x[1, :n], state.motion.y[1, :n]])

    rest = after(np.zeros(2 * n))
    return np.array([after(unit) - rest for unit in np.eye(2 * n)]).T, rest


def of_kernel(Omega, k_c=0.2, h=0.01, zeta=0.0, mu=None):
    """Eigenvalues s (1/s) of the motion, from those of a step, exp(s h)."""
    step, _ = step_map(*pressed(k_c, Omega, h, [mode(zeta)], zeta=zeta, mu=mu))
    values = np.linalg.eigvals(step)
    return np.log(values.astype(complex)) / h


def of_equations(Omega, k_c=0.2, zeta=0.0, mu=0.0):
    """The same in the blade's frame, exact: u of the blade, p and q of the casing."""
    k_r, c = M_R * W_R**2, 2 * zeta * W_R * M_R
    turns, mass = N * Omega, np.diag([1.0, M_R, M_R])
    K = np.array([
        [W_B**2 + k_c, -k_c, 0],
        [-k_c, k_r - turns**2 * M_R + k_c, -c * turns],
        [-mu * k_c / N, mu * k_c / N + c * turns, k_r - turns**2 * M_R],
    ])  # fmt: skip
    D = np.array([[2 * zeta * W_B, 0, 0], [0, c, -2 * turns * M_R], [0, 2 * turns * M_R, c]])
    inverse = np.linalg.inv(mass)
    return np.linalg.eigvals(
        np.block([[np.zeros((3, 3)), np.eye(3)], [-inverse @ K, -inverse @ D]])
    )


def growth(of, Omega):
    """Largest rate, 1/s."""
    return of(Omega).real.max()


def band(of, inside, outside, least=1e-7):
    """Speeds at which a band around ``inside`` begins and ends, within those ``outside``."""
    return [
        brentq(lambda Omega: growth(of, Omega) - least, inside, end, xtol=1e-10) for end in outside
    ]
