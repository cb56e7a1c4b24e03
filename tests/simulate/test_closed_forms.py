"""Both schemes against closed forms."""

import numpy as np
import pytest
from systems import Parameters, elastic_rod, march, march_exact, one_rod, strips

from simulate.contact.rod_law import rod_law
from simulate.scene.law import numbers_of
from simulate.scene.laws.rigid import Rigid

SOFT = 1e-7  # rad/s: holds a mass that is all but free; the exact scheme needs a frequency


def from_velocity(scheme, system, omega, Phi_b, xi, h, steps, q, v, **more):
    """March from displacement and velocity with either scheme."""
    if scheme == "piecewise-exact":
        return march_exact(system, omega, Phi_b, xi, h, steps, q, v, **more)
    before = np.asarray(q, float) - h * np.asarray(v, float)  # free flight: exact for a free mass
    return march(system, omega, Phi_b, xi, h, steps, q, before, **more)


BOTH = pytest.mark.parametrize("scheme", ["central-difference", "piecewise-exact"])


@pytest.mark.parametrize(
    ("scheme", "order", "least"), [("central-difference", 1, 2e-3), ("piecewise-exact", 2, 1e-6)]
)
@pytest.mark.parametrize("K", [0.45, 3.0])
def test_a_mass_rebounds_from_a_plastic_rod(scheme, order, least, K):
    """Loading along E K/(E + K), unloading along E: restitution sqrt(K/(E + K)).

    It stays for a quarter period of each.
    """
    loading = K / (1 + K)
    rebound, stay = np.sqrt(loading), np.pi / 2 * (1 + 1 / np.sqrt(loading))
    sizes, v0 = np.array([2e-2, 1e-2, 5e-3, 2.5e-3, 1.25e-3]), 0.1
    errors = []
    for h in sizes:
        steps, error = int(np.ceil(12 / h)), 0.0
        for share in np.linspace(0, 1, 8):  # of a step before it arrives: the worst counts
            start = [-share * h * v0], [v0]
            run = from_velocity(scheme, one_rod(1.0, K), [SOFT], [[1.0]], 0.0, h, steps, *start)
            error = max(error, abs((run.u[-2, 0] - run.u[-1, 0]) / (h * v0) - rebound))
            assert run.contacts * h == pytest.approx(stay, abs=3 * h)
        errors.append(error)
    found = np.polyfit(np.log(sizes), np.log(errors), 1)[0]
    assert errors[-1] < least * rebound, errors
    assert found == pytest.approx(order, abs=0.1), errors


@BOTH
def test_a_one_sided_spring_sets_the_frequency(scheme):
    """One degree of freedom, free on one side: 2 w1 w2 / (w1 + w2), whatever the amplitude."""
    w1, k, h = 1.0, 8.0, 2e-3
    w2 = np.sqrt(w1**2 + k)
    period = np.pi / w1 + np.pi / w2
    steps = int(20.5 * period / h)
    run = from_velocity(scheme, elastic_rod(k), [w1], [[1.0]], 0.0, h, steps, [-1.0], [0.0])
    u = run.u[:, 0]
    up = np.flatnonzero((u[:-1] < 0) & (u[1:] >= 0))
    crossings = up - u[up] / (u[up + 1] - u[up])
    found = h * (crossings[-1] - crossings[0]) / (len(crossings) - 1)
    # central differences act 1/(1 - b) too stiff, b = h^2 k = 3e-5: half of it in w2
    assert len(crossings) >= 20
    assert found == pytest.approx(period, rel=2e-5)


@BOTH
def test_a_rigid_blade_wears_what_it_reaches_into(scheme):
    """Worn depth (E p - sigma_Y l)+ / (E + K), p the penetration of the undeformed blade.

    A second round of equal depth wears nothing and spends no plastic work.
    """
    nu, steps, E, K, sigma_Y, thickness = 96, 960, 5.0, 2.0, 0.05, 2.0
    theta = 2 * np.pi * np.arange(nu) / nu
    d = 0.3 * np.cos(2 * theta) + 0.1 * np.cos(5 * theta + 0.4)
    gaps = np.array([0.05, 0.15])
    system = strips(
        Parameters(E, K, sigma_Y), gaps, d, length=2.6, thickness=thickness, first=[0.2, 7],
        advance=nu / steps,
    )  # fmt: skip
    rigid = (scheme, system, [1.0], np.zeros((2, 1)), 0.0, 1e-3, steps, [0.0], [0.0])
    once, twice = from_velocity(*rigid), from_velocity(*rigid, rounds=2)
    p = d[None] - gaps[:, None]
    exact = np.maximum(0, E * p - sigma_Y * thickness) / (E + K)
    assert once.contacts > 0
    np.testing.assert_allclose(thickness * once.eps_p, exact, rtol=1e-10, atol=1e-15)
    np.testing.assert_allclose(twice.eps_p, once.eps_p, rtol=0, atol=1e-15)
    assert twice.ledger.plastic == pytest.approx(once.ledger.plastic, rel=1e-9)
    # what a rod's wear takes: sigma_Y eps_p + K eps_p^2 / 2 of its volume
    worn = exact / thickness
    spent = (sigma_Y * worn + K * worn**2 / 2).sum(axis=1) @ system.area * thickness
    assert once.ledger.plastic == pytest.approx(spent, rel=1e-9)


def swing(scheme, length, nu, steps, swings=7.3):
    """A blade that swings over rods too small to disturb it, for a round: u, worn depth, and reach.

    ``reach`` (times, displacements) is the deepest penetration over each rod's centre of a tip with
    these displacements, linear between these times (in rounds).
    """
    E, K, depth, thickness = 5.0, 2.0, 1.5, 9.0
    system = strips(
        Parameters(E, K, 0.0), -depth, np.zeros(nu), length, 1e-12, thickness, advance=nu / steps
    )
    omega, h = 2 * np.pi * swings, 1 / steps
    run = from_velocity(scheme, system, [omega], [[1.0]], 0.0, h, steps, [1.0], [0.0])

    def reach(times, displacements):
        first, deepest = (np.ceil(length) - 1) / 2, np.zeros(nu)
        for rod in range(nu):
            for away in (0, -nu):  # covered from the start of the round, or at its end again
                middle = (rod - away - first) / nu
                begin, end = middle - length / 2 / nu, middle + length / 2 / nu
                covered = np.clip([begin, end], times[0], times[-1])
                if covered[1] > covered[0]:
                    inside = times[(times > begin) & (times < end)]
                    at = np.interp(np.r_[covered, inside], times, displacements)
                    deepest[rod] = max(deepest[rod], depth + at.max())
        return deepest

    return run.u[:, 0], thickness * run.eps_p[0] * (E + K) / E, reach, omega


PASSED = [(1.303, 40, 4000), (4.707, 40, 4000), (4.707, 40, 57), (4.707, 400, 160)]


@BOTH
@pytest.mark.parametrize(("length", "nu", "steps"), PASSED)
def test_a_rod_wears_to_the_deepest_reach_of_the_tip_over_its_centre(scheme, length, nu, steps):
    """Of a tip that goes evenly from step to step; also where it passes several rods in one.

    In central differences the tip stays for a step about its end.
    """
    u, worn, reach, _ = swing(scheme, length, nu, steps)
    times, displacements = np.arange(steps + 1) / steps, np.r_[1.0, u]
    if scheme == "central-difference":
        edges = (np.arange(steps + 1) + 0.5) / steps
        times = np.stack([edges[:-1], edges[1:] - 1e-12], axis=1).ravel()
        displacements = np.repeat(u, 2)
    np.testing.assert_allclose(worn, reach(times, displacements), rtol=1e-9)


@pytest.mark.parametrize(("length", "nu"), [(1.303, 40), (4.707, 40), (14.2, 400)])
def test_wear_is_of_second_order_in_the_step(length, nu):
    """Against the continuous swing; the tip goes straight within a step: (omega h)^2 / 8."""
    times = np.linspace(0, 1, 400_001)
    for steps in (100, 200, 400, 800):
        _, worn, reach, omega = swing("piecewise-exact", length, nu, steps)
        error = worn - reach(times, np.cos(omega * times))
        assert abs(error).max() < (omega / steps) ** 2 / 8 * (1 + 1e-3), steps
        assert abs(error).max() > (omega / steps) ** 2 / 80, steps


@pytest.mark.parametrize("xi", [0.0, 0.02, 0.5, 0.99])
@pytest.mark.parametrize("wh", [0.01, 0.7, np.pi, 6.5, 50.0])
def test_free_motion_is_exact_whatever_the_step(xi, wh):
    """Piecewise-exact: frequency and damping without error, also at w h = pi and above."""
    omega, steps = 3.0, 400
    h = wh / omega
    q0, v0 = 0.7, -1.3
    run = march_exact(one_rod(1, 1, gap=1e9), [omega], [[1.0]], xi, h, steps, [q0], [v0])
    t = h * np.arange(1, steps + 1)
    w_d = omega * np.sqrt(1 - xi**2)
    exact = np.exp(-xi * omega * t) * (
        q0 * np.cos(w_d * t) + (v0 + xi * omega * q0) / w_d * np.sin(w_d * t)
    )
    size = np.hypot(q0, (v0 + xi * omega * q0) / w_d)
    # angle of the last step, in units of round-off
    np.testing.assert_allclose(run.u[:, 0], exact, atol=size * 4e-16 * max(steps * wh, 1e3))
    assert run.ledger.damping == pytest.approx(run.start_energy - run.ledger.blade, rel=1e-10)


@BOTH
def test_an_elastic_bar_meets_a_rigid_stop(scheme):
    """Pressure E v0/c0 for 2 L/c0, then it leaves at v0 (one wave forth and back).

    Eighty free-free modes of the bar: 1 to 2 % at the jumps.
    Central differences cannot meet a rigid stop; theirs is a rod 200 times stiffer than the bar.
    """
    L, c0, v0, mass, modes = 1.0, 1.0, 1e-3, 1.0, 80
    omega = np.pi * c0 / L * np.arange(modes)
    omega[0] = SOFT
    end = np.where(np.arange(modes) == 0, 1.0, np.sqrt(2)) / np.sqrt(mass)
    start = np.zeros(modes)
    start[0] = v0 * np.sqrt(mass)
    if scheme == "piecewise-exact":
        system, h = strips(rod_law(Rigid, numbers_of()()), 0.0, np.zeros(4), rigid_from=0.0), 2e-3
    else:
        system, h = elastic_rod(200.0), 2e-4
    steps = int(2.6 * L / c0 / h)
    run = from_velocity(scheme, system, omega, end[None], 0.0, h, steps, np.zeros(modes), start)
    impulse = run.force[0, 1, 0] * h
    assert impulse == pytest.approx(2 * mass * v0, rel=0.01)
    assert run.contacts * h == pytest.approx(2 * L / c0, rel=0.02)
    assert impulse / (run.contacts * h) == pytest.approx(mass * c0 / L * v0, rel=0.02)
