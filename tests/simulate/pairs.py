"""A blade of one mode that bears without opening on a pair of a casing: kernel, and equations."""

from types import SimpleNamespace

import numpy as np
from scipy.optimize import brentq, minimize_scalar
from systems import Hooke, in_the_middle, strips

from simulate.contact.compiled import for_types_of
from simulate.contact.ramp import smooth
from simulate.marching import piecewise_exact
from simulate.marching.common_casing import common_casing, lending, lent_columns
from simulate.marching.disk import (
    Disk,
    Turned,
    does_not_slide,
    march_disk,
    of_all_schemes,
    same_casing,
    scheme_of,
    stacked,
)
from simulate.marching.friction import sliding
from simulate.marching.kernel import Recorded, at_start, march_round
from simulate.marching.modal import TURNS, padded_rows, rows_of
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


def largest_growth(of, between):
    """Largest rate, 1/s, and where."""
    top = minimize_scalar(
        lambda Omega: -growth(of, Omega), bounds=between, method="bounded", options={"xatol": 1e-8}
    )
    return -top.fun, top.x


def band(of, inside, outside, least=1e-7):
    """Speeds at which a band around ``inside`` begins and ends, within those ``outside``."""
    return [
        brentq(lambda Omega: growth(of, Omega) - least, inside, end, xtol=1e-10) for end in outside
    ]


def stood(theta, k_c, Omega, h, modes, zeta=0.0):
    """Equal blades at angles ``theta``, rad, on the pair: a disk, and the strips of each."""
    scheme, system = pressed(k_c, Omega, h, modes, zeta=zeta)
    moving, blades = moving_casing(modes, places(0.0), False, False), len(theta)
    lent = lent_columns(moving, scheme, 1)
    disk = Disk(
        schemes=stacked([lending(scheme, 1, lent)]),
        which=np.zeros(blades, np.int64),
        slides=does_not_slide,
        rows=of_all_schemes,
        casing=same_casing,
        g0=np.tile(system.g0, (blades, 1)),
        first=np.tile(system.first, (blades, 1)),
        leg=1,
        common=common_casing(moving, np.array(theta), lent, h, Omega),
    )
    return disk, system


def march_stood(disk, system, steps, start=None):
    """State of the blades after so many steps from ``start``: x, y of all, casing's, forces."""
    common, blades = disk.common, len(disk.which)
    n = disk.schemes.Phi.shape[1]
    states = stacked([at_start(scheme_of(disk, j), system) for j in range(blades)])
    motion, rows = states.motion, np.zeros((blades, 1, 1))
    x, y, of_casing, pulled = np.split(
        np.zeros(2 * (blades + 2) + 2 * blades) if start is None else start,
        np.cumsum([blades, blades, 4]),
    )
    motion.x[:, 0, 0], motion.y[:, 0, 0] = x, y
    motion.u[:, 0] = motion.x[:, 0] @ disk.schemes.Phi.T
    common.motion.x[0, :2], common.motion.y[0, :2] = of_casing.reshape(2, 2)
    common.pulled[:, :2] = pulled.reshape(blades, 2)
    system = system._replace(rigid_depth=1e9)  # never worn through
    recorded = Recorded(
        rows, np.zeros((blades, 3, 0)), np.zeros((blades, 0, 0)),
        Phi=padded_rows(np.zeros((1, n))), weights=np.zeros((2, 0, 1)), casing=np.zeros((1, 2)),
        pushed=np.zeros((blades, 1, 0)),
    )  # fmt: skip
    turned = Turned.room(blades)
    arguments = disk, system, states, recorded, smooth(0.0), np.inf, 0, steps, turned
    for_types_of(march_disk, *arguments)(*arguments)
    assert (turned.contacts == steps).all()
    now, own = steps % TURNS, common.motion
    found = motion.x[:, now, 0], motion.y[:, now, 0], own.x[now, :2], own.y[now, :2]
    return np.concatenate([*found, common.pulled[:, :2].ravel()]), states


def of_stage(Omega, theta, k_c=0.2, h=0.01):
    """As ``of_kernel``, of several equal blades."""
    disk, system = stood(theta, k_c, Omega, h, [mode()])
    rest, _ = march_stood(disk, system, 1)
    step = [march_stood(disk, system, 1, unit)[0] - rest for unit in np.eye(rest.size)]
    values = np.linalg.eigvals(np.array(step).T)
    return np.log(values[abs(values) > 0.5].astype(complex)) / h
