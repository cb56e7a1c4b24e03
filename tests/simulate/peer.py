"""An independent simulator in plain NumPy, from the equations, without code of the kernels.

Flat tip, plastic liner. Every strip looks at all rods of the round at every step, and each scheme
is written as its source has it: central differences on dense M, D, K, Eqs. (18)-(20), and modes
that are exact under a force held over the step, by matrix exponentials.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg import eigh, expm

from rom.model import Rom
from simulate.scene import LEADING, TRAILING, Scene

NEWTON_STEPS, WHOLE = 200, 10  # the first steps are whole, then half: whole ones may cycle


class March(NamedTuple):
    """Result of a march of the peer."""

    u_r: np.ndarray  # (m,), m, over the strips at the end
    wear: np.ndarray  # (m, nu), m
    contacts: int  # steps with contact


class Liner:
    """Strips of rods under the tip at one speed, their wear, and their forces."""

    def __init__(self, scene: Scene, rom: Rom, steps: int) -> None:
        liner, law = scene.liner, scene.liner.law
        self.nu, self.steps, self.ramp = liner.rods_per_round, steps, scene.casing.ramp_rounds
        ends = np.linspace(0, 1, liner.m + 1)
        xi = (ends[1:] + ends[:-1]) / 2
        _, self.theta, _ = rom.line(xi).T
        width = np.diff(rom.line(ends)[:, 2])
        pitch = 2 * np.pi * rom.camber[:, 0].mean() / self.nu
        self.length = max(liner.footprint_m / pitch, self.nu / steps, 1.0)  # of a footprint, rods
        self.A = width * liner.footprint_m / self.length
        self.l = liner.thickness_m
        self.E, self.K, self.sigma_Y = law.unit_Pa * np.array([law.E, law.K, law.sigma_Y])
        gaps = scene.clearance.gaps([LEADING, TRAILING], rom.span)
        self.g0 = gaps[0] + (gaps[1] - gaps[0]) * (xi - LEADING) / (TRAILING - LEADING)
        rods = 2 * np.pi * np.arange(self.nu) / self.nu
        self.d = np.zeros(self.nu)
        for wave in scene.casing.harmonics:
            phase = np.radians(wave.phase_deg)
            self.d += wave.amplitude_gaps * gaps[0] * np.cos(wave.order * rods + phase)
        self.farthest_in = self.d.max()
        self.eps_p = np.zeros((liner.m, self.nu))

    def share(self, n: int) -> float:
        """a of step ``n`` from the start: a smooth step over the ramp."""
        x = min(n / self.steps / self.ramp, 1.0) if self.ramp > 0 else 1.0
        return x * x * (3 - 2 * x)

    def may_touch(self, n: int, u_r: np.ndarray) -> bool:
        """Whether a rod anywhere around the casing could touch the tip."""
        return bool((u_r + self.share(n) * self.farthest_in > self.g0).any())

    def under(self, n: int) -> tuple[np.ndarray, np.ndarray]:
        """Covered part (m, nu) of each rod at step ``n``, and penetration at u_r = 0, m."""
        theta_b = 2 * np.pi * n / self.steps + self.theta
        away = np.arange(self.nu) - self.nu * theta_b[:, None] / (2 * np.pi)
        away -= self.nu * np.round(away / self.nu)
        part = np.clip((self.length + 1) / 2 - np.abs(away), 0, 1)
        return part, self.share(n) * self.d - self.g0[:, None]

    def bear(
        self, part: np.ndarray, lift: np.ndarray, u_r: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """t_N (m,) of Eq. (17), its slope, and the plastic strains after, Eqs. (7), (13)-(16)."""
        eps = np.maximum(lift + u_r[:, None], 0) / self.l  # Eq. (7)
        trial = self.E * (eps - self.eps_p)  # Eq. (13)
        f = trial - (self.sigma_Y + self.K * self.eps_p)  # Eq. (10)
        gamma = np.where((trial > 0) & (f > 0), f / (self.E + self.K), 0)  # Eq. (15)
        sigma = np.where(trial > 0, trial - self.E * gamma, 0)  # Eq. (16)
        tangent = np.where(gamma > 0, self.E * self.K / (self.E + self.K), self.E) * (trial > 0)
        slope = self.A / self.l * (part * tangent).sum(1)
        return self.A * (part * sigma).sum(1), slope, self.eps_p + gamma

    def wear_away(self, part: np.ndarray, after: np.ndarray) -> None:
        """Plastic strains change only while the footprint covers the centre of the rod."""
        self.eps_p = np.where(part >= 0.5, after, self.eps_p)


def central_difference(rom: Rom, scene: Scene, Omega: float, steps: int, count: int) -> March:
    """Prediction by Eq. (19), the liner's force there, correction by Eq. (20).

    In long double: in double, the condition of M (1e6 and more) alone would shift the blade's
    frequencies by more than the comparison asks for.
    """
    liner, h = Liner(scene, rom, steps), np.longdouble(2 * np.pi / Omega / steps)
    M, K = rom.M.astype(np.longdouble), rom.stiffness(Omega).astype(np.longdouble)
    squares, Phi = eigh(rom.stiffness(Omega), rom.M)
    D = (M @ Phi * (2 * scene.damping_ratio * np.sqrt(squares))) @ (M @ Phi).T
    left, P = _inverse(M / h**2 + D / (2 * h)), _over_strips(rom, scene)
    now = (left @ (2 * M / h**2 - K)).astype(float)
    before = (left @ (D / (2 * h) - M / h**2)).astype(float)
    correction = (left @ P.T).astype(float)
    u = u_old = np.zeros(rom.n)
    contacts = 0
    for n in range(1, count + 1):
        u, u_old = now @ u + before @ u_old, u
        if liner.may_touch(n, P @ u):
            part, lift = liner.under(n)
            force, _, after = liner.bear(part, lift, P @ u)
            liner.wear_away(part, after)
            contacts += bool(force.max() > 0)
            u = u - correction @ force
    return March(P @ u, liner.l * liner.eps_p, contacts)


def piecewise_exact(rom: Rom, scene: Scene, Omega: float, steps: int, count: int) -> March:
    """Exact modes under a force held over each step, which is that of the liner at its end."""
    liner, h, xi = Liner(scene, rom, steps), 2 * np.pi / Omega / steps, scene.damping_ratio
    squares, Phi = eigh(rom.stiffness(Omega), rom.M)
    omega, rows = np.sqrt(squares), _over_strips(rom, scene) @ Phi
    # q and q' a step later, from both and from the rest under a force, f / omega^2
    free = np.array([expm(h * np.array([[0, 1], [-(w**2), -2 * xi * w]])) for w in omega])
    gain = np.stack([(1 - free[:, 0, 0]) / squares, -free[:, 1, 0] / squares])
    C = (rows * gain[0]) @ rows.T
    state, force, contacts = np.zeros((2, len(omega))), np.zeros(len(rows)), 0
    for n in range(1, count + 1):
        state = np.einsum("nij,jn->in", free, state)
        predicted = rows @ state[0]
        if liner.may_touch(n, predicted):
            part, lift = liner.under(n)
            u_r, force = _implicit(liner, part, lift, predicted, C)
            liner.wear_away(part, liner.bear(part, lift, u_r)[2])
            contacts += bool(force.max() > 0)
            state = state - gain * (rows.T @ force)
    return March(rows @ state[0], liner.l * liner.eps_p, contacts)


def _implicit(
    liner: Liner, part: np.ndarray, lift: np.ndarray, predicted: np.ndarray, C: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Displacement and force with u_r = predicted - C t_N(u_r), by Newton's method."""
    u_r = predicted
    for step in range(NEWTON_STEPS):
        force, slope, _ = liner.bear(part, lift, u_r)
        moved = C @ force
        residual = u_r + moved - predicted
        if abs(residual).max() <= 1e-14 * (abs(predicted) + abs(moved)).max():
            return u_r, force
        change = np.linalg.solve(np.eye(len(C)) + C * slope, residual)
        u_r = u_r - (change if step < WHOLE else change / 2)
    raise AssertionError(f"no force found, residual {abs(residual).max():.1e} m")


def _over_strips(rom: Rom, scene: Scene) -> np.ndarray:
    """P (m, n): radial displacements at the strips."""
    return rom.rows((np.arange(scene.liner.m) + 0.5) / scene.liner.m)


def _inverse(A: np.ndarray) -> np.ndarray:
    """Inverse in long double: Newton's iteration from the double one, on the balanced matrix."""
    scale = 1 / np.sqrt(np.diag(A))
    balanced = A * np.outer(scale, scale)
    X = np.linalg.inv(balanced.astype(float)).astype(np.longdouble)
    for _ in range(4):
        X = X + X @ (np.eye(len(A)) - balanced @ X)
    return X * np.outer(scale, scale)
