"""Small systems with known answers, built straight as the kernel's arrays."""

from dataclasses import dataclass
from math import ceil

import numpy as np

from simulate.contact.compiled import for_types_of
from simulate.contact.ledger import CASING, DAMPING, FRICTION, HEAT, PLASTIC, RELEASED, WORK, Ledger
from simulate.contact.ramp import smooth
from simulate.contact.rod_law import RodLaw, rod_law
from simulate.contact.strips import Strips, Tip, largest_over_window
from simulate.marching import central_difference, friction, piecewise_exact
from simulate.marching.kernel import RUNNING, Recorded, State, at_start, march_round
from simulate.marching.modal import LANES, TURNS, padded_rows, rows_of
from simulate.marching.piecewise_exact import share_of_end
from simulate.scene.law import numbers_of
from simulate.scene.laws.elastic import Elastic
from simulate.scene.laws.plastic import Plastic

# parameters of the laws plastic and elastic, Pa
Parameters, Hooke = numbers_of("E", "K", "sigma_Y"), numbers_of("E")
FLAT = Tip(0.0, 0.0, 0.0, 0.0)  # of one strip, as all tips here: ``strips`` gives it to each


@dataclass(frozen=True)
class Run:
    """A march of a small system, each strip's displacement and force on its own."""

    u: np.ndarray  # (rounds * steps, nodes), u_r at every step
    eps_p: np.ndarray  # (nodes, nu)
    contacts: int
    end: int
    ledger: Ledger  # as of its end
    start_energy: float
    state: State
    force: np.ndarray  # (rounds, 3, nodes): peak, sum of t_N, sum of t_T
    least_sliding: float  # over Omega r, inf without friction


def strips(
    law, g0, d, length=1.0, area=1.0, thickness=1.0, first=None, advance=0.0, pitch=1.0, tip=FLAT,
    rigid_from=np.inf,
) -> Strips:  # fmt: skip
    """Strips of ``len(d)`` rods, ``length`` a footprint; a node stays on them without advance.

    ``first`` is the first rod of the footprint at step 0. Rods are those under the tip at the end
    of a step; ``march_exact`` moves them to its middle.
    """
    m, g0, d = ceil(length), np.atleast_1d(np.asarray(g0, float)), np.asarray(d, float)
    n = len(g0)
    partly_covered = min(max(ceil((advance - 1) / 2), 0), max(len(d) - m, 0) // 2)
    first = np.zeros(n) if first is None else np.asarray(first, float)
    if not isinstance(law, RodLaw):
        of = Elastic if isinstance(law, Hooke) else Plastic
        law = rod_law(of, type(law)(*map(float, law)))
    # integers would have the march compiled once more
    return Strips(
        law=law,
        g0=g0,
        d=d,
        d_end=d,
        d_window=largest_over_window(d, min(m + 1 + 2 * partly_covered, len(d))),
        first=(first - partly_covered) % len(d),
        advance=float(advance),
        length=np.full(n, float(length)),
        lengthened=np.ones(n),
        rods_covered=m,
        inset=np.zeros(n, int),
        partly_covered=partly_covered,
        placed=1.0,
        w_end=np.ones(n),
        area=np.broadcast_to(np.asarray(area, float), g0.shape).copy(),
        thickness=float(thickness),
        pitch=np.full(n, float(pitch)),
        tip=Tip(tip.tilt, *(np.full(n, of_strip) for of_strip in tip[1:])),
        touches=True,
        tangential=False,
        rigid_depth=rigid_from,
        first_t=n + -n % LANES,
        first_lean=n + -n % LANES,
        lean=np.zeros(n),
        rows=(0.0,),
    )


def one_rod(E, K, sigma_Y=0.0, gap=0.0) -> Strips:
    """One node on one rod of unit area and thickness: stiffness E, N/m."""
    return strips(Parameters(E, K, sigma_Y), gap, np.zeros(4))


def elastic_rod(E, gap=0.0) -> Strips:
    """One node on one elastic rod of unit area and thickness."""
    return strips(Hooke(E), gap, np.zeros(4))


def lively(nodes=1, start=0.02):
    """Eleven modes on ``nodes`` nodes, and where they start: omega, Phi_b, q, v."""
    rng = np.random.default_rng(5)
    omega, Phi_b = rng.uniform(1, 30, 11), rng.normal(size=(nodes, 11))
    return omega, Phi_b, *(start * rng.normal(size=(2, 11)))


def march(system, omega, Phi_b, xi, h, steps, q, q_old, **more) -> Run:
    """Central differences from the displacements at the last two steps, modal."""
    return march_by(central_difference, system, omega, Phi_b, xi, h, steps, q, q_old, **more)


def march_exact(system, omega, Phi_b, xi, h, steps, q, v, w_end=None, **more) -> Run:
    """Piecewise-exact from displacement and velocity, modal; with its own w_end if not given.

    ``sliding``: friction and tangential rows of the modes, where the tip slides.
    """
    omega = np.asarray(omega, float)
    y = (np.asarray(v, float) + xi * omega * np.asarray(q, float)) / (omega * np.sqrt(1 - xi**2))
    pushed = None
    if (sliding := more.get("sliding")) is not None:
        pushed = np.atleast_2d(Phi_b) + sliding[0] * np.atleast_2d(sliding[1])
    system = in_the_middle(system, omega, Phi_b, xi, h, w_end, pushed)
    return march_by(piecewise_exact, system, omega, Phi_b, xi, h, steps, q, y, **more)


def in_the_middle(system, omega, Phi_b, xi, h, w_end=None, pushed=None) -> Strips:
    """Rods under the tip in the middle of a step ``h``, and the weight ``w_end`` of its end.

    ``pushed``: displacements of the modes along the forces, where not those of ``Phi_b``.
    """
    first = (system.first - system.advance / 2) % len(system.d)
    if w_end is None:
        E = getattr(system.law.parameters, "E", np.inf)  # or the rigid law
        stiffness = E * system.area * system.length / system.thickness
        Phi_b = np.atleast_2d(Phi_b).astype(float)
        along = Phi_b * (Phi_b if pushed is None else pushed)
        compliance = along @ piecewise_exact.gain(omega, xi, h)
        w_end = share_of_end(stiffness * np.maximum(compliance, 0))
    return system._replace(placed=0.5, first=first, w_end=np.full(len(system.g0), w_end, float))


def march_by(
    scheme, system, omega, Phi_b, xi, h, steps, first, second, ramp_rounds=0.0, rounds=1,
    bound=np.inf, sliding=None, ramp=None, samples=None,
) -> Run:  # fmt: skip
    """March by a ``scheme`` from the two states that it keeps of a step."""
    omega, Phi_b = np.asarray(omega, float), np.atleast_2d(Phi_b).astype(float)
    if sliding is None:
        arrays = scheme.coefficients(omega, Phi_b, xi, h)
    else:
        mu, Phi_t = sliding
        rows = rows_of(Phi_b, np.atleast_2d(Phi_t).astype(float))
        stiffness = system.law.parameters.E * system.area * system.length / system.thickness
        arrays = friction.sliding(
            scheme.coefficients(omega, rows, xi, h),
            system.first_t,
            np.full(len(stiffness), mu),
            stiffness,
        )
        system = system._replace(tangential=True)
    state, nodes, n = at_start(arrays, system), len(system.g0), len(omega)
    state.motion.x[0, :n] = first
    if scheme is central_difference:
        state.motion.x[-1, :n] = second
    else:
        state.motion.y[0, :n] = second
    state.motion.u[:] = state.motion.x @ arrays.Phi.T
    start_energy = scheme.energy(omega, xi, h, state.motion, 0)
    u, force = np.zeros((rounds, samples or steps, nodes)), np.zeros((rounds, 3, nodes))
    of_strips = padded_rows(Phi_b[:nodes]), np.stack([np.eye(nodes)] * 2)
    contacts, marched, end = 0, 0, RUNNING
    ramp = ramp or smooth(float(ramp_rounds))
    for done in range(rounds):
        recorded = Recorded(u[done], force[done], np.zeros((0, 0)), *of_strips)
        arguments = arrays, system, state, recorded, ramp, bound, done, steps
        touched, step, end, _ = for_types_of(march_round, *arguments)(*arguments)
        contacts, marched = contacts + touched, marched + step
        if end != RUNNING:
            break
    energies, volumes = state.energies, system.area * system.thickness
    ledger = Ledger(
        casing=energies[CASING],
        work=energies[WORK],
        blade=scheme.energy(omega, xi, h, state.motion, marched % TURNS),
        damping=energies[DAMPING],
        elastic=state.covered.strips.stored @ volumes,
        plastic=energies[PLASTIC],
        released=energies[RELEASED],
        friction=energies[FRICTION],
        heat=energies[HEAT],
    )
    u = u.reshape(-1, nodes)
    return Run(u, state.eps_p, contacts, end, ledger, start_energy, state, force, state.slowest[0])
