import os
import subprocess
import sys

import numpy as np
import peer
import pytest
from scenes import scene
from systems import march, one_rod, strips

from geometry.hats import middles
from simulate.central_difference import coefficients
from simulate.kernel import ESCAPED, RUNNING
from simulate.laws.plastic import Parameters
from simulate.modal import at_rest, interface, predict
from simulate.ramp import distortion_share
from simulate.run import march as march_scene
from simulate.setup import prepare

OVER_STRIPS = [float(xi) for xi in middles(8)]

FREE = one_rod(1.0, 1.0, gap=1e9)  # never touched


def restitution(K, h, E=1.0, mass=1.0, v0=0.1):
    """Rebound over approach speed of a free mass that meets a rod at sigma_Y = 0.

    Slow: the penetration stays below the thickness of 1.
    """
    steps = int(np.ceil(12 / h))
    start = [0.0], [-v0 * h * mass**0.5]
    u = march(one_rod(E, K), [0.0], [[mass**-0.5]], 0.0, h, steps, *start).u
    return (u[-2, 0] - u[-1, 0]) / (h * v0)


@pytest.mark.parametrize("K", [0.45, 3.0])
def test_restitution_of_a_mass_on_a_rod(K):
    """Loading along E K/(E + K), unloading along E: sqrt(K/(E + K)), first order in the step."""
    exact = np.sqrt(K / (1 + K))
    # steps that never divide the duration of contact, so that the order is not blurred by luck
    h = np.array([2e-2, 1e-2, 5e-3, 2.5e-3, 1.25e-3])
    error = np.array([abs(restitution(K, step) - exact) for step in h])
    order = np.polyfit(np.log(h), np.log(error), 1)[0]
    assert error[-1] < 2e-3 * exact, error
    assert order == pytest.approx(1.0, abs=0.15), error


def test_rigid_blade_over_a_lobed_casing():
    """Worn depth (E p - sigma_Y l)+ / (E + K), p the penetration of the undeformed blade."""
    nu, steps, E, K, sigma_Y, thickness = 96, 960, 5.0, 2.0, 0.05, 2.0
    theta = 2 * np.pi * np.arange(nu) / nu
    d = 0.3 * np.cos(2 * theta) + 0.1 * np.cos(5 * theta + 0.4)
    gaps = np.array([0.05, 0.15])
    system = strips(
        Parameters(E, K, sigma_Y),
        gaps,
        d,
        length=2.6,
        thickness=thickness,
        first=[0.2, 7],
        advance=nu / steps,
    )
    q = np.zeros(1)
    run = march(system, [1.0], np.zeros((2, 1)), 0.0, 1e-3, steps, q, q)
    p = d[None] - gaps[:, None]
    exact = np.maximum(0, E * p - sigma_Y * thickness) / (E + K)
    assert run.contacts > 0
    np.testing.assert_allclose(thickness * run.eps_p, exact, rtol=1e-10, atol=1e-15)


@pytest.mark.parametrize("xi", [0.0, 0.02])
def test_free_decay_is_second_order(xi):
    """Against exp(-xi w t) cos(w_d t): order 2, and the leading error (w h)^2/24 of the phase."""
    omega, periods = 2 * np.pi, 5
    errors, sizes = [], [50, 100, 200, 400]
    for per_period in sizes:
        h = 1 / per_period
        t = h * np.arange(-1, periods * per_period + 1)
        omega_d = omega * np.sqrt(1 - xi**2)
        exact = np.exp(-xi * omega * t) * np.cos(omega_d * t)
        u = march(FREE, [omega], [[1.0]], xi, h, len(t) - 2, exact[1:2], exact[:1]).u
        errors.append(abs(u[:, 0] - exact[2:]).max())
    order = -np.polyfit(np.log(sizes), np.log(errors), 1)[0]
    assert order == pytest.approx(2.0, abs=0.05), errors
    phase = omega * periods * (omega / sizes[-1]) ** 2 / 24
    assert errors[-1] < 1.2 * phase


def test_undamped_free_energy_does_not_drift():
    """E(n+1/2) = w.w/2 + omega^2 q_n q_{n+1}/2 is kept to round-off below the limit."""
    omega, h = 1.0, 1.9
    q = march(FREE, [omega], [[1.0]], 0.0, h, 5000, [1.0], [0.3]).u[:, 0]
    energy = ((q[1:] - q[:-1]) / h) ** 2 / 2 + omega**2 * q[1:] * q[:-1] / 2
    np.testing.assert_allclose(energy, energy[0], rtol=1e-10)  # 5000 steps of round-off


def test_coefficients_are_eq_19_for_one_degree_of_freedom():
    m, xi, omega, h = 1.0, 0.1, 3.0, 0.01
    c, k = 2 * xi * omega * m, omega**2 * m
    left = m / h**2 + c / (2 * h)
    scheme = coefficients(np.array([omega]), np.ones((1, 1)), xi, h)
    assert scheme.a[0] == pytest.approx((2 * m / h**2 - k) / left, rel=1e-14)
    assert scheme.b[0] == pytest.approx(-(c / (2 * h) - m / h**2) / left, rel=1e-14)
    assert scheme.gain[0, 0] == pytest.approx(1 / left, rel=1e-14)


@pytest.mark.parametrize("nodes", [3, 8, 11])
def test_prediction_is_eq_19_and_its_interface_rows(nodes):
    rng = np.random.default_rng(7)
    scheme = coefficients(rng.uniform(1, 9, 13), rng.normal(size=(nodes, 13)), 0.01, 0.1)
    motion, now, last, before = at_rest(scheme), 1, 0, 2
    motion.x[:] = rng.normal(size=motion.x.shape)
    q_p = scheme.a * motion.x[last] - scheme.b * motion.x[before]
    predict(scheme, motion.x, motion.y, now, last, before)
    interface(scheme.Phi, motion.x, motion.u, now)
    np.testing.assert_allclose(motion.x[now], q_p, atol=1e-14)
    np.testing.assert_allclose(motion.u[now], scheme.Phi @ q_p, atol=1e-13)


@pytest.mark.parametrize("touches", [True, False])
def test_a_free_motion_beyond_its_bound_ends_the_run(touches):
    system = FREE._replace(touches=touches)
    run = march(system, [1.0], [[1.0]], 0.0, 0.1, 80, [1.0], [0.995], bound=1.5)
    assert run.end == RUNNING
    run = march(system, [1.0], [[1.0]], 0.0, 0.1, 80, [1.0], [0.9], bound=1.2)  # amplitude 1.3
    assert run.end == ESCAPED


def test_rounds_join_where_their_steps_are_odd():
    omega, Phi_b, start = [1.0, 7.0], [[1.0, 0.5]], ([1.0, 0.2], [0.9, 0.1])
    joined = march(FREE, omega, Phi_b, 0.01, 0.02, 301, *start, rounds=2)
    whole = march(FREE, omega, Phi_b, 0.01, 0.02, 602, *start)
    np.testing.assert_array_equal(joined.u, whole.u)


def test_the_ramp_is_smooth_and_complete():
    x = np.linspace(0, 3, 301)
    a = np.array([distortion_share(2.0, r) for r in x])
    assert a[0] == 0 and a[200] == 1 and a[-1] == 1
    assert np.diff(a).min() >= 0
    assert distortion_share(2.0, 0.5) == pytest.approx(0.25**2 * (3 - 2 * 0.25), rel=1e-15)
    assert distortion_share(0.0, 0.0) == 1


def test_peak_and_mean_force_are_those_of_a_pressed_rod():
    """A blade that cannot move meets a constant penetration: peak = mean = E K/(E + K) p."""
    system = strips(Parameters(2.0, 1.0, 0.0), 0.0, np.full(4, 0.3))
    run = march(system, [1.0], [[0.0]], 0.0, 1e-3, 100, [0.0], [0.0])
    np.testing.assert_allclose(run.force[0, :, 0], [0.2, 0.2 * 100, 0.0], rtol=1e-13)


def rub():
    """Displacements and wear of a small rub."""
    rng, d = np.random.default_rng(5), 0.1 * np.cos(2 * np.pi * np.arange(30) / 15)
    law, rest = Parameters(50.0, 20.0, 0.01), np.zeros(11)
    system = strips(law, [0.01] * 3, d, length=1.7, first=[0, 1, 2], advance=30 / 301)
    omega, Phi_b = rng.uniform(1, 30, 11), rng.normal(size=(3, 11))
    run = march(system, omega, Phi_b, 0.01, 1e-2, 301, rest, rest, rounds=2)
    assert run.contacts > 20
    return np.concatenate([run.u.ravel(), run.eps_p.ravel()])


def rub_elsewhere(tmp_path, **environment):
    """The same in a process of its own."""
    file, here = str(tmp_path / "rub.npy"), os.path.dirname(__file__)
    code = f"import sys, numpy; sys.path.insert(0, {here!r}); "
    code += f"from test_central_difference import rub; numpy.save({file!r}, rub())"
    subprocess.run([sys.executable, "-c", code], env=os.environ | environment, check=True)
    return np.load(file)


def test_compiled_and_interpreted_kernels_agree(tmp_path):
    compiled, interpreted = rub(), rub_elsewhere(tmp_path, NUMBA_DISABLE_JIT="1")
    # sums in another order: round-off only
    np.testing.assert_allclose(compiled, interpreted, rtol=0, atol=1e-11 * abs(compiled).max())


@pytest.mark.slow
def test_same_input_gives_the_same_bits_in_another_process(tmp_path):
    np.testing.assert_array_equal(rub(), rub_elsewhere(tmp_path))


def test_a_run_is_that_of_the_peer_over_the_first_thousand_contact_steps(coarse_rom):
    """The first strip meets the casing a thousand steps before the round ends."""
    Omega = 2 * np.pi * coarse_rom.f1 * 0.33
    case = scene(rounds=1, casing__ramp_rounds=0)
    setup = prepare(case, coarse_rom, Omega)
    # d = 2 g0 cos(2 theta + phase) reaches g0 where 2 theta + phase = -pi/3
    end = 2 * np.pi * (1 - 1000 / setup.steps) + setup.places.theta[0]
    late = scene(
        rounds=1,
        record__history__chord=OVER_STRIPS,
        casing={
            "ramp_rounds": 0,
            "harmonics": [
                {
                    "order": 2,
                    "amplitude_gaps": 2.0,
                    "phase_deg": float(np.degrees((-np.pi / 3 - 2 * end) % (2 * np.pi))),
                }
            ],
        },
    )
    setup = prepare(late, coarse_rom, Omega)
    outcome = march_scene(late, setup)
    own = peer.central_difference(coarse_rom, late, Omega, setup.steps, setup.steps)
    assert own.contacts > 1000
    assert outcome.contact_share == own.contacts / setup.steps
    atol = 1e-8 * abs(own.u_r).max()
    np.testing.assert_allclose(outcome.u_r[-1, 1:], own.u_r, rtol=0, atol=atol)
    np.testing.assert_allclose(outcome.wear, own.wear, rtol=0, atol=1e-8 * own.wear.max())


@pytest.mark.slow
def test_a_run_is_that_of_the_peer_over_five_calm_rounds(coarse_rom):
    case = scene(rounds=5, casing__ramp_rounds=1, record__history__chord=OVER_STRIPS)
    Omega = 2 * np.pi * coarse_rom.f1 * 0.38
    setup = prepare(case, coarse_rom, Omega)
    outcome = march_scene(case, setup)
    own = peer.central_difference(coarse_rom, case, Omega, setup.steps, 5 * setup.steps)
    assert own.contacts > 0.02 * 5 * setup.steps
    atol = 1e-4 * abs(outcome.u_r).max()
    np.testing.assert_allclose(outcome.u_r[-1, 1:], own.u_r, rtol=0, atol=atol)
    np.testing.assert_allclose(outcome.wear, own.wear, rtol=0, atol=1e-4 * own.wear.max())
