"""Casing harmonics that travel: closed forms of wear, limits of their speed, energy, the peer."""

import numpy as np
import pytest
from refused import refused
from scenes import scene
from systems import FLAT, Parameters, lively, march, march_exact, strips

from geometry.base import SettingsError
from simulate.contact.rod_law import rod_law
from simulate.contact.strips import Tip, largest_over_window
from simulate.contact.travelling import waves
from simulate.scene.casing import Harmonic
from simulate.scene.law import numbers_of
from simulate.scene.laws.rigid import Rigid

SCHEMES = {"central-difference": march, "piecewise-exact": march_exact}
E, K, THICKNESS = 5.0, 2.0, 9.0
RIGID = [1.0], [[1e-6]], 0.0, 1e-3  # a blade that forces move by 1e-12: omega, Phi_b, xi, h
NU, STEPS = 90, 400
OMEGA, PHI_B, Q, V = lively()
MOVES = OMEGA, PHI_B, 0.02, 1e-2, STEPS, Q, V
STANDING = strips(
    Parameters(E, K, 0.0), 0.1, 0.2 * np.cos(6 * np.pi * np.arange(NU) / NU + 0.4), 1.7, 3.0,
    THICKNESS, advance=NU / STEPS,
)  # fmt: skip


def travelling(nu, steps, length, gap, of, fixed=0.0, tip=FLAT, law=None, **more):
    """One strip under travelling harmonics ``of`` (amplitude, order, phase, speed over Omega)."""
    law = law or Parameters(E, K, 0.0)
    area = more.pop("area", 1e-12)
    system = strips(
        law, gap, np.zeros(nu), length, area, THICKNESS, advance=nu / steps, tip=tip, **more
    )
    fixed = np.full(nu, fixed)
    rows = [(A, n, phase, n * speed * 2 * np.pi / steps) for A, n, phase, speed in of]
    # where the window of the strip is longer by the rods beside, so is what may be in reach
    window = largest_over_window(
        fixed, min(system.rods_covered + 5 + 2 * system.partly_covered, nu)
    )
    return system._replace(
        d=fixed.copy(), d_end=fixed.copy(), d_window=window, waves=waves(fixed, np.array(rows))
    )


def envelope(nu, length, rounds, gap, of, fixed=0.0, fine=200):
    """Largest of d(theta, t) - gap while the tip covers the centre of each rod, m, by sampling."""
    theta, middle = 2 * np.pi * np.arange(nu) / nu, (np.ceil(length) - 1) / 2
    deepest = np.full(nu, -np.inf)
    for passage in range(-1, rounds + 1):
        begin = (np.arange(nu) + passage * nu - middle - length / 2) / nu
        time = np.clip(begin[:, None] + np.linspace(0, length / nu, fine), 0, rounds)
        covered = (time > 0) & (time < rounds)
        d = fixed + sum(
            A * np.cos(n * (theta[:, None] - 2 * np.pi * speed * time) + phase)
            for A, n, phase, speed in of
        )
        deepest = np.maximum(deepest, np.where(covered, d, -np.inf).max(axis=1))
    return deepest - gap


WAVES = {
    "an orbit": [(0.8, 1, 0.3, 0.37)],
    "with the blade": [(0.8, 1, 0.3, 1.0)],  # all rods wear alike
    "faster than the blade": [(0.5, 2, -1.0, 1.7)],
    "two": [(0.5, 2, 0.0, 0.43), (0.4, 5, 1.0, -0.11)],
}


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("name", WAVES)
def test_a_rigid_blade_wears_the_envelope_over_its_passages(scheme, name):
    """Over a step the casing is taken to move evenly, which is off in second order."""
    nu, steps, length, rounds, gap, of = 60, 600, 2.6, 3, 0.1, WAVES[name]
    exact = np.maximum(envelope(nu, length, rounds, gap, of, fixed=0.05), 0) * E / (E + K)
    system = travelling(nu, steps, length, gap, of, fixed=0.05)
    run = SCHEMES[scheme](system, *RIGID, steps, [0.0], [0.0], rounds=rounds)
    assert run.contacts > 0.1 * rounds * steps
    worn = THICKNESS * run.eps_p[0]
    most = 1e-4 if name == "with the blade" else 2e-4
    away = np.s_[2:-2]  # from where the blade begins and ends
    assert abs(worn - exact)[away].max() < most * exact.max()


def test_an_orbit_with_the_blade_is_order_0_to_it():
    """Of a synchronous unbalance; off by half the footprint's angle times the tangent of 0.3."""
    nu, steps, length, phase = 600, 1200, 2.6, 0.3
    turning, standing = (
        march_exact(
            travelling(nu, steps, length, 0.1, [(0.8, order, phase, speed)]),
            *(*RIGID, steps, [0.0], [0.0]),
            rounds=2,
        ).eps_p[0, 2:-2]
        for order, speed in ((1, 1.0), (0, 0.0))
    )
    assert standing.min() > 0
    most = 0.8 * np.sin(phase) * np.pi * length / nu * E / (E + K)
    assert abs(turning - standing).max() * THICKNESS < 1.1 * most
    unbalance = Harmonic(order=0, amplitude_um=40, phase_deg=60)
    assert unbalance.inward(np.zeros(3), gap=1.0) == pytest.approx(2e-5)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_speed_0_is_a_standing_casing(scheme):
    """The same wear and motion, of a blade that moves, to round-off."""
    slow = travelling(NU, STEPS, 1.7, 0.1, [(0.2, 3, 0.4, 0.0)], area=3.0)
    one, other = (SCHEMES[scheme](of, *MOVES, rounds=3, ramp_rounds=0.7) for of in (slow, STANDING))
    assert one.contacts == other.contacts > 50
    np.testing.assert_allclose(one.u, other.u, rtol=0, atol=1e-12)
    np.testing.assert_allclose(one.eps_p, other.eps_p, rtol=0, atol=1e-12)
    for name in ("casing", "plastic", "released"):  # 5e-15 seen
        assert getattr(one.ledger, name) == pytest.approx(getattr(other.ledger, name), rel=1e-12)


FAST = travelling(60, 600, 2.6, 0.95, [(0.8, 4, 0.3, 2.31), (0.3, 9, 1.3, -0.77)])
SELDOM = {"standing": (STANDING, MOVES), "travelling": (FAST, (*RIGID, 600, [0.0], [0.0]))}


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("casing", SELDOM)
def test_no_contact_is_missed_between_the_samples(scheme, casing):
    """What may touch is told over window and time: the same bits where every step is looked at.

    The casing may bring rods to the tip in a step in which the tip then leaves them: it has loaded
    them, though they bear in no step. What bounds the contact-free displacement looser, as
    travelling harmonics do, must not tell: looked at by the end of the step alone, central
    differences missed 6e-9 of the casing's work here.
    """
    system, moves = SELDOM[casing]
    every = system._replace(d_window=np.full(system.d.size, 1e3))
    ramp = 0.7 if casing == "standing" else 0.0
    one, other = (SCHEMES[scheme](of, *moves, rounds=2, ramp_rounds=ramp) for of in (system, every))
    assert 0 < one.contacts == other.contacts < len(one.u)
    assert one.ledger == other.ledger
    np.testing.assert_array_equal(one.u, other.u)
    np.testing.assert_array_equal(one.eps_p, other.eps_p)


TIPS = {"flat": FLAT, "rounded": Tip(0.03, 0.02 / 0.85**2, -0.03 * 0.85**2 / 0.04, 0.85)}


@pytest.mark.parametrize("tip", TIPS)
@pytest.mark.parametrize("length", [1.7, 5.3])
def test_the_ledger_balances_under_a_travelling_casing(tip, length):
    """w_end = 0: neither created nor lost, whatever the casing does to the rods under the tip."""
    of = [(0.2, 3, 0.4, 0.8), (0.1, 7, 0.0, -0.3)]
    system = travelling(NU, STEPS, length, 0.1, of, tip=TIPS[tip], area=3.0)
    run = march_exact(system, *MOVES, w_end=0.0, rounds=3, ramp_rounds=0.7)
    ledger = run.ledger
    assert run.contacts > 100 and ledger.casing > 0
    assert abs(ledger.numerical) < 1e-12 * ledger.casing
    error = ledger.blade + ledger.damping - run.start_energy - ledger.work
    assert abs(error) < 1e-11 * (ledger.damping + run.start_energy)


def test_a_rigid_casing_is_met_where_it_is_at_the_end_of_a_step():
    """A blade held by the casing follows it, all around: u_r = gap - d under the tip."""
    nu, steps, A, n, speed = 400, 400, 0.01, 2, 0.6
    system = travelling(
        nu, steps, 1.0, 0.0, [(A, n, 0.0, speed)], fixed=0.1,
        law=rod_law(Rigid, numbers_of()()), rigid_from=0.0,
    )  # fmt: skip
    run = march_exact(system, [1e3], [[1.0]], 0.5, 1e-3, steps, [-0.2], [0.0], rounds=2)
    time = np.arange(1, 2 * steps + 1) / steps
    away = 2 * np.pi * n * (time - speed * time)
    assert run.contacts > 1.9 * steps
    np.testing.assert_allclose(
        run.u[steps:, 0], -0.1 - A * np.cos(away)[steps:], atol=A * (2 * np.pi * n / nu)
    )


@pytest.mark.parametrize(
    ("order", "more", "key", "value"),
    [
        (0, {}, "casing.harmonics.0.speed_rpm", pytest.approx(90 / np.pi)),
        (1, {"speeds": {"over_f1": [0.3, 0.31], "in_turn": True}}, "speeds.in_turn", None),
    ],
)
def test_order_0_does_not_travel_nor_what_a_sweep_in_turn_would_make_jump(order, more, key, value):
    waves = [{"order": order, "amplitude_gaps": 1.0, "speed_rad_s": 3}]
    error = refused(SettingsError, scene, casing__harmonics=waves, **more)
    assert (error.key, error.value) == (key, value)
