"""Exact modes under a force that is constant over each step and found implicitly at its end.

After Nigam and Jennings 1969. With omega_d = omega sqrt(1 - zeta^2), e = exp(-zeta omega h), c and
s the cosine and sine of omega_d h, a free mode rotates and decays in

    x = q,    y = (q' + zeta omega q) / omega_d:    x+ = e (c x + s y),    y+ = e (c y - s x)

and a modal force f of F^c, on the left of Eq. (1), takes g f from x and g' f from y,

    g = (1 - e (c + zeta omega s/omega_d)) / omega^2,   g' = (e s/omega_d + zeta omega g) / omega_d.

The rods are those under the tip in the middle of the step, and the force is a mean over the way of
the blade (``contact.rods``), u+ = u_p - C F(u, u+), C = Phi_b diag(g) Phi_b^T: of order two in
the step. It grows with the penetration, so over a step it takes at least the energy that the liner
receives: F (u+ - u) >= psi(u+) - psi(u) for a convex psi. In contact the scheme never creates
energy, whatever the step, E and K; free, it is exact. A rigid casing is met at the end of the step.
"""

from math import ceil, floor

import numpy as np
from numpy.typing import NDArray

from simulate.contact.compiled import FIRST, compiled, compiled_sums
from simulate.contact.interface_force import ACTIVE, APART, DETECTED, solve
from simulate.contact.ledger import CASING, WORK
from simulate.contact.rods import contact_force, cover, in_contact, press, widen
from simulate.contact.strips import closest, lean_at, offset, profile_at
from simulate.marching.modal import Motion, Scheme, scheme_arrays
from simulate.scene.damping import Ratios

STIFF = (
    300.0  # stiffness of the liner times compliance of the blade in a step at which w_end is 1/2
)


def coefficients(
    omega: NDArray[np.float64],
    Phi_b: NDArray[np.float64],
    zeta: Ratios,
    h: float,
) -> Scheme:
    """Coefficients for modes ``omega`` (n,), rad/s, and step ``h``, s.

    Parameters
    ----------
    Phi_b : (rows, n)
        Interface rows of the M-normalised modes.
    zeta : damping ratio of all modes, or of each (n,)
    """
    omega_d = omega * np.sqrt(1 - zeta**2)
    e, c, s = np.exp(-zeta * omega * h), np.cos(omega_d * h), np.sin(omega_d * h)
    g = gain(omega, zeta, h)
    return scheme_arrays(
        a=e * c,
        b=e * s,
        loss=_losses(omega, omega_d, zeta, h),
        gain=np.array(
            [
                g,
                (e * s / omega_d + zeta * omega * g) / omega_d,
                1 / omega**2,
                zeta / omega / omega_d,
            ]
        ),
        Phi_b=Phi_b,
        functions=(advance, correct, find_force, held_forces),
    )


def gain(omega: NDArray[np.float64], zeta: Ratios, h: float) -> NDArray[np.float64]:
    """G (n,): displacement of modes ``omega`` (rad/s) in a step ``h`` (s) by a modal force of 1."""
    omega_d = omega * np.sqrt(1 - zeta**2)
    e, s = np.exp(-zeta * omega * h), np.sin(omega_d * h)
    # 1 - e (c + ...) without its cancellation at small omega h
    g = (-np.expm1(-zeta * omega * h) + 2 * e * np.sin(omega_d * h / 2) ** 2) / omega**2
    return g - zeta * e * s / (omega * omega_d)


def share_of_end(stiffness: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weight w_end (strips,) of the end of a step in its force.

    ``stiffness`` of the strips times the compliance of the blade there in a step: of order two in
    the step. So it is small where the step resolves the motion in contact, and nears 1, at which
    the scheme damps unresolved motion, where the liner is too stiff for the step.
    """
    return 1 - STIFF / (stiffness + STIFF)  # 1 for a rigid law


def stiffness_in_a_step(w_end: NDArray[np.float64]) -> NDArray[np.float64]:
    """Stiffness of the strips times the compliance of the blade in a step, from ``w_end``."""
    with np.errstate(divide="ignore"):
        return STIFF * w_end / (1 - w_end)  # inf for a rigid law


def _losses(
    omega: NDArray[np.float64],
    omega_d: NDArray[np.float64],
    zeta: Ratios,
    h: float,
) -> NDArray[np.float64]:
    """Integral of 2 zeta omega q'^2 over a free step as a form in x^2, x y, y^2 of its start.

    From the integrals of e^(-2 zeta omega t) times 1, cos 2 omega_d t and sin 2 omega_d t.
    """
    r = 2 * zeta * omega
    one = np.divide(-np.expm1(-r * h), r, out=np.full_like(omega, h), where=r != 0)
    turn = (np.expm1(complex(0, 2) * omega_d * h - r * h)) / (complex(0, 2) * omega_d - r)
    cos2, sin2 = turn.real, turn.imag
    cc, ss, cs = (one + cos2) / 2, (one - cos2) / 2, sin2 / 2
    # q' = e^(-zeta omega t) [(omega_d y - zeta omega x) cos - (omega_d x + zeta omega y) sin]
    k, d = zeta * omega, omega_d
    return r * np.array(
        [
            k**2 * cc + d**2 * ss + 2 * k * d * cs,
            -2 * k * d * cc + 2 * k * d * ss + 2 * (k**2 - d**2) * cs,
            d**2 * cc + k**2 * ss - 2 * k * d * cs,
        ]
    )


def motion_of(
    omega: NDArray[np.float64],
    zeta: Ratios,
    h: float,
    x: NDArray[np.float64],
    y: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Modal displacements and velocities (n,) after the first of the steps ``x``, ``y`` (2, n)."""
    return x[0], omega * np.sqrt(1 - zeta**2) * y[0] - zeta * omega * x[0]


def turns_of(
    omega: NDArray[np.float64],
    zeta: Ratios,
    h: float,
    q: NDArray[np.float64],
    v: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Steps x and y (2, n) from displacements and velocities: the second is not looked at."""
    y = (v + zeta * omega * q) / (omega * np.sqrt(1 - zeta**2))
    return np.array([q, q]), np.array([y, y])


def energy(omega: NDArray[np.float64], zeta: Ratios, h: float, motion: Motion, now: int) -> float:
    """Kinetic and elastic energy of the blade, J."""
    x, v = motion_of(omega, zeta, h, motion.x[[now], : omega.size], motion.y[[now], : omega.size])
    return float(v @ v + (omega * x) @ (omega * x)) / 2


@compiled_sums
def loss_from(scheme, k, x0, y0):
    """Damping loss, J, of mode ``k`` over a free step from ``x0``, ``y0``."""
    loss = scheme.loss
    return (loss[0, k] * x0 + loss[1, k] * y0) * x0 + loss[2, k] * y0 * y0


@compiled_sums
def advance(scheme, x, y, k, now, last, before):
    """Free motion of mode ``k`` to turn ``now``; returns the damping loss of the step, J."""
    x0, y0 = x[last, k], y[last, k]
    x[now, k] = scheme.a[k] * x0 + scheme.b[k] * y0
    y[now, k] = scheme.a[k] * y0 - scheme.b[k] * x0
    return loss_from(scheme, k, x0, y0)


@compiled_sums
def correct(scheme, x, y, modal, now, last, before):
    """Add the effect of the modal force (n,), N, in the step; returns the damping loss, J."""
    gain = scheme.gain
    lost = 0.0
    for k in range(modal.size):
        f = modal[k]
        x[now, k] -= gain[0, k] * f
        y[now, k] -= gain[1, k] * f
        # the loss is that of the free motion about the static displacement under the force
        lost += loss_from(scheme, k, x[last, k] + gain[2, k] * f, y[last, k] + gain[3, k] * f)
    return lost


@compiled
def casing_at(strips, covered, i, a, k, s):
    """Penetration (m) at w = 0 of the tip at ``s`` (m) above rod ``k`` of the window, unworn."""
    d = strips.d_end[(covered.strips[i].at + k) % strips.d.size]
    return a * d - strips.g0[i] - profile_at(strips.tip, i, s)[0]


@compiled
def casing_between(strips, covered, i, a, x, s):
    """As ``casing_at``, linear between the rods on both sides of the place ``x``, rods."""
    k = floor(x)
    part = x - k
    behind = casing_at(strips, covered, i, a, k, s)
    return (1 - part) * behind + part * casing_at(strips, covered, i, a, k + 1, s)


@compiled
def casing_under(strips, covered, i, a):
    """Penetration (m) at w = 0 into the rigid casing at strip ``i``.

    The highest rigid surface under the footprint, linear between rods at its ends: a surface that
    is constant over each rod would jump within a step, and impact the harder the shorter the step.
    """
    strip, half, end = covered.strips[i], strips.length[i] / 2, strips.tip.half[i]
    centre = (1 - strips.placed) * strip.slid - offset(strips, FIRST, strip.passed)
    line = casing_between(strips, covered, i, a, centre - half, -end)
    line = max(line, casing_between(strips, covered, i, a, centre + half, end))
    for k in range(ceil(centre - half), floor(centre + half) + 1):
        s = strips.pitch[i] * (k - centre)
        line = max(line, casing_at(strips, covered, i, a, k, s))
    return line


@compiled
def detect(strips, state, step, i):
    """Find the rods of strip ``i`` under the tip."""
    u, covered, first_t = state.motion.u, state.covered, strips.first_t
    u_t = u_t_before = 0.0
    if strips.tangential:
        u_t, u_t_before = u[step.now, first_t + i], u[step.last, first_t + i]
    w_before, w = u[step.last, i], u[step.now, i]
    lean_before, lean = lean_at(strips, u, step.last, i), lean_at(strips, u, step.now, i)
    eps_p, energies = state.eps_p, state.energies
    cover(
        strips, covered, eps_p, i, step, w_before, w, lean_before, lean, u_t, u_t_before, True,
        energies,
    )  # fmt: skip
    state.solver.strips[i].state = DETECTED
    if strips.rigid_depth < np.inf:
        state.solver.strips[i].casing = casing_under(strips, covered, i, step.a_end)


@compiled
def activate(strips, state, step, count):
    """Find the rods of strips near the tip, and take those strips as active that bear.

    The tip is where the forces of the ``count`` active strips leave it: it may be lifted onto more.
    Returns how many are active then.
    """
    motion, solver, covered = state.motion, state.solver, state.covered
    rows = len(strips.rows)
    for i in range(strips.g0.size):
        forecast, at_strip = motion.u[step.now, i], solver.strips[i]
        w, lean_before = forecast - motion.moved[i], lean_at(strips, motion.u, step.last, i)
        forecast_lean = lean_at(strips, motion.u, step.now, i)
        lean = forecast_lean - motion.moved[strips.first_lean + i] if rows == 2 else 0.0
        near = closest(strips, w, lean) > motion.free[i] or (
            at_strip.state == APART
            and (
                closest(strips, motion.u[step.last, i], lean_before) > motion.free[i]
                or covered.strips[i].stored > 0.0
            )
        )
        if at_strip.state == ACTIVE or not near:
            continue
        if at_strip.state == APART:
            detect(strips, state, step, i)
        top, t_N, t_T = strips.rigid_depth - at_strip.casing, 1.0, 0.0
        if strips.tangential:
            t_N, t_T = contact_force(strips, covered, np.uint64(i), w, lean)[:2]
        if w > top or (t_N != 0.0 and in_contact(strips, covered, i, w, lean)):
            at_strip.state = ACTIVE
            unknown = solver.unknowns[rows * count]
            unknown.strip, unknown.row, unknown.v, unknown.top = i, i, forecast, top
            unknown.tau = t_T / t_N if strips.tangential and t_N > 0.0 else 0.0
            solver.F[rows * count] = at_strip.F
            if rows == 2:
                of_lean = solver.unknowns[rows * count + 1]
                of_lean.strip, of_lean.row, of_lean.tau = i, strips.first_lean + i, 0.0
                of_lean.v = forecast_lean
                solver.F[rows * count + 1] = at_strip.moment
            count += 1
    return count


@compiled
def widen_reached(strips, state, step, count):
    """Widen the reach of strips that forces lift beyond it; whether there are any."""
    u, covered, solver, wider = state.motion.u, state.covered, state.solver, False
    if len(strips.rows) == 2:  # all rods are
        return wider
    for p in range(count):
        unknown = solver.unknowns[p]
        if unknown.w > covered.strips[unknown.strip].reach:
            i, wider = np.int64(unknown.strip), True
            widen(strips, covered, state.eps_p, i, u[step.last, i], u[step.now, i], 0.0, 0.0)
    for i in range(strips.g0.size):
        w = u[step.now, i] - state.motion.moved[i]
        if solver.strips[i].state == DETECTED and w > covered.strips[i].reach:
            widen(strips, covered, state.eps_p, i, u[step.last, i], u[step.now, i], 0.0, 0.0)
    return wider


@compiled
def couple(C, strips, solver, count, tangential):
    """Compliance between the active strips, along their normals."""
    first_t, n = np.uint64(strips.first_t), count * len(strips.rows)
    for p in range(n):
        i, tau_i = solver.unknowns[p].row, solver.unknowns[p].tau
        along_i = first_t + solver.unknowns[p].strip
        for q in range(n):
            j, tau_j = solver.unknowns[q].row, solver.unknowns[q].tau
            c = C[i, j]
            if tangential:
                along_j = first_t + solver.unknowns[q].strip
                c += tau_j * C[i, along_j] + tau_i * C[along_i, j]
                c += tau_i * tau_j * C[along_i, along_j]
            solver.C[p, q] = c


@compiled
def displace(C, strips, solver, count, motion):
    """Forces of the active strips on their rows, and the displacement of all rows by them."""
    force, moved, first_t = motion.force, motion.moved, np.uint64(strips.first_t)
    moved[:] = 0.0
    for p in range(count * len(strips.rows)):
        unknown, F = solver.unknowns[p], solver.F[p]
        i = unknown.row
        force[i] = F
        for row in range(moved.size):
            moved[row] += C[i, row] * F
        if strips.tangential and i == unknown.strip:
            t_T = unknown.tau * F
            force[first_t + i] = t_T
            for row in range(moved.size):
                moved[row] += C[first_t + i, row] * t_T


@compiled
def press_detected(strips, state, step, count):
    """Wear the liner under all strips that the tip met, and book the work of the casing.

    Nothing is known then of the strips of the next step but the forces of this one.

    Returns
    -------
    bool, float, int
        Whether any strip bears; deepest penetration, m, and its strip.
    """
    u, solver, rigid = state.motion.u, state.solver, strips.rigid_depth < np.inf
    covered, eps_p, energies = state.covered, state.eps_p, state.energies
    deepest, where, touched, rows = 0.0, 0, False, len(strips.rows)
    for p in range(count):
        unknown = solver.unknowns[rows * p]
        i, w_before = np.int64(unknown.strip), u[step.last, unknown.strip]
        lean = solver.unknowns[rows * p + 1].w if rows == 2 else 0.0
        lean_before = lean_at(strips, u, step.last, i)
        borne, _, _, depth = press(
            strips, covered, eps_p, i, unknown.w, w_before, lean, lean_before, energies
        )
        touched |= solver.F[rows * p] > 0.0
        if rigid:  # push of the casing itself, by the way that it came
            reaction, way = max(solver.F[rows * p] - borne, 0.0), w_before - unknown.top
            # it may also do negative work on a strip that it held a step before, not on another
            if way > 0.0 or solver.strips[i].reaction > 0.0:
                energies[CASING] += reaction * way
            solver.strips[i].reaction = reaction
        if depth > deepest:
            deepest, where = depth, np.int64(i)
    for i in range(strips.g0.size):
        if solver.strips[i].state == DETECTED:
            lean, lean_before = lean_at(strips, u, step.now, i), lean_at(strips, u, step.last, i)
            w, w_before = u[step.now, i], u[step.last, i]
            press(strips, covered, eps_p, i, w, w_before, lean, lean_before, energies)
        if solver.strips[i].state != ACTIVE:
            solver.strips[i].reaction = 0.0
        solver.strips[i].F, solver.strips[i].state = state.motion.force[i], APART
        if rows == 2:
            solver.strips[i].moment = state.motion.force[strips.first_lean + i]
    return touched, deepest, where


@compiled
def held_forces(scheme, strips, state, count):
    """Forces F and places w of the first ``count`` active strips; False where not found."""
    couple(scheme.C, strips, state.solver, count, strips.tangential)
    return solve(strips, state.covered, state.solver, count)


@compiled
def find_force(scheme, strips, state, step):
    """Fill ``motion.force``, move ``motion.u`` to the end of the step, wear the liner, book.

    Returns
    -------
    bool, float, int
        Whether any strip bears; deepest penetration, m, and its strip.
    """
    motion, solver = state.motion, state.solver
    u, force, C_F = motion.u, motion.force, motion.moved
    force[:] = 0.0
    C_F[:] = 0.0
    count, wider = FIRST, False
    while True:
        active = activate(strips, state, step, count)
        if active == count and not wider:
            break
        count = active
        if not scheme.forces(scheme, strips, state, count):
            solver.unsolved[0] += 1
        displace(scheme.C, strips, solver, count, motion)
        wider = widen_reached(strips, state, step, count)
    for row in range(u.shape[1]):
        u[step.now, row] -= C_F[row]
    pressed = press_detected(strips, state, step, count)
    for row in range(u.shape[1]):
        state.energies[WORK] -= force[row] * (u[step.now, row] - u[step.last, row])
    return pressed
