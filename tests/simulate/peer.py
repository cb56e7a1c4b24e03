"""An independent simulator in plain NumPy, from the equations, without code of the kernels.

Flat tip, plastic liner; friction in piecewise-exact. The tip may have several places across its
thickness in piecewise-exact: its displacement is linear from place to place, evenly spaced from the
edge behind to the edge ahead, and the rods' forces go to them by the same hat functions. Every
strip finds its rods among all near the tip at every step, and each scheme is written as its source
has it: central differences on dense M, D, K, Eqs. (18)-(20), and modes that are exact under a force
held over the step, by matrix exponentials.

A step n stands for the time from n - 1/2 to n + 1/2 steps with the rods of time n in central
differences, and for the time from n - 1 to n with the rods of n - 1/2 in piecewise-exact. Over this
time the footprint slides evenly, and a rod wears to the deepest reach of the tip while its centre
is covered.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg import eigh, expm

from rom.model import Rom
from simulate.scene import LEADING, TRAILING, Scene

NEWTON_STEPS, WHOLE = 200, 10  # the first steps are whole, then half: whole ones may cycle
HALF_AT = 300.0  # liner's stiffness times the blade's compliance in a step, where w_end is 1/2


class March(NamedTuple):
    """Result of a march of the peer."""

    u_r: np.ndarray  # (m,), m, over the strips at the end
    wear: np.ndarray  # (m, nu), m
    contacts: int  # steps with contact
    out: np.ndarray | None = None  # (steps, k), m, displacements by rows in the last revolution


class Liner:
    """Strips of rods under the tip at one speed, their wear, and their forces."""

    def __init__(
        self, scene: Scene, rom: Rom, Omega: float, steps: int, sides: np.ndarray | None = None
    ) -> None:
        """``sides``: angles (2, m) of the edges behind and ahead; else the scene's footprint."""
        liner, law = scene.liner, scene.liner.law
        self.nu, self.steps, self.ramp = liner.rods_per_round, steps, scene.casing.ramp_rounds
        ends = np.linspace(0, 1, liner.m + 1)
        xi = (ends[1:] + ends[:-1]) / 2
        radius, self.theta, _ = rom.line(xi).T
        width = np.diff(rom.line(ends)[:, 2])
        pitch = 2 * np.pi * rom.camber[:, 0].mean() / self.nu
        passed = int(np.ceil(self.nu / steps))  # rods that a step may pass
        if sides is None:
            footprint = np.full(liner.m, liner.footprint_m)
        else:
            footprint, self.theta = np.diff(sides, axis=0)[0] * radius, sides.mean(axis=0)
            pitch = 2 * np.pi * radius / self.nu
        self.length = np.maximum(footprint / pitch, max(passed, 1))[:, None]  # of each, rods
        self.A = width * footprint / self.length[:, 0]
        self.l = liner.thickness_m
        self.mu, self.per_m = scene.contact.friction or 0.0, self.nu / (2 * np.pi * radius)
        self.E, self.K, self.sigma_Y = law.unit_Pa * np.array([law.E, law.K, law.sigma_Y])
        gaps = scene.clearance.gaps([LEADING, TRAILING], rom.span)
        self.g0 = gaps[0] + (gaps[1] - gaps[0]) * (xi - LEADING) / (TRAILING - LEADING)
        self.rods, self.gap = 2 * np.pi * np.arange(self.nu) / self.nu, gaps[0]
        self.harmonics, self.round_time = scene.casing.harmonics, 2 * np.pi / Omega
        self.scale, self.rods_near = scene.casing.scale, np.arange(self.nu)
        self.most = self.scale * gaps[0] * sum(abs(wave.amplitude_gaps) for wave in self.harmonics)
        self.eps_p = np.zeros((liner.m, self.nu))

    def d(self, n: float) -> np.ndarray:
        """Distortion (near,), m, at ``n`` steps from the start, where harmonics may travel."""
        d, time = np.zeros(len(self.rods_near)), n / self.steps * self.round_time
        for wave in self.harmonics:
            angle = wave.order * (self.rods[self.rods_near] - wave.speed_rpm * np.pi / 30 * time)
            d += (
                self.scale
                * wave.amplitude_gaps
                * self.gap
                * np.cos(angle + np.radians(wave.phase_deg))
            )
        return d

    def came(self, n: float) -> np.ndarray:
        """By how much d grows over the step about ``n``, (near,), m."""
        return self.d(n + 1 / 2) - self.d(n - 1 / 2)

    def share(self, n: float) -> float:
        """a at ``n`` steps from the start: a smooth step over the ramp."""
        x = min(n / self.steps / self.ramp, 1.0) if self.ramp > 0 else 1.0
        return x * x * (3 - 2 * x)

    def may_touch(
        self, away: np.ndarray, lift: np.ndarray, came: np.ndarray | float, *u_r: np.ndarray
    ) -> bool:
        """Whether a rod under the tip in the step, or beside it, could touch it at any ``u_r``."""
        beside = np.abs(away) < (self.length + 1) / 2 + self.nu / self.steps
        deepest = lift + np.abs(came) / 2 + np.max(u_r, axis=0)[:, None]
        return bool((beside & (deepest > 0)).any())

    def near(self, *u: np.ndarray, n: int) -> bool:
        """Whether the tip could be under the largest distortion of all at any of ``u``."""
        return bool(np.max(u) - self.g0.min() + self.share(n) * self.most > 0)

    def under(self, time: float, u_t: np.ndarray | float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Distance (m, near) of each rod near the tip at ``time``, in steps, in rods; and
        penetration at u_r = 0, m, Eq. (7). ``u_t``: its tangential displacement, m.
        """
        middle = self.nu * (time / self.steps + self.theta / (2 * np.pi)) + u_t * self.per_m
        beside = self.length.max() / 2 + self.nu / self.steps + 3
        low, high = int(middle.min() - beside), int(middle.max() + beside) + 1
        rods = np.arange(low, high) if high - low < self.nu else np.arange(self.nu)
        self.rods_near, away = rods % self.nu, rods - middle[:, None]
        away -= self.nu * np.round(away / self.nu)
        return away, self.share(time) * self.d(time) - self.g0[:, None]

    @property
    def strains(self) -> np.ndarray:
        """Plastic strains (m, near) of the rods near the tip."""
        return self.eps_p[:, self.rods_near]

    def part(self, away: np.ndarray) -> np.ndarray:
        """Covered part (m, near) of each rod."""
        return np.clip((self.length + 1) / 2 - np.abs(away), 0, 1)

    def middle(self, away: np.ndarray) -> np.ndarray:
        """Distance (m, near) of each rod's covered part from the tip's middle, over the length."""
        half = self.length / 2
        ends = [np.clip(away + end, -half, half) for end in (-0.5, 0.5)]
        return sum(ends) / 2 / self.length

    def shapes(self, at: np.ndarray, places: int) -> np.ndarray:
        """Hat functions (places, ...) of places across the thickness at ``at``, -1/2 to 1/2."""
        if places == 1:
            return np.ones((1, *at.shape))
        x = np.clip((at + 0.5) * (places - 1), 0, places - 1)
        return np.maximum(1 - abs(x - np.arange(places).reshape(-1, *[1] * at.ndim)), 0)

    def strain(self, lift: np.ndarray, u: np.ndarray, N: np.ndarray) -> np.ndarray:
        """Total strains (m, nu), negative where the tip is above the unworn surface, Eq. (7).

        ``u`` (places, m), m; ``N`` (places, m, nu), the shapes at the rods.
        """
        return (lift + np.einsum("pmr,pm->mr", N, u)) / self.l

    def return_map(self, eps: np.ndarray, eps_p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Stress and plastic strain at ``eps``, from ``eps_p``, Eqs. (13)-(16)."""
        trial = self.E * (np.maximum(eps, 0) - eps_p)  # Eq. (13)
        f = trial - (self.sigma_Y + self.K * eps_p)  # Eq. (10)
        gamma = np.where((trial > 0) & (f > 0), f / (self.E + self.K), 0)  # Eq. (15)
        return np.where(trial > 0, trial - self.E * gamma, 0), eps_p + gamma  # Eq. (16)

    def tangent(self, eps: np.ndarray, eps_p: np.ndarray) -> np.ndarray:
        """Slope of the stress, Pa."""
        sigma, after = self.return_map(eps, eps_p)
        yields = self.E * self.K / (self.E + self.K)
        return np.where(after > eps_p, yields, self.E) * (sigma > 0)

    def mean_stress(self, start: np.ndarray, end: np.ndarray, eps_p: np.ndarray) -> np.ndarray:
        """Mean of the stress over the strains from ``start`` to ``end``, for plastic strains eps_p.

        This is [psi(end) - psi(start)] / (end - start). The stress is linear between the strains
        at which it opens and yields: trapezoids.
        """
        opens, yields = eps_p, eps_p + (self.sigma_Y + self.K * eps_p) / self.E
        low, high = np.minimum(start, end), np.maximum(start, end)
        places = np.stack([low, np.clip(opens, low, high), np.clip(yields, low, high), high])
        stress = self.return_map(places, eps_p)[0]
        integral = (np.diff(places, axis=0) * (stress[1:] + stress[:-1]) / 2).sum(axis=0)
        moves = high > low
        return np.where(moves, integral / np.where(moves, high - low, 1), stress[-1])

    def force(self, part: np.ndarray, sigma: np.ndarray, N: np.ndarray) -> np.ndarray:
        """t_N (places, m) of Eq. (17)."""
        return self.A * (N * part * sigma).sum(axis=-1)

    def worn(
        self,
        away: np.ndarray,
        lift: np.ndarray,
        u_start: np.ndarray,
        u_end: np.ndarray,
        moved: np.ndarray | float = 0.0,
        came: np.ndarray | float = 0.0,
        until: float = 1.0,
    ) -> np.ndarray:
        """Plastic strains of the rods whose centre is covered for some of the step ``until`` then.

        At the share t of it the centre is at away - (t - 1/2) rods passed from the tip, which is at
        u_start + t (u_end - u_start), (places, m): deepest when the centre is covered first or
        last. ``moved``: tangentially in the step, m. ``came``: the casing, (nu,), m, which is at
        ``lift`` at 1/2.
        """
        passed = (self.nu / self.steps + moved * self.per_m)[:, None]
        first = np.maximum(1 / 2 + (away - self.length / 2) / passed, 0)
        last = np.minimum(1 / 2 + (away + self.length / 2) / passed, until)
        reach = []
        for t in (first, last):
            N = self.shapes((away - (t - 1 / 2) * passed) / self.length, len(u_start))
            u = [np.einsum("pmr,pm->mr", N, u) for u in (u_start, u_end - u_start)]
            reach.append(u[0] + t * u[1] + (t - 1 / 2) * came)
        eps = (lift + np.maximum(*reach)) / self.l
        worn = self.return_map(eps, self.strains)[1]
        return np.where(last > first, worn, self.strains)


def central_difference(rom: Rom, scene: Scene, Omega: float, steps: int, count: int) -> March:
    """Prediction by Eq. (19), the liner's force there, correction by Eq. (20).

    In long double: in double, the condition of M (1e6 and more) alone would shift the blade's
    frequencies by more than the comparison asks for.
    """
    liner, h = Liner(scene, rom, Omega, steps), np.longdouble(2 * np.pi / Omega / steps)
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
        away, lift = liner.under(n)
        if liner.may_touch(away, lift, 0.0, P @ u):
            flat = liner.shapes(away, 1)
            sigma, _ = liner.return_map(liner.strain(lift, (P @ u)[None], flat), liner.strains)
            (force,) = liner.force(liner.part(away), sigma, flat)
            liner.eps_p[:, liner.rods_near] = liner.worn(away, lift, (P @ u)[None], (P @ u)[None])
            contacts += bool(force.max() > 0)
            u = u - correction @ force
    return March(P @ u, liner.l * liner.eps_p, contacts)


def piecewise_exact(
    rom: Rom,
    scene: Scene,
    Omega: float,
    steps: int,
    count: int,
    P: np.ndarray | None = None,
    P_out: np.ndarray | None = None,
    sides: np.ndarray | None = None,
) -> March:
    """Exact modes under a force held over each step: a mean over it, of weight w_end its end.

    ``P`` (m, n): what closes the gaps of the strips by the model's displacements; None: u_r. Or
    (places, m, n), of places across the thickness, with ``sides`` (2, m), rad, its edges.
    ``P_out`` (k, n): rows of the displacements that are kept.
    """
    liner, h, xi = (
        Liner(scene, rom, Omega, steps, sides),
        2 * np.pi / Omega / steps,
        scene.damping_ratio,
    )
    squares, Phi = eigh(rom.stiffness(Omega), rom.M)
    P = _over_strips(rom, scene) if P is None else P
    omega, shape = np.sqrt(squares), P.reshape(-1, *P.shape[-2:]).shape[:2]
    rows = P.reshape(-1, P.shape[-1]) @ Phi
    # q and q' a step later, from both and from the rest under a force, f / omega^2
    free = np.array([expm(h * np.array([[0, 1], [-(w**2), -2 * xi * w]])) for w in omega])
    gain = np.stack([(1 - free[:, 0, 0]) / squares, -free[:, 1, 0] / squares])
    along = rom.rows((np.arange(scene.liner.m) + 0.5) / scene.liner.m, "t") @ Phi if liner.mu else 0
    pushed = rows + liner.mu * (np.tile(along, (shape[0], 1)) if liner.mu else 0)
    C = (rows * gain[0]) @ pushed.T
    # of the middle and its strips
    here = np.einsum("pmpm->m", C.reshape(*shape, *shape)) / shape[0]
    stiff = liner.E * liner.A * liner.length[:, 0] / liner.l * np.maximum(here, 0)
    w_end = stiff / (stiff + HALF_AT)
    state, contacts, kept = np.zeros((2, len(omega))), 0, []
    a, b, c, d = free.reshape(-1, 4).T
    for n in range(1, count + 1):
        before, state = (
            state[0],
            np.stack([a * state[0] + b * state[1], c * state[0] + d * state[1]]),
        )
        start, predicted = (rows @ before).reshape(shape), (rows @ state[0]).reshape(shape)
        u_t, moved = ((along @ q if liner.mu else 0.0) for q in (before, state[0] - before))
        if liner.near(start, predicted, n=n):
            away, lift = liner.under(n - 1 / 2, u_t + moved / 2)
            came = liner.share(n - 1 / 2) * liner.came(n - 1 / 2)
            if liner.may_touch(away, lift, came, *start, *predicted):
                u, force = _implicit(liner, away, lift, start, predicted, C, w_end, moved, came)
                liner.eps_p[:, liner.rods_near] = liner.worn(away, lift, start, u, moved, came)
                contacts += bool(force.sum(axis=0).max() > 0)
                state = state - gain * (pushed.T @ force.ravel())
        if P_out is not None and n > count - steps:
            kept.append(state[0])
    out = None if P_out is None else np.array(kept) @ (P_out @ Phi).T
    return March(
        (rows @ state[0]).reshape(shape).mean(axis=0), liner.l * liner.eps_p, contacts, out
    )


def _implicit(
    liner: Liner,
    away: np.ndarray,
    lift: np.ndarray,
    start: np.ndarray,
    predicted: np.ndarray,
    C: np.ndarray,
    w_end: np.ndarray,
    moved: np.ndarray | float,
    came: np.ndarray | float,
) -> tuple[np.ndarray, np.ndarray]:
    """Displacement and force (places, m) with u = predicted - C t_N(start, u), by Newton's method.

    The rods follow the curve of their state before the step, both ways; where the edge ahead is the
    deeper one it has worn them before, in the first half of the step.
    """
    part, eps_p = liner.part(away), liner.strains
    N = liner.shapes(liner.middle(away), len(start))
    if (ahead := predicted[-1] > predicted[0]).any():
        before = liner.worn(away, lift, start, predicted, moved, came, until=0.5)
        eps_p = np.where(ahead[:, None], before, eps_p)
    bear = part.any(axis=0)  # the others have no part in any force
    part, lift, eps_p, N = part[:, bear], lift[:, bear], eps_p[:, bear], N[..., bear]
    eps_0 = liner.strain(lift, start, N)
    u, share, m = predicted, w_end[:, None], len(w_end)
    strips, places = np.arange(m), np.arange(len(start))
    for step in range(NEWTON_STEPS):
        eps = liner.strain(lift, u, N)
        way, mean = eps - eps_0, liner.mean_stress(eps_0, eps, eps_p)
        sigma, tangent = liner.return_map(eps, eps_p)[0], liner.tangent(eps, eps_p)
        force = liner.force(part, share * sigma + (1 - share) * mean, N)
        moved_by = (C @ force.ravel()).reshape(u.shape)
        residual = u + moved_by - predicted
        if abs(residual).max() <= 1e-14 * (abs(predicted) + abs(moved_by)).max():
            return u, force
        far = abs(way) > 1e-6 * abs(eps)
        slope = np.where(far, (sigma - mean) / np.where(far, way, 1), tangent / 2)
        slope = part * (share * tangent + (1 - share) * slope) * (liner.A / liner.l)[:, None]
        K = np.zeros((len(places), m, len(places), m))
        K[:, strips, :, strips] = np.einsum("pmr,mr,qmr->mpq", N, slope, N)
        J = np.eye(len(C)) + C @ K.reshape(C.shape)
        change = np.linalg.solve(J, residual.ravel()).reshape(u.shape)
        u = u - (change if step < WHOLE else change / 2)
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
