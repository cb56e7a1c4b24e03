"""Central differences: free motion, the end of a run, rounds, processes, and the peer."""

import os
import subprocess
import sys

import numpy as np
import peer
import pytest
from runs import assert_is_that_of_the_peer, set_up
from scenes import over_strips, scene
from systems import Parameters, lively, march, one_rod, strips

from simulate.contact.ramp import distortion_share
from simulate.marching.kernel import ESCAPED, RUNNING

FREE = one_rod(1.0, 1.0, gap=1e9)  # never touched


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
    rounds = np.linspace(0, 3, 301)
    x = np.minimum(rounds / 2.0, 1)
    a = [distortion_share(2.0, of) for of in rounds]
    np.testing.assert_allclose(a, x**2 * (3 - 2 * x), rtol=1e-14)
    assert distortion_share(0.0, 0.0) == 1


def rub():
    """Displacements and wear of a small rub."""
    d, rest = 0.1 * np.cos(2 * np.pi * np.arange(30) / 15), np.zeros(11)
    law, (omega, Phi_b, *_) = Parameters(50.0, 20.0, 0.01), lively(3)
    system = strips(law, [0.01] * 3, d, length=1.7, first=[0, 1, 2], advance=30 / 301)
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
    still = {"rounds": 1, "casing__ramp_rounds": 0, "record__history__chord": over_strips()}
    setup = set_up(scene(**still), coarse_rom, 0.33)
    # d = 2 g0 cos(2 theta + phase) reaches g0 where 2 theta + phase = -pi/3
    end = 2 * np.pi * (1 - 1000 / setup.steps) + setup.places.theta[0]
    phase = float(np.degrees((-np.pi / 3 - 2 * end) % (2 * np.pi)))
    late = {"order": 2, "amplitude_gaps": 2.0, "phase_deg": phase}
    case = scene(**still, casing__harmonics=[late])
    of_peer = peer.central_difference
    assert assert_is_that_of_the_peer(of_peer, case, coarse_rom, 0.33, 1e-8) > 1000


@pytest.mark.nightly
def test_a_run_is_that_of_the_peer_over_five_calm_rounds(coarse_rom):
    case = scene(rounds=5, casing__ramp_rounds=1, record__history__chord=over_strips())
    of_peer, steps = peer.central_difference, set_up(case, coarse_rom, 0.38).steps
    contacts = assert_is_that_of_the_peer(of_peer, case, coarse_rom, 0.38, 1e-4)
    assert contacts > 0.02 * 5 * steps
