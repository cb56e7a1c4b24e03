"""The distortion over the rounds as a table: closing, opening, pulses, and their energy."""

from unittest.mock import ANY

import numpy as np
import pytest
from refused import refused
from runs import set_up
from scenes import of_steps, scene
from systems import Parameters, march_exact, one_rod, strips

from geometry.base import SettingsError
from simulate.contact.ramp import tabled
from simulate.marching import SceneError
from simulate.scene.tables import RampTable

PULSE = RampTable(rounds=[0, 0.5, 1.25, 1.5, 2.2], factor=[0, 0.4, 0.4, 1.0, 0.3])


def ramped(**changes):
    """A scene with a table in place of ``ramp_rounds``."""
    ramp = {"rounds": [0, 2], "factor": [0, 1]}
    return scene(**{"casing__ramp_rounds": None, "casing__ramp": ramp} | changes)


def test_the_share_is_linear_between_the_rounds_and_bounded_by_them():
    times = np.linspace(0, 4, 401)
    expected = np.interp(times, PULSE.rounds, PULSE.factor)
    np.testing.assert_allclose(tabled(PULSE).at(times), expected, rtol=1e-12, atol=1e-15)
    numbers = tabled(PULSE).numbers
    for first, last in ((0.2, 0.4), (1.4, 1.6), (0.4, 1.3), (2.5, 3.0)):
        inside = np.interp(np.linspace(first, last, 9001), PULSE.rounds, PULSE.factor)
        low, high = tabled(PULSE).bounds(numbers, first, last)
        assert low == pytest.approx(inside.min(), abs=1e-4)
        assert high == pytest.approx(inside.max(), abs=1e-4)


def test_a_rigid_blade_wears_to_the_largest_of_a_pulse():
    """A rod wears at its passages: to the largest factor at these, however short the pulse."""
    E, K, thickness, nu, steps, rounds = 5.0, 2.0, 9.0, 60, 600, 4
    system = strips(
        Parameters(E, K, 0.0), 0.1, np.full(nu, 0.8), 1.0, 1e-12, thickness, advance=nu / steps
    )
    run = march_exact(
        system, [1.0], [[1e-6]], 0.0, 1e-3, steps, [0.0], [0.0], rounds=rounds, ramp=tabled(PULSE)
    )
    passage = (np.arange(nu) + np.arange(rounds)[:, None] * nu)[..., None] / nu
    covered = np.clip(passage + np.linspace(-0.5, 0.5, 201) / nu, 0, rounds)
    factor = np.interp(covered, PULSE.rounds, PULSE.factor).max(axis=(0, 2))
    exact = np.maximum(0.8 * factor - 0.1, 0) * E / (E + K)
    worn = thickness * run.eps_p[0]
    # the casing comes by 0.8 * 2.4 a round at most: half of what it does in a step
    np.testing.assert_allclose(worn[1:], exact[1:], atol=0.8 * 2.4 / steps)
    assert 0 < run.contacts < rounds * steps


@pytest.mark.parametrize(("rounds", "reached", "most"), [(2, 1.0, 0.01), (4, 0.5, 0.03)])
def test_what_the_casing_gives_it_takes_back_where_it_opens(rounds, reached, most):
    """One mode on an elastic rod, closed and opened so slowly that it does not vibrate."""
    omega, k, d = 2.0, 12.0, 0.3
    rod = one_rod(k, 0.0, sigma_Y=1e9)  # that never yields
    system = rod._replace(d=np.full(4, d), d_end=np.full(4, d), d_window=np.full(4, d))
    table = RampTable(rounds=[0, 1, 2, 3], factor=[0, 1, 1, 0.5])
    ledger = march_exact(
        system, [omega], [[1.0]], 0.5, 0.05, 4000, [0.0], [0.0], w_end=0.0, rounds=rounds,
        ramp=tabled(table),
    ).ledger  # fmt: skip
    stiffness = k * omega**2 / (k + omega**2)  # rod and mode in series
    assert ledger.casing == pytest.approx(stiffness * (d * reached) ** 2 / 2, rel=most)
    assert abs(ledger.numerical) < 1e-10 * ledger.casing
    assert ledger.blade + ledger.damping == pytest.approx(ledger.work, rel=1e-9)


def test_no_contact_is_missed_in_a_pulse_between_samples():
    """A pulse shorter than the time over which contact is foreseen is met all the same."""
    nu, steps = 60, 600
    pulse = RampTable(rounds=[0, 0.416, 0.42, 0.424], factor=[0, 0, 1, 0])
    system = strips(Parameters(5.0, 2.0, 0.0), 0.1, np.full(nu, 0.8), 1.0, 1e-12, 9.0, advance=0.1)
    still = [1.0], [[1e-6]], 0.0, 1e-3, steps, [0.0], [0.0]
    run = march_exact(system, *still, ramp=tabled(pulse), samples=6)
    assert run.contacts == pytest.approx(0.008 * (1 - 0.1 / 0.8) * steps, abs=1.5)


@pytest.mark.parametrize(
    ("changes", "key", "allowed"),
    [
        ({"casing__ramp__rounds": [1, 2]}, "casing.ramp.rounds", ANY),  # not from 0
        ({"casing__ramp": {"rounds": [0, 2, 1], "factor": [0, 1, 1]}}, "casing.ramp.rounds", ANY),
        ({"casing__ramp__factor": [0]}, "casing.ramp", ANY),  # of two lengths
        ({"casing__ramp__factor": [0, -1]}, "casing.ramp.factor.1", ANY),
        ({"casing__ramp_rounds": 1}, "casing", ("ramp_rounds", "ramp")),
    ],
)
def test_wrong_tables_are_refused(changes, key, allowed):
    error = refused(SettingsError, ramped, **changes)
    assert (error.key, error.allowed) == (key, allowed)


def test_a_rigid_casing_that_is_closed_at_the_start_is_refused(coarse_rom):
    of = ramped(casing__ramp__factor=[1, 0], liner__law={"kind": "rigid"}, integrator=of_steps(640))
    assert refused(SceneError, set_up, of, coarse_rom).key == "casing.ramp.factor: 1"
