"""The implicit forces satisfy their equations, on random interfaces and rods."""

from typing import NamedTuple

import numpy as np
import pytest
from systems import Parameters, strips

from simulate.contact.compiled import for_types_of
from simulate.contact.interface_force import new_solver, solve
from simulate.contact.rods import nothing_covered
from simulate.marching.friction import solve_sliding

ROUND_OFF = 2e-12  # of displacements that cancel: 20 times the solver's tolerance; 1.5e-12 seen


class Interface(NamedTuple):
    """Nodes on their rods, of unit area and thickness, with the displacements without forces."""

    law: Parameters
    depth: np.ndarray  # (nodes, m)
    eps_p: np.ndarray  # (nodes, m), at the start of the step
    C: np.ndarray  # (nodes, nodes)
    v: np.ndarray  # (nodes,)
    top: np.ndarray  # (nodes,), inf where no casing is met
    start: np.ndarray  # (nodes, m), strains at the start of the step
    w_end: float  # weight of the end of the step in the force
    slides: bool = False  # by the solver for an unsymmetric C, of a tip that slides

    def solve(self, guess=0.0, v=None):
        """w, F and whether they were solved."""
        nodes, m = self.depth.shape
        rigid_from = 0.0 if np.isfinite(self.top).any() else np.inf
        system = strips(self.law, np.zeros(nodes), np.zeros(m), length=m, rigid_from=rigid_from)
        solver, covered = new_solver(nodes), nothing_covered(system)
        at, rods = solver.unknowns, covered.rods[:, :m]
        covered.strips["high"] = m
        at["strip"] = at["row"] = np.arange(nodes)
        at["v"], solver.C[:] = self.v if v is None else v, self.C
        at["top"], solver.F[:] = self.top, guess
        rods["delta_0"], rods["eps_p"], rods["part"] = self.depth, self.eps_p, 1
        rods["start"] = self.start
        rods["sigma"], _, rods["after"] = self.stress(self.start)
        system = system._replace(w_end=np.full(nodes, self.w_end))
        arguments, of = (system, covered, solver, nodes), solve
        if self.slides:
            soft = np.full(nodes, 1 / (self.law.E * m))
            arguments, of = (system, covered, soft, solver, nodes), solve_sliding
        return at["w"], solver.F, for_types_of(of.outer, *arguments)(*arguments)

    def stress(self, eps):
        """Stress, slope, plastic strain at the strains ``eps`` (nodes, m), by Eqs. (13)-(16)."""
        E, K, sigma_Y = self.law
        trial = E * (np.maximum(eps, 0) - self.eps_p)
        f = trial - (sigma_Y + K * self.eps_p)
        after = self.eps_p + np.maximum(f, 0) / max(E + K, 1e-300)
        sigma = np.where(f > 0, sigma_Y + K * after, trial)
        slope = np.where(f > 0, E * K / max(E + K, 1e-300), E) * (trial > 0)
        return np.where(trial > 0, sigma, 0), slope, after

    def borne(self, w):
        """Forces of the rods on the way to ``w``, means with w_end of the end; their slopes.

        Trapezoids between the strains at which the stress begins and yields.
        """
        E, K, sigma_Y = self.law
        yields = self.eps_p + (sigma_Y + K * self.eps_p) / max(E, 1e-300)
        eps = self.depth + w[:, None]
        low, high = np.minimum(self.start, eps), np.maximum(self.start, eps)
        kinks = [np.clip(at, low, high) for at in (self.eps_p, yields)]
        places = np.stack([low, *kinks, high])
        at = np.stack([self.stress(place)[0] for place in places])
        (sigma, tangent, _), way = self.stress(eps), np.maximum(high - low, 1e-300)
        mean = (np.diff(places, axis=0) * (at[1:] + at[:-1]) / 2).sum(axis=0) / way
        slope = np.abs(sigma - mean) / way
        mean, slope = np.where(high > low, [mean, slope], [sigma, tangent / 2])
        force, slope = (
            self.w_end * end + (1 - self.w_end) * over
            for end, over in ((sigma, mean), (tangent, slope))
        )
        return force.sum(1), slope.sum(1)

    def scale(self, F):
        """Displacements that add up to those of every node."""
        return abs(self.v) + abs(self.C) @ F + abs(self.depth).max(1) + abs(self.start).max(1)


def compliance(rng, nodes, condition):
    """Random positive definite, or like that of a slender edge, with correlated neighbours."""
    if rng.random() < 0.5:
        x = np.linspace(0, 1, nodes)
        C = np.exp(-(((x[:, None] - x) / rng.uniform(0.1, 3)) ** 2)) + np.eye(nodes) / condition
    else:
        Q, _ = np.linalg.qr(rng.normal(size=(nodes, nodes)))
        C = (Q * condition ** -rng.uniform(0, 1, nodes)) @ Q.T
    apart = 10 ** rng.uniform(-1, 1, nodes)
    return (C + C.T) / 2 * np.outer(apart, apart)


def interface(seed, condition=None, stiffness=None, casing=None):
    """A random interface: ``stiffness`` of the rods times the compliance, ``casing`` behind them.

    E = 0 is the rigid law: rods without stress before the casing. Half of the interfaces take the
    force at the end of the step, the others a mean force from rods that bear, or do not, before.
    """
    rng = np.random.default_rng(seed)
    nodes, m = rng.integers(1, 17), rng.integers(1, 9)
    condition = condition or 10 ** rng.uniform(0, 8)
    stiffness = stiffness if stiffness is not None else 10 ** rng.uniform(-12, 12)
    E, shape = stiffness / m, (nodes, m)
    law = Parameters(E, E * rng.choice([0, 1e-3, 0.5, 10, 1e6]), E * rng.choice([0, 1e-3, 0.1, 1]))
    behind = rng.random() < 0.5 if casing is None else casing
    depth = rng.normal(size=shape) * rng.choice([0.01, 0.3, 1])
    eps_p = rng.integers(0, 2, shape) * rng.uniform(0, 0.5, shape)
    C = compliance(rng, nodes, condition)
    v = rng.normal(size=nodes) * rng.choice([0.1, 1, 10]) + rng.choice([0, 1])
    top = rng.uniform(-0.5, 1, nodes) if behind else np.full(nodes, np.inf)
    start = depth + v[:, None] + rng.normal(size=(nodes, 1)) * rng.choice([1e-9, 1e-3, 1])
    w_end = rng.choice([0, 1e-6, 0.1, 1, 1, 1])
    return Interface(law, depth, eps_p, C, v, top, start, w_end)


def assert_solved(system, guess=0.0):
    """w = v - C F, no tension, and F is that of the rods or of the casing at w, to round-off.

    The displacement of a blade that forces do not move is exact; a casing without a liner bears
    only where it is met. Returns w and F.
    """
    w, F, solved = system.solve(guess)
    assert solved, system
    scale = system.scale(F)
    assert (F >= 0).all()
    assert (abs(w - (system.v - system.C @ F)) <= ROUND_OFF * scale).all()
    assert (w <= system.top + ROUND_OFF * scale).all()
    assert system.C.any() or (w == system.v).all()
    below, above = (system.borne(w + side * ROUND_OFF * scale)[0] for side in (-1, 1))
    at_casing = w >= system.top - ROUND_OFF * scale
    assert (below * (1 - 1e-12) <= F).all()  # the forces' own round-off, where rods are soft
    assert ((above * (1 + 1e-12) >= F) | at_casing).all()
    assert (at_casing | (F == 0)).all() or system.law.E > 0
    return w, F


@pytest.mark.parametrize("casing", [False, True])
@pytest.mark.parametrize("decade", range(-12, 13, 3))
def test_forces_are_those_of_the_rods_where_they_leave_the_nodes(decade, casing):
    """Stiffness times compliance over 24 decades, condition numbers to 1e8."""
    for seed in range(60):
        assert_solved(interface([seed, decade + 12], stiffness=10.0**decade, casing=casing))


def worn_deep(seed):
    """Rods worn far deeper than the blade moves: the force changes with round-off of the depth."""
    system = interface(seed, condition=1e3, stiffness=1.0, casing=False)
    moves = 10.0 ** np.random.default_rng(seed).uniform(-9, -6)
    depth = 0.3 + 0.1 * moves * np.arange(system.depth.size).reshape(system.depth.shape)
    worn = depth - moves * np.random.default_rng(seed).uniform(0, 1, depth.shape)
    start = depth + moves * (system.start - system.depth)
    return system._replace(v=moves * system.v, depth=depth, eps_p=worn, start=start)


def rigid_blade(seed):
    system = interface(seed, casing=False)
    return system._replace(C=np.zeros_like(system.C))


SPECIAL = {
    "a rigid casing without a liner": lambda seed: interface(seed, stiffness=0.0, casing=True),
    "rods worn far deeper than the blade moves": worn_deep,
    "a rigid blade": rigid_blade,
}


@pytest.mark.parametrize("name", SPECIAL)
def test_forces_of_special_interfaces_are_those_of_their_rods(name):
    for seed in range(200):
        assert_solved(SPECIAL[name](seed))
        assert_solved(SPECIAL[name](seed), guess=1.0)


def from_another_guess(system, seed):
    """How far the displacements from another first guess are off, and what adds up to them."""
    w, F, _ = system.solve()
    rng = np.random.default_rng(seed)
    guess = rng.uniform(0, 1, len(F)) * rng.choice([1e-3, 1.0, 1e3]) * (1 + F.max())
    return abs(assert_solved(system, guess)[0] - w), system.scale(F)


def test_the_first_guess_does_not_matter():
    """Unique, as C is positive; a change of w by round-off is one of 1/condition in F."""
    for seed in range(200):
        off, scale = from_another_guess(interface(seed, condition=1e3), seed)
        # of 16 nodes, each off by the tolerance
        assert (off <= 1e-10 * scale).all(), seed


def test_forces_grow_with_the_forecast():
    """(F - F').(v - v') >= (F - F').C (F - F'): monotone, as the rods' forces are."""
    for seed in range(200):
        system = interface(seed, condition=1e3)
        v = system.v + np.random.default_rng(seed).normal(size=len(system.v))
        _, F, _ = system.solve()
        _, F_other, _ = system.solve(v=v)
        change = F - F_other
        left, right = change @ (system.v - v), change @ system.C @ change
        round_off = 1e-11 * abs(change) @ (system.scale(F) + system.scale(F_other))
        assert left >= right - round_off, seed


def plain_newton(system, steps=50):
    """Whether Newton's method on w - v + C F(w) = 0 from w = v ends."""
    w = system.v.copy()
    for _ in range(steps):
        force, slope = system.borne(w)
        residual = w - system.v + system.C @ force
        if (abs(residual) <= 1e-9 * system.scale(force)).all():
            return True
        w = w - np.linalg.solve(np.eye(len(w)) + system.C * slope, residual)
    return False


def test_forces_are_solved_where_plain_newton_cycles():
    """Onset and yield make the force neither convex nor smooth: a quarter of these cases cycle."""
    made = [interface(seed, condition=1e4, stiffness=1e3, casing=False) for seed in range(300)]
    cycling = [system for system in made if not plain_newton(system)]
    assert len(cycling) > 30
    for system in cycling:
        assert_solved(system)
