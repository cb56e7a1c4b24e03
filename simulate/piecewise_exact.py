"""Exact modes under a force that is constant over each step and found implicitly at its end.

After Nigam and Jennings 1969. With omega_d = omega sqrt(1 - xi^2), e = exp(-xi omega h), c and s
the cosine and sine of omega_d h, a free mode turns and shrinks in

    x = q,    y = (q' + xi omega q) / omega_d:    x+ = e (c x + s y),    y+ = e (c y - s x)

and a modal force f held over the step adds g f to x and g' f to y,

    g = (1 - e (c + xi omega s/omega_d)) / omega^2,    g' = (e s/omega_d + xi omega g) / omega_d.

The force is that of the liner at the end of the step, u+ = u_p - C F(u+), C = Phi_b diag(g)
Phi_b^T. It grows with the penetration, so over a step it takes at least the energy that the liner
receives: psi(u+) - psi(u) <= F (u+ - u) for a convex psi. In contact the scheme never creates
energy, whatever the step, E and K; free, it is exact.
"""

from functools import cache
from math import ceil, floor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulate.compiled import compiled, compiled_sums
from simulate.contact import contact_functions, offset, profile_at
from simulate.interface_force import ACTIVE, APART, MET, force_finder
from simulate.law import Law
from simulate.ledger import CASING, WORK
from simulate.modal import Motion, Scheme, scheme_arrays


def coefficients(
    omega: NDArray[np.float64], Phi_b: NDArray[np.float64], xi: float, h: float
) -> Scheme:
    """Coefficients for modes ``omega`` (n,), rad/s, and step ``h``, s.

    Parameters
    ----------
    Phi_b : (rows, n)
        Interface rows of the M-normalised modes.
    """
    omega_d = omega * np.sqrt(1 - xi**2)
    e, c, s = np.exp(-xi * omega * h), np.cos(omega_d * h), np.sin(omega_d * h)
    # 1 - e (c + ...) without its cancellation at small omega h
    g = (-np.expm1(-xi * omega * h) + 2 * e * np.sin(omega_d * h / 2) ** 2) / omega**2
    g -= xi * e * s / (omega * omega_d)
    return scheme_arrays(
        a=e * c,
        b=e * s,
        loss=_losses(omega, omega_d, xi, h),
        gain=np.array(
            [g, (e * s / omega_d + xi * omega * g) / omega_d, 1 / omega**2, xi / omega / omega_d]
        ),
        Phi_b=Phi_b,
    )


def _losses(
    omega: NDArray[np.float64], omega_d: NDArray[np.float64], xi: float, h: float
) -> NDArray[np.float64]:
    """Integral of 2 xi omega q'^2 over a free step as a form in x^2, x y, y^2 of its start.

    q' = e^(-xi omega t) Re[(omega_d y - xi omega x - i(...)) ...]: from the integrals of e^(-2 xi
    omega t) times 1, cos 2 omega_d t and sin 2 omega_d t.
    """
    r = 2 * xi * omega
    one = -np.expm1(-r * h) / r if xi > 0 else np.full_like(omega, h)
    turn = (np.expm1(complex(0, 2) * omega_d * h - r * h)) / (complex(0, 2) * omega_d - r)
    cos2, sin2 = turn.real, turn.imag
    cc, ss, cs = (one + cos2) / 2, (one - cos2) / 2, sin2 / 2
    # q' = e^(-xi omega t) [(omega_d y - xi omega x) cos - (omega_d x + xi omega y) sin]
    k, d = xi * omega, omega_d
    return r * np.array(
        [
            k**2 * cc + d**2 * ss + 2 * k * d * cs,
            -2 * k * d * cc + 2 * k * d * ss + 2 * (k**2 - d**2) * cs,
            d**2 * cc + k**2 * ss - 2 * k * d * cs,
        ]
    )


def energy(omega: NDArray[np.float64], xi: float, h: float, motion: Motion, now: int) -> float:
    """Kinetic and elastic energy of the blade, J."""
    x, y = motion.x[now, : omega.size], motion.y[now, : omega.size]
    v = omega * np.sqrt(1 - xi**2) * y - xi * omega * x
    return float(v @ v + (omega * x) @ (omega * x)) / 2


@compiled_sums
def loss_from(scheme, k, p, r):
    """Damping loss, J, of mode ``k`` over a free step from x = ``p``, y = ``r``."""
    loss = scheme.loss
    return (loss[0, k] * p + loss[1, k] * r) * p + loss[2, k] * r * r


@compiled_sums
def advance(scheme, x, y, k, now, last, before):
    """Free motion of mode ``k`` to turn ``now``; returns the damping loss of the step, J."""
    p, r = x[last, k], y[last, k]
    x[now, k] = scheme.a[k] * p + scheme.b[k] * r
    y[now, k] = scheme.a[k] * r - scheme.b[k] * p
    return loss_from(scheme, k, p, r)


@compiled_sums
def correct(scheme, x, y, modal, now, last, before):
    """Add what the modal force (n,), N, does in the step; returns the damping loss, J."""
    gain = scheme.gain
    lost = 0.0
    for k in range(modal.size):
        f = modal[k]
        x[now, k] -= gain[0, k] * f
        y[now, k] -= gain[1, k] * f
        # about the displacement that the force would hold
        lost += loss_from(scheme, k, x[last, k] + gain[2, k] * f, y[last, k] + gain[3, k] * f)
    return lost


@cache
def contact_step(law: type[Law], profile: bool, tangential: bool, rigid: bool, ledger: bool) -> Any:
    """Force of the liner at the end of the step, compiled for a law and a tip."""
    cover, bearing, press = contact_functions(law, profile, tangential, ledger)
    solve = force_finder(law, profile, tangential)

    @compiled
    def lift_at(strips, covered, i, k, s):
        """Lift of the tip ``s`` (m) from the camber line above rod ``k`` of its window, m."""
        d = strips.d[(covered.at[i] + k) % strips.d.size]
        return covered.share[i] * d - strips.g0[i] - profile_at(strips.tip, s)[0]

    @compiled
    def lift_of_casing(strips, covered, i):
        """Lift of the rigid casing at strip ``i``, m: a line, over its rods and their neighbours.

        As a stair at each rod, met within a step, it would hit the harder the shorter the step.
        """
        node, half = -offset(strips, 0, covered.passed[i]), strips.length / 2
        first, last = ceil(node - half), floor(node + half)
        behind = lift_at(strips, covered, i, first - 1, -strips.tip.half)
        ahead = lift_at(strips, covered, i, last + 1, strips.tip.half)
        line = -np.inf
        for k in range(first, last + 1):
            s = strips.pitch[i] * (k - node)
            line = max(line, lift_at(strips, covered, i, k, s))
        part = first - (node - half)
        inside = lift_at(strips, covered, i, first, -strips.tip.half)
        line = max(line, part * behind + (1 - part) * inside)
        part = node + half - last
        inside = lift_at(strips, covered, i, last, strips.tip.half)
        return max(line, part * ahead + (1 - part) * inside)

    @compiled
    def meet(strips, covered, eps_p, solver, u, i, step, a, now, last, books):
        """Find the rods of strip ``i`` under the tip."""
        across = u.shape[1] // 2
        u_t = u_t_before = 0.0
        if tangential:
            u_t, u_t_before = u[now, across + i], u[last, across + i]
        cover(strips, covered, eps_p, i, step, a, u[last, i], u_t, u_t_before, books)
        solver.state[i] = MET
        if rigid:
            solver.casing[i] = lift_of_casing(strips, covered, i)

    @compiled
    def admit(strips, covered, solver, i, count, w, v):
        """Take strip ``i`` as active if it bears at ``w``; ``v`` is its forecast without force."""
        force, along, _ = bearing(strips, covered, i, w)
        top = strips.rigid_from - solver.casing[i] if rigid else np.inf
        if force == 0.0 and w <= top:
            return count
        solver.state[i], solver.active[count] = ACTIVE, i
        solver.v[count], solver.F[count], solver.top[count] = v, solver.last[i], top
        solver.tau[count] = along / force if tangential and force > 0.0 else 0.0
        return count + 1

    @compiled
    def couple(C, solver, count):
        """Compliance between the active strips, along their normals."""
        across = C.shape[0] // 2
        for p in range(count):
            i = solver.active[p]
            for q in range(count):
                j = solver.active[q]
                c = C[i, j]
                if tangential:
                    c += solver.tau[q] * C[i, across + j] + solver.tau[p] * C[across + i, j]
                    c += solver.tau[p] * solver.tau[q] * C[across + i, across + j]
                solver.C[p, q] = c

    @compiled
    def displace(C, solver, count, force, moved):
        """Forces of the active strips on their rows, and the displacement of all rows by them."""
        across = C.shape[0] // 2
        moved[:] = 0.0
        for p in range(count):
            i = solver.active[p]
            force[i] = solver.F[p]
            for row in range(moved.size):
                moved[row] += C[i, row] * force[i]
            if tangential:
                force[across + i] = solver.tau[p] * solver.F[p]
                for row in range(moved.size):
                    moved[row] += C[across + i, row] * force[across + i]

    @compiled
    def find_force(
        scheme, strips, covered, solver, motion, eps_p, safe, step, a, now, last, before, books
    ):
        """Fill ``motion.force``, move ``motion.u`` to the end of the step, wear the liner, book.

        Returns
        -------
        bool, float, int
            Whether any strip bears; deepest penetration, m, and its strip.
        """
        u, force, moved, C = motion.u, motion.force, motion.moved, scheme.C
        nodes = strips.g0.size
        force[:] = 0.0
        moved[:] = 0.0
        solver.state[:] = APART
        # a literal 0 would have all that takes it compiled once more, for the literal
        count, solved = np.int64(0), False
        for i in range(nodes):
            if u[now, i] > safe[i] or covered.loaded[i] > 0.0:
                meet(strips, covered, eps_p, solver, u, i, step, a, now, last, books)
                count = admit(strips, covered, solver, i, count, u[now, i], u[now, i])
        while count > 0 and not solved:
            couple(C, solver, count)
            if not solve(strips, covered, solver, count):
                solver.unsolved[0] += 1
            displace(C, solver, count, force, moved)
            solved = True
            for i in range(nodes):  # a force on one strip may lift the tip at another
                w = u[now, i] - moved[i]
                if solver.state[i] != ACTIVE and w > safe[i]:
                    if solver.state[i] == APART:
                        meet(strips, covered, eps_p, solver, u, i, step, a, now, last, books)
                    more = admit(strips, covered, solver, i, count, w, u[now, i])
                    solved = solved and more == count
                    count = more
        deepest, where, touched = 0.0, 0, False
        for row in range(u.shape[1]):
            u[now, row] -= moved[row]
        for p in range(count):
            i, w = solver.active[p], solver.w[p]
            borne, _, depth = press(strips, covered, eps_p, i, w, u[last, i], books)
            touched |= solver.F[p] > 0.0
            if ledger and rigid:  # what the casing itself pushes, by the way that it came
                reaction, way = max(solver.F[p] - borne, 0.0), u[last, i] - solver.top[p]
                # it may give way, too, before a strip that it held; before another it was away
                if way > 0.0 or solver.held[i] > 0.0:
                    books[CASING] += reaction * way
                solver.held[i] = reaction
            if depth > deepest:
                deepest, where = depth, i
        for i in range(nodes):
            if solver.state[i] == MET:
                press(strips, covered, eps_p, i, u[now, i], u[last, i], books)
        for i in range(nodes):
            solver.last[i] = force[i]
            if rigid and solver.state[i] != ACTIVE:
                solver.held[i] = 0.0
        if ledger:
            for row in range(u.shape[1]):
                books[WORK] -= force[row] * (u[now, row] - u[last, row])
        return touched, deepest, where

    return find_force
