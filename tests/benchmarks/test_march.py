"""Steps a second: the modal kernel against dense marches of Eqs. (19)-(20), side by side.

The blade's reduced model has the paper's size (eta = 6: n = 86, 8 points); all three loops call the
same compiled contact function, so that they differ in how the blade is marched alone. What is right
is told by tests/simulate/peer.py, which shares nothing. They run in turn, so that a drift of the
machine meets all alike; the best turn of each counts.

    ./run pytest -n 0 tests/benchmarks
"""

from time import perf_counter
from typing import NamedTuple

import numba
import numpy as np
import pytest
from runs import set_up
from scenes import scene

from rom.model import Rom
from simulate.contact.compiled import for_types_of
from simulate.contact.places import force_weights
from simulate.contact.ramp import distortion_share, smooth
from simulate.contact.rods import cover, nothing_covered, press
from simulate.marching import Setup, central_difference
from simulate.marching.kernel import Recorded, at_start, march_round
from simulate.marching.modal import Step, padded_rows

TURNS = 8
DENSE_STEPS = 5_000  # the dense loops take the first steps of the round, where contact is, too


class Dense(NamedTuple):
    """Propagators of Eq. (19) and the correction of Eq. (20)."""

    now: np.ndarray  # (n, n)
    before: np.ndarray  # (n, n)
    correction: np.ndarray  # (n, m)
    P: np.ndarray  # (m, n), radial displacements over the strips


def dense_matrices(rom: Rom, setup: Setup, xi: float) -> Dense:
    """[M/h^2 + D/2h]^-1 applied to the matrices of Eq. (19)."""
    h, M, K = setup.h, rom.M, rom.stiffness(setup.Omega)
    omega, Phi = rom.modes(setup.Omega)
    P = rom.rows(setup.places.xi)
    M_Phi = M @ Phi
    D = (M_Phi * (2 * xi * omega)) @ M_Phi.T
    left = np.linalg.inv(M / h**2 + D / (2 * h))
    return Dense(
        now=left @ (2 * M / h**2 - K),
        before=left @ (D / (2 * h) - M / h**2),
        correction=np.ascontiguousarray(left @ P.T),
        P=P,
    )


@numba.njit
def contact_forces(strips, covered, u_r, a, step, eps_p, force):
    """t_N (m,) of Eq. (17) at the predicted displacements; whether any is not zero."""
    energies = np.zeros(5)
    for i in range(strips.g0.size):
        force[i] = 0.0
        if u_r[i] - strips.g0[i] + a * strips.d_window[_first(strips, i, step)] > 0.0:
            now = Step(step, a, a, 0, 0, 0)
            cover(strips, covered, eps_p, i, now, 0.0, u_r[i], 0.0, 0.0, 0.0, 0.0, False, energies)
            force[i] = press(strips, covered, eps_p, i, u_r[i], u_r[i], 0.0, 0.0, energies)[0]
    return force.max() > 0.0


@numba.njit
def _first(strips, i, step):
    return int(strips.first[i] + step * strips.advance) % strips.d.size


def march_dense(dense, strips, covered, ramp_rounds, first, count, steps, u, u_old, eps_p):
    """Steps ``first + 1`` to ``first + count``; returns (u, u_old, steps with contact)."""
    force = np.zeros(strips.g0.size)
    contacts = 0
    for n in range(first + 1, first + count + 1):
        predicted = dense.now @ u + dense.before @ u_old
        done, step = (n - 1) // steps, (n - 1) % steps + 1
        a = distortion_share(ramp_rounds, done + step / steps)
        if contact_forces(strips, covered, dense.P @ predicted, a, step, eps_p, force):
            contacts += 1
            predicted = predicted - dense.correction @ force
        u, u_old = predicted, u
    return u, u_old, contacts


march_dense_compiled = numba.njit(march_dense)


@pytest.fixture(scope="module", params=[1.3, 2.6], ids=["a fifth", "half"])
def setup(request, paper_reduced):
    """A round at 0.33 f1 over twelve bumps, in contact from the first step."""
    rom, _ = paper_reduced
    case = scene(
        casing={
            "ramp_rounds": 0,
            "harmonics": [{"order": 12, "amplitude_gaps": request.param}],
        },
        liner__rods_per_round=2048,
        rounds=1,
    )
    return rom, case, set_up(case, rom, 0.33)


def modal(setup, xi=0.005):
    """One round by the modal kernel: steps, steps with contact, displacement at the end."""
    scheme = central_difference.coefficients(setup.omega, setup.Phi_b, xi, setup.h)
    state, Phi_out = at_start(scheme, setup.strips), padded_rows(setup.Phi_out)
    weights = force_weights(setup.places.ends)
    samples, forces = np.zeros((64, len(Phi_out))), np.zeros((3, len(weights)))
    both = np.stack([weights, weights])  # of t_N and t_T
    recorded = Recorded(samples, forces, np.zeros((0, 0)), Phi_out, both)
    arguments = scheme, setup.strips, state, recorded, smooth(0.0), np.inf, 0, setup.steps
    contacts, *_ = for_types_of(march_round, *arguments)(*arguments)
    return setup.steps, contacts


def dense(loop, matrices, setup, steps):
    """The first ``steps`` steps of the round by a dense loop: steps, steps with contact."""
    n = len(matrices.now)
    eps_p = np.zeros((len(setup.Phi_b), len(setup.strips.d)))
    _, _, contacts = loop(
        matrices,
        setup.strips,
        nothing_covered(setup.strips),
        0.0,
        0,
        steps,
        setup.steps,
        np.zeros(n),
        np.zeros(n),
        eps_p,
    )
    return steps, contacts


def test_modal_kernel_against_dense_loops(setup, benchmark, capsys):
    rom, case, prepared = setup
    matrices = dense_matrices(rom, prepared, case.damping_ratio)
    loops = {
        "modal kernel": lambda: modal(prepared),
        "compiled dense loop": lambda: dense(
            march_dense_compiled, matrices, prepared, 4 * DENSE_STEPS
        ),
        "numpy dense loop": lambda: dense(march_dense, matrices, prepared, DENSE_STEPS),
    }
    share = {name: np.divide(*reversed(loop())) for name, loop in loops.items()}  # compiles too
    best = dict.fromkeys(loops, 0.0)
    for _ in range(TURNS):
        for name, loop in loops.items():
            start = perf_counter()
            steps, _ = loop()
            best[name] = max(best[name], steps / (perf_counter() - start))
    benchmark.extra_info |= {name: f"{rate:.4g} steps/s" for name, rate in best.items()}
    benchmark(loops["modal kernel"])
    with capsys.disabled():
        print(f"\nn = {rom.n}, {len(prepared.Phi_b)} strips, {prepared.steps} steps per round")
        print(f"{'loop':<22}{'steps/s':>12}{'contact':>10}{'modal is':>12}")
        for name, rate in best.items():
            ratio = best["modal kernel"] / rate
            print(f"{name:<22}{rate:>12.3g}{share[name]:>10.0%}{ratio:>10.1f} x")
    # the loops compared are at the same work: contact on a fifth of the steps at least
    assert min(share.values()) > 0.2
